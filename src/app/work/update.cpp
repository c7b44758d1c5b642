#include "app/work/update.h"

#include <algorithm>
#include <span>

namespace tuft::app {

namespace {

PathSketch sketch_path(std::span<const stroke::StrokeSample> samples, bool flat) {
    PathSketch path{.flat = flat};
    if (samples.empty()) return path;
    Vec3 normal(0);
    Vec3 mean(0);
    for (const stroke::StrokeSample& s : samples) {
        normal += flat ? Vec3(0, 0, 1) : glm::normalize(s.rotation) * Vec3(0, 0, 1);
        mean += s.position / static_cast<double>(samples.size());
    }
    if (glm::length(normal) < 1e-9) normal = {0, 0, 1};
    normal = glm::normalize(normal);
    // Seen from outside with z, or else y, upwards.
    const Vec3 above = std::abs(normal.z) < 0.95 ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
    Vec3 right = glm::normalize(glm::cross(above, normal));
    Vec3 down = -glm::cross(normal, right);
    if (flat) right = {1, 0, 0}, down = {0, 1, 0};
    double lo_x = 0, hi_x = 0, lo_y = 0, hi_y = 0, lo_z = 1e9, hi_z = -1e9;
    const std::size_t n = std::min<std::size_t>(40, samples.size());
    std::vector<Vec3> points;
    for (std::size_t i = 0; i < n; ++i) {
        const stroke::StrokeSample& s = samples[i * (samples.size() - 1) / std::max<std::size_t>(1, n - 1)];
        const Vec3 d = s.position - mean;
        points.emplace_back(glm::dot(d, right), glm::dot(d, down), flat ? -s.pressure : glm::dot(d, normal));
        lo_x = std::min(lo_x, points.back().x), hi_x = std::max(hi_x, points.back().x);
        lo_y = std::min(lo_y, points.back().y), hi_y = std::max(hi_y, points.back().y);
        lo_z = std::min(lo_z, points.back().z), hi_z = std::max(hi_z, points.back().z);
    }
    const double span = std::max({hi_x - lo_x, hi_y - lo_y, 1e-4});
    path.centre = Vec2(mean) + Vec2(0.5 * (lo_x + hi_x), 0.5 * (lo_y + hi_y));
    path.span = span;
    for (const Vec3& p : points)
        path.points.emplace_back(0.5 + (p.x - 0.5 * (lo_x + hi_x)) / span, 0.5 + (p.y - 0.5 * (lo_y + hi_y)) / span,
                                 (hi_z - p.z) / std::max(1e-6, hi_z - lo_z));
    return path;
}

}  // namespace

std::vector<PartChange> part_changes(const stroke::PartTable& before, const stroke::PartEdit& edit) {
    using What = PartChange::What;
    std::vector<PartChange> changes;
    const auto add = [&](What what, const std::string& name, const std::string& substrate = {}) {
        const auto same = std::ranges::find_if(
            changes, [&](const PartChange& c) { return c.what == what && c.substrate == substrate; });
        PartChange& change = same != changes.end() ? *same : changes.emplace_back(PartChange{what, substrate, {}});
        change.names.push_back(name);
    };
    for (const stroke::Part& now : edit.parts) {
        const stroke::Part was = before.state_of(now.name);
        if (now.hidden != was.hidden) add(now.hidden ? What::hidden : What::shown, now.name);
        if (now.locked != was.locked) add(now.locked ? What::locked : What::unlocked, now.name);
        stroke::Part remade = was;
        remade.substrate = now.substrate;
        if (remade == was) continue;
        if (now.substrate)
            add(What::made_of, now.name, now.substrate->name);
        else
            add(What::as_model, now.name);
    }
    return changes;
}

StrokeLine stroke_line(const stroke::JournalEntry& entry) {
    const stroke::PaintStroke* stroke = entry.as<stroke::PaintStroke>();
    StrokeLine line{.id = entry.id,
                    .action = stroke::kind_of(entry),
                    .brush = stroke::brush_of(entry),
                    .ink = stroke::ink_of(entry),
                    .label = entry.label,
                    .group = entry.group,
                    .hidden = entry.hidden,
                    .erases = stroke && stroke->erases(),
                    .on_palette = stroke::on_palette(entry)};
    if (const auto* edit = entry.as<stroke::LayerEdit>()) line.change = edit->what;
    const bool flat = stroke::samples_of(entry).flat;
    const std::vector<stroke::StrokeSample>& samples = stroke::samples_of(entry).samples;
    if (stroke && flat && !line.on_palette) line.placement = stroke->trace.placement;
    if (const auto* fill = entry.as<stroke::Fill>(); fill && fill->area) {
        line.is_area = true;
        line.placement = fill->area->placement;
    }
    line.path = sketch_path(samples, flat);
    for (std::size_t i = 1; i < samples.size(); ++i)
        line.length += glm::distance(samples[i - 1].position, samples[i].position);
    return line;
}

}  // namespace tuft::app
