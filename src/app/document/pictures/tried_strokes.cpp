#include "app/document/pictures/tried_strokes.h"

#include <epoxy/gl.h>

#include <chrono>
#include <exception>

#include "brush/preset/preset.h"
#include "pictures/tried_stroke.h"

namespace tuft::app {
namespace {

using pictures::TriedStroke;

constexpr std::size_t kBytes = std::size_t{3} * TriedStroke::kWidth * TriedStroke::kHeight;

}  // namespace

TriedStrokes::~TriedStrokes() {
    stop_ = true;  // the future waits for its thread
}

unsigned TriedStrokes::texture(const std::string& brush) {
    const auto [at, is_new] = pictures_.try_emplace(brush);
    Picture& p = at->second;
    if (is_new) wanted_.push_back(brush);
    if (p.texture || p.rgb.empty()) return p.texture;
    glGenTextures(1, &p.texture);
    glBindTexture(GL_TEXTURE_2D, p.texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, TriedStroke::kWidth, TriedStroke::kHeight, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 p.rgb.data());
    glGenerateMipmap(GL_TEXTURE_2D);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    return p.texture;
}

void TriedStrokes::update(bool may_paint) {
    if (painting_.valid()) {
        if (!may_paint) stop_ = true;
        if (painting_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return;
        Painted painted = painting_.get();
        if (painted.stopped)
            wanted_.push_front(painted.brush);
        else
            pictures_[painted.brush].rgb = std::move(painted.rgb);
    }
    if (!may_paint || wanted_.empty()) return;
    stop_ = false;
    painting_ = std::async(std::launch::async, [this, brush = wanted_.front()] { return paint(brush); });
    wanted_.pop_front();
}

void TriedStrokes::release() {
    for (auto& [brush, p] : pictures_) {
        if (p.texture) glDeleteTextures(1, &p.texture);
        p.texture = 0;
    }
}

TriedStrokes::Painted TriedStrokes::paint(const std::string& brush) const {
    Painted out{.brush = brush, .rgb = {}};
    try {
        const brush::Preset preset = brush::load_preset(brush);
        CacheKey key("tried stroke 1");
        key.add_text(brush::preset_toml(preset));
        const auto take = [&](CacheReader& in) {
            std::vector<std::uint8_t> rgb = in.get<std::uint8_t>();
            if (rgb.size() != kBytes) CacheReader::fail();
            out.rgb = std::move(rgb);
        };
        if (cache_.read(key, take)) return out;
        out.rgb = pictures::paint_tried_stroke(preset, [this](std::string_view, double) { return !stop_.load(); }).rgb;
        cache_.write(key, [&](CacheWriter& to) { to.put(out.rgb); });
    } catch (const Cancelled&) {
        out.stopped = true;
    } catch (const std::exception&) {
        // A brush whose file is gone is shown by its name.
    }
    return out;
}

}  // namespace tuft::app
