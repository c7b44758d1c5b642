#include "app/paint/highlight_command.h"

#include <algorithm>
#include <chrono>
#include <set>

namespace tuft::app {
namespace {

constexpr float kInked = 0.01f;     // film units from which a texel counts as inked
constexpr double kShowEvery = 0.4;  // seconds between two looks at what was found so far
constexpr std::size_t kOutlinePoints = 1500;

// The entry as it would paint on its own: with a full brush, still, on the first layer, an eraser as if it painted.
stroke::JournalEntry alone(stroke::JournalEntry entry) {
    entry.hidden = false;
    if (stroke::Fill* fill = entry.as<stroke::Fill>()) fill->layer = stroke::kFirstLayer;
    stroke::PaintStroke* stroke = entry.as<stroke::PaintStroke>();
    if (!stroke) return entry;
    stroke->layer = stroke::kFirstLayer;
    stroke->tool = stroke::Tool::brush;
    stroke->settings.dip = stroke::DipMode::each;
    stroke->settings.film = stroke::FilmModel::still;
    return entry;
}

void add_inked(Texture::Marks& marks, const ink::Canvas& canvas) {
    for (const std::uint32_t slot : canvas.touched_slots())
        for (std::size_t p = 0; p < canvas.pigments().size(); ++p)
            if (const ink::Plane* plane = canvas.plane(slot, static_cast<int>(p)))
                for (std::size_t t = 0; t < atlas::kTileTexels; ++t)
                    if ((*plane)[t] > kInked) marks[slot][t] = Texture::kInked;
}

std::vector<OutlinePoint> outline_of(const Texture::Marks& marks, const stroke::Model& model) {
    std::vector<Vec3f> rim;
    for (const auto& [slot, tile] : marks)
        for (std::size_t t = 0; t < atlas::kTileTexels; ++t)
            if (tile[t] == Texture::kRim) rim.push_back(model.texels.position(slot, static_cast<int>(t)));
    std::vector<OutlinePoint> points;
    const std::size_t step = std::max<std::size_t>(1, rim.size() / kOutlinePoints);
    for (std::size_t i = 0; i < rim.size(); i += step)
        if (const auto on = model.query->closest_point(Vec3(rim[i]))) points.push_back({rim[i], Vec3f(on->normal)});
    return points;
}

}  // namespace

// The strokes are painted alone on a blank copy of the model; whatever else is asked for ends that.
void highlight_strokes(PaintContext& context, const HighlightStrokes& command, const CommandQueue& queue) {
    const std::set<std::uint64_t> wanted(command.ids.begin(), command.ids.end());
    const auto show = [&](const Texture::Marks& marks) {
        context.publisher.send_tiles(context.work.texture->show_marks(marks, *context.work.document));
        std::vector<OutlinePoint> outline = outline_of(context.work.texture->marks(), *context.work.model);
        context.outbox.change([&](Update& update) { update.events.outline = std::move(outline); });
    };
    if (wanted.empty() || context.work.document->session()) return show({});
    const ProgressFn go_on = [&](std::string_view, double) { return !queue.interrupts() && !context.stop.load(); };
    Texture::Marks marks;
    auto shown = std::chrono::steady_clock::now();
    try {
        stroke::Document blank(*context.work.model);
        context.take_presets(blank, {});
        for (const stroke::JournalEntry& s : context.work.document->journal().entries()) {
            const bool paints = s.as<stroke::PaintStroke>() || s.as<stroke::Fill>();
            if (s.as<stroke::MaskEdit>() || s.as<stroke::PartEdit>())
                blank.replay({s});
            else if (paints && wanted.contains(s.id) && !stroke::on_palette(s)) {
                blank.paint(alone(s), go_on);
                add_inked(marks, blank.layers().canvas());
                blank.undo();
            }
            if (std::chrono::duration<double>(std::chrono::steady_clock::now() - shown).count() < kShowEvery) continue;
            show(marks);
            shown = std::chrono::steady_clock::now();
        }
    } catch (const Cancelled&) {
        return;
    }
    show(marks);
}

}  // namespace tuft::app
