#include "stroke/drawing/copies.h"

#include <numbers>

#include "brush/preset/preset.h"
#include "stroke/drawing/drawing.h"

namespace tuft::stroke {
namespace {

void place_copy(Placement& p, const PoseMap& map, bool reflects) {
    p = {map.point(p.origin), (reflects ? -1.0 : 1.0) * (map.linear * p.right), map.linear * p.down, p.mapping};
}

void copy_trace(StrokeSamples& trace, const PoseMap& map, bool reflects, CopyReading reading) {
    if (trace.flat) {
        place_copy(trace.placement, map, reflects);
        if (reflects && reading != CopyReading::upright) transform_samples(trace, Vec2(0), 1, true);
        return;
    }
    for (StrokeSample& sample : trace.samples) {
        const brush::Pose pose = map.pose({sample.position, sample.rotation, sample.time});
        sample.position = pose.position;
        sample.rotation = pose.rotation;
    }
}

/// The roll that the settings add, in a mirrored copy of a flat stroke. The samples' rolls change their sign, by which
/// the ferrule's x comes to lie along its image the other way round: that is no matter unless one edge is longer.
void mirror_roll(PaintStroke& stroke) {
    const bool slanted = !stroke.brush.empty() && brush::load_preset(stroke.brush).slant > 0;
    stroke.settings.roll = (slanted ? std::numbers::pi : 0) - stroke.settings.roll;
}

void copy_area(FlatArea& area, const PoseMap& map, bool reflects, CopyReading reading) {
    place_copy(area.placement, map, reflects);
    if (!reflects || reading == CopyReading::upright) return;
    transform_area(area, Vec2(0), 1, true);
    if (reading != CopyReading::upright_parts || area.reading.part.empty()) return;
    const Vec2 low = area.low, high = area.high, centre = area.reading.centre;
    transform_area(area, Vec2(centre.x, 0), 1, true);
    transform_area(area, Vec2(-centre.x, 0), 1);
    area.low = low, area.high = high;
}

bool is_copied(const JournalEntry& entry) {
    switch (kind_of(entry)) {
        case EntryKind::layer:
        case EntryKind::mask:
        case EntryKind::part:
        case EntryKind::wash:
            return false;
        case EntryKind::fill:
            return entry.get<Fill>().area.has_value();
        default:
            return true;
    }
}

}  // namespace

JournalEntry copy_of(const JournalEntry& entry, const PoseMap& map, CopyReading reading) {
    const bool reflects = glm::determinant(map.linear) < 0;
    JournalEntry copy = entry;
    if (PaintStroke* stroke = copy.as<PaintStroke>()) {
        copy_trace(stroke->trace, map, reflects, reading);
        if (reflects && stroke->trace.flat && reading != CopyReading::upright) mirror_roll(*stroke);
    }
    if (Fill* fill = copy.as<Fill>(); fill && fill->area) copy_area(*fill->area, map, reflects, reading);
    return copy;
}

std::vector<JournalEntry> symmetric_copies(std::span<const JournalEntry> entries, const Symmetry& symmetry,
                                           CopyReading reading, const EntryGroup& first_group) {
    std::vector<JournalEntry> copies;
    EntryGroup group = first_group;
    for (const PoseMap& map : symmetry_copies(symmetry)) {
        for (const JournalEntry& entry : entries) {
            if (!is_copied(entry)) continue;
            copies.push_back(copy_of(entry, map, reading));
            copies.back().group = group;
        }
        ++group.id;
    }
    return copies;
}

}  // namespace tuft::stroke
