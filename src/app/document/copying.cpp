#include "app/document/copying.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "app/document/pictures/state_folder.h"
#include "app/document/writing.h"
#include "core/error.h"
#include "core/files/files.h"
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
    if (earlier.size() == kMostSteps) earlier.erase(earlier.begin());
    earlier.push_back(c.request.correction);
}

std::string id_of(const std::vector<char>& bytes) {
    return fmt::format("{:016x}", hash_bytes(bytes.data(), bytes.size()));
}

void take_order(const CopyToEdit& c) {
    c.request.correction.order = writer::order_text(c.copy.shown->order);
    c.copy.shown_for = c.request.correction;
}

void split(const CopyToEdit& c, const writer::StrokePlace& place) {
    writer::CopiedPicture& shown = *c.copy.shown;
    writer::CopyCorrection next = writer::split_at(shown, c.request.correction, place);
    if (next.cuts.size() > c.request.correction.cuts.size()) writer::cut_piece(shown.skeleton, next.cuts.back());
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
    if (*copy.joined != stroke) {
        begin_step(c);
        writer::join_strokes(copy.shown->order, *copy.joined, stroke);
        take_order(c);
    }
    copy.joined.reset();
}

}  // namespace

void edit_stroke(const CopyToEdit& c, const Vec2& at) {
    CopyInWork& copy = c.copy;
    if (!c.ready() || copy.shown->order.empty()) return;
    const writer::StrokePlace place = writer::nearest_place(*copy.shown, at);
    if (place.distance > kStrokeReach) return copy.joined.reset();
    if (copy.edit == CopyEdit::join) return join(c, place.stroke);
    if (copy.edit == CopyEdit::remove && copy.shown->order.size() == 1) return;
    begin_step(c);
    if (copy.edit == CopyEdit::split) return split(c, place);
    if (copy.edit == CopyEdit::reverse)
        writer::reverse_stroke(copy.shown->order, place.stroke);
    else
        writer::remove_stroke(copy.shown->order, place.stroke);
    take_order(c);
}

void move_stroke(const CopyToEdit& c, std::size_t stroke, std::size_t to, bool begins) {
    if (!c.ready()) return;
    if (begins) begin_step(c);
    writer::move_stroke(c.copy.shown->order, stroke, to);
    take_order(c);
}

void correct(const CopyToEdit& c, writer::CopyCorrection correction) {
    // A slide of the threshold is one step.
    const auto only_threshold = [](const writer::CopyCorrection& a) { return a.cuts.empty() && a.order.empty(); };
    const bool slides = !c.copy.earlier.empty() && only_threshold(c.copy.earlier.back()) &&
                        only_threshold(c.request.correction) && only_threshold(correction);
    if (!slides) begin_step(c);
    c.request.correction = std::move(correction);
    c.copy.joined.reset();
}

bool step_back(const CopyToEdit& c) {
    if (c.copy.earlier.empty()) return false;
    c.request.correction = std::move(c.copy.earlier.back());
    c.copy.earlier.pop_back();
    c.copy.joined.reset();
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

std::optional<KeptCopy> copy_to_keep(const writer::TextRequest& request) {
    try {
        KeptCopy copy{.id = {},
                      .file = fs::absolute(request.like),
                      .bytes = read_file(request.like, kMostPictureBytes),
                      .name = request.text,
                      .correction = request.correction};
        copy.id = id_of(copy.bytes);
        return copy;
    } catch (const Error&) {
        return std::nullopt;
    }
}

fs::path picture_of(const KeptCopy& copy) {
    try {
        if (!copy.file.empty() && read_file(copy.file, kMostPictureBytes) == copy.bytes) return copy.file;
    } catch (const Error&) {
        // It is no longer there.
    }
    const fs::path folder = state_folder() / "copied";
    fs::create_directories(folder);
    const std::string type = copy.file.extension().string();
    const fs::path file = folder / (id_of(copy.bytes) + (type.empty() ? ".png" : type));
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
