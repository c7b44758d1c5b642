#include "app/document/copying.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/document/pictures/state_folder.h"
#include "app/document/writing.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/files/modified_time.h"
#include "core/files/system_message.h"
#include "core/hash.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr double kStrokeReach = 60;                               // units between a click and a stroke
constexpr std::size_t kMostPictureBytes = std::size_t{24} << 20;  // of a picture that is kept
constexpr std::size_t kMostSteps = 200;

/// Remembers the present correction, to go back to it.
void begin_step(const CopyToEdit& c) {
    std::vector<writer::CopyCorrection>& earlier = c.copy.earlier;
    c.copy.slides = false;
    if (earlier.size() == kMostSteps) earlier.erase(earlier.begin());
    earlier.push_back(c.request.correction);
}

std::string id_of(const std::vector<char>& bytes) {
    return fmt::format("{:016x}", hash_bytes(bytes.data(), bytes.size()));
}

/// The name of a picture's file in a folder; of a hostile path that is none, one of our own.
std::string file_name_of(const KeptCopy& copy) {
    const std::string name = copy.file.filename().string();
    return name.empty() || name == "." || name == ".." ? "picture.png" : name;
}

void take_order(const CopyToEdit& c) {
    c.request.correction.order = writer::order_text(c.copy.shown->order);
    c.copy.shown_for = c.request.correction;
    c.copy.joined.reset();
}

void split(const CopyToEdit& c, const writer::StrokePlace& place) {
    writer::CopiedPicture& shown = *c.copy.shown;
    const writer::CopyCorrection& before = c.request.correction;
    writer::CopyCorrection next = writer::split_at(shown, before, place);
    const bool cuts = next.cuts.size() > before.cuts.size();
    if (!cuts && next.order == writer::order_text(shown.order)) return;  // at an end of the stroke
    begin_step(c);
    if (cuts) writer::cut_piece(shown.skeleton, next.cuts.back());
    shown.order = writer::parse_order(next.order, shown.skeleton.pieces.size());
    c.request.correction = std::move(next);
    c.copy.shown_for = c.request.correction;
}

void join(const CopyToEdit& c, std::size_t stroke) {
    CopyInWork& copy = c.copy;
    if (!copy.joined) {
        copy.joined = stroke;
        return;
    }
    const std::size_t first = *copy.joined;
    copy.joined.reset();
    if (first == stroke) return;
    begin_step(c);
    writer::join_strokes(copy.shown->order, first, stroke);
    take_order(c);
}

}  // namespace

void edit_stroke(const CopyToEdit& c, const Vec2& at) {
    CopyInWork& copy = c.copy;
    if (!c.ready() || copy.shown->order.empty()) return;
    const writer::StrokePlace place = writer::nearest_place(*copy.shown, at);
    if (place.distance > kStrokeReach) return copy.joined.reset();
    if (copy.edit == CopyEdit::join) return join(c, place.stroke);
    if (copy.edit == CopyEdit::remove && copy.shown->order.size() == 1) return;
    if (copy.edit == CopyEdit::split) return split(c, place);
    begin_step(c);
    if (copy.edit == CopyEdit::reverse)
        writer::reverse_stroke(copy.shown->order, place.stroke);
    else
        writer::remove_stroke(copy.shown->order, place.stroke);
    take_order(c);
}

void drag_stroke(const CopyToEdit& c, std::size_t to) {
    std::optional<StrokeDrag>& drag = c.copy.dragged;
    if (!drag) return;
    if (!c.ready() || drag->stroke >= c.copy.shown->order.size()) return drag.reset();
    if (to == drag->stroke || to >= c.copy.shown->order.size()) return;
    if (!drag->moved) begin_step(c);
    writer::move_stroke(c.copy.shown->order, drag->stroke, to);
    drag = {to, true};
    take_order(c);
}

void CopyInWork::take(std::optional<writer::CopiedPicture> read, const writer::CopyCorrection& correction) {
    if (!shown || !read || shown->order != read->order) joined.reset(), dragged.reset();
    shown = std::move(read);
    shown_for = correction;
}

void correct(const CopyToEdit& c, writer::CopyCorrection correction) {
    if (correction == c.request.correction) return;
    begin_step(c);
    c.request.correction = std::move(correction);
    c.copy.let_go();
}

void slide_threshold(const CopyToEdit& c, double threshold) {
    writer::CopyCorrection next{.threshold = std::round(1000 * threshold) / 1000, .cuts = {}, .order = {}};
    if (next == c.request.correction) return;
    if (!c.copy.slides) begin_step(c);
    c.request.correction = std::move(next);
    c.copy.let_go();
    c.copy.slides = true;
}

