#include "app/document/pictures/tried_strokes.h"

#include <algorithm>
#include <chrono>
#include <exception>

#include "brush/preset/preset.h"
#include "stroke/placement/tip_lag.h"

namespace tuft::app {
namespace {

using pictures::TriedStroke;

constexpr std::chrono::seconds kRest{1};
constexpr std::size_t kBytes = std::size_t{3} * TriedStroke::kWidth * TriedStroke::kHeight;

}  // namespace

TriedStrokes::~TriedStrokes() {
    stop_ = true;  // the future waits for its thread
}

unsigned TriedStrokes::texture(const std::string& brush, std::uint64_t reading) {
    Picture& p = pictures_[brush];
    if (p.reading != reading) {
        app::release(p.texture);
        p.picture.rgb.clear();
        p.reading = reading;
        want({.brush = brush, .reading = reading});
    }
    if (!p.texture && !p.picture.rgb.empty()) upload(p.texture, p.picture);
    return p.texture;
}

// Before those that are known to be missing in the cache.
void TriedStrokes::want(PictureRequest request) {
    wanted_.insert(std::ranges::find_if(wanted_, &PictureRequest::to_paint), std::move(request));
}

void TriedStrokes::update(bool may_paint) {
    const auto now = std::chrono::steady_clock::now();
    if (!may_paint) busy_at_ = now;
    if (painting_.valid()) {
        if (!may_paint) stop_ = true;
        if (painting_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        Painted painted = painting_.get();
        if (painted.stopped)
            want(std::move(painted.request));
        else if (painted.missing)
            wanted_.push_back({std::move(painted.request.brush), painted.request.reading, true});
        else if (Picture& p = pictures_[painted.request.brush]; p.reading == painted.request.reading)
            p.picture.rgb = std::move(painted.rgb);
    }
    std::erase_if(wanted_,
                  [&](const PictureRequest& request) { return pictures_[request.brush].reading != request.reading; });
    if (!may_paint || wanted_.empty() || (wanted_.front().to_paint && now - busy_at_ < kRest)) return;
    stop_ = false;
    painting_ = std::async(std::launch::async, [this, request = wanted_.front()] { return paint(request); });
    wanted_.pop_front();
}

void TriedStrokes::release() {
    for (auto& [brush, p] : pictures_) app::release(p.texture);
}

TriedStrokes::Painted TriedStrokes::paint(PictureRequest request) const {
    Painted out{.request = std::move(request), .rgb = {}};
    try {
        const brush::Preset preset = brush::load_preset(out.request.brush);
        CacheKey key("tried stroke 5");
        brush::Preset content = preset;
        content.name.clear();
        content.note.clear();
        key.add_text(brush::preset_toml(content));
        const auto take = [&](CacheReader& in) {
            std::vector<std::uint8_t> rgb = in.get<std::uint8_t>();
            if (rgb.size() != kBytes) CacheReader::fail();
            out.rgb = std::move(rgb);
        };
        if (cache_.read(key, take)) return out;
        out.missing = !out.request.to_paint;
        if (out.missing) return out;
        const auto progress = [this](std::string_view, double) { return !stop_.load(); };
        out.rgb = pictures::paint_tried_stroke(preset, progress, stroke::shared_tip_lag_cache()).rgb;
        cache_.write(key, [&](CacheWriter& to) { to.put(out.rgb); });
    } catch (const Cancelled&) {
        out.stopped = true;
    } catch (const std::exception&) {
        // A brush whose file is missing is shown by its name.
    }
    return out;
}

}  // namespace tuft::app