bool step_back(const CopyToEdit& c) {
    if (c.copy.earlier.empty()) return false;
    c.request.correction = std::move(c.copy.earlier.back());
    c.copy.earlier.pop_back();
    c.copy.let_go();
    return true;
}

io::Attachment to_attachment(const KeptCopy& copy) {
    const nlohmann::json about{{"file", copy.file.string()},
                               {"name", copy.name},
                               {"threshold", copy.correction.threshold},
                               {"cuts", writer::cuts_text(copy.correction.cuts)},
                               {"order", copy.correction.order}};
    return {copy.id, about.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace), copy.bytes};
}

KeptCopy kept_copy(const io::Attachment& attachment) {
    KeptCopy copy{.id = attachment.name, .file = {}, .bytes = attachment.bytes, .name = {}, .correction = {}};
    try {
        const nlohmann::json j = nlohmann::json::parse(attachment.about);
        copy.file = j.value("file", "");
        copy.name = j.value("name", "");
        const double threshold = j.value("threshold", 0.0);
        if (std::isfinite(threshold))
            copy.correction.threshold = std::clamp(threshold, -writer::kMostThreshold, writer::kMostThreshold);
        copy.correction.cuts = writer::parse_cuts(j.value("cuts", ""));
        copy.correction.order = j.value("order", "");
    } catch (const std::exception&) {
        copy.correction = {};
    }
    return copy;
}

KeptCopy read_copy(const writer::TextRequest& request) {
    KeptCopy copy{.id = {},
                  .file = fs::absolute(request.like),
                  .bytes = {},
                  .name = request.text,
                  .correction = request.correction,
                  .read_at = modified_time(request.like)};
    copy.bytes = read_file(request.like, kMostPictureBytes);
    copy.id = id_of(copy.bytes);
    return copy;
}

void CopyReader::read(const writer::TextRequest& request, std::span<const KeptCopy> kept) {
    const fs::path file = fs::absolute(request.like);
    CopyRequest wish{request, modified_time(file)};
    const auto is_kept = [&](const KeptCopy& k) {
        return k.file == file && k.read_at == wish.time && k.name == request.text && k.correction == request.correction;
    };
    // What is being read takes the place of what is kept.
    if (busy() ? wish == asked_ : wish.time && std::any_of(kept.begin(), kept.end(), is_kept)) return;
    asked_ = wish;
    wanted_.push_back(std::move(wish));
    if (!busy()) begin();
}

void CopyReader::begin() {
    reading_ = std::async(std::launch::async, [request = std::move(wanted_.front().request)] {
        Read read;
        try {
            read.copy = read_copy(request);
            read.attachment = to_attachment(*read.copy);
        } catch (const std::exception& error) {
            read.copy.reset();
            read.fault = message_of(error);
        }
        return read;
    });
    wanted_.pop_front();
}

std::optional<CopyReader::Read> CopyReader::poll() {
    if (!busy() || reading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready) return std::nullopt;
    Read read = reading_.get();
    if (!wanted_.empty()) begin();
    return read;
}

void CopyReader::wait() const {
    if (busy()) reading_.wait();
}

fs::path picture_of(const KeptCopy& copy) {
    try {
        if (!copy.file.empty() && read_file(copy.file, kMostPictureBytes) == copy.bytes) return copy.file;
    } catch (const Error&) {
        // It is missing.
    }
    const fs::path folder = state_folder() / "copied" / id_of(copy.bytes);
    std::error_code ec;
    fs::create_directories(folder, ec);
    if (ec) throw Error(folder.string(), Message("the folder cannot be made: {}", system_message(ec)));
    const fs::path file = folder / file_name_of(copy);
    write_file(file, copy.bytes.data(), copy.bytes.size());
    return file;
}

std::string copy_words(const writer::TextRequest& request) {
    const writer::CopyCorrection& c = request.correction;
    std::string words = "--like " + quoted(request.like.string());
    if (!request.text.empty()) words += " --text " + quoted(request.text);
    if (c.threshold != 0) words += fmt::format(" --threshold {:.3f}", c.threshold);
    if (!c.cuts.empty()) words += fmt::format(" --cut \"{}\"", writer::cuts_text(c.cuts));
    if (!c.order.empty()) words += fmt::format(" --order \"{}\"", c.order);
    return words;
}

}  // namespace tuft::app
