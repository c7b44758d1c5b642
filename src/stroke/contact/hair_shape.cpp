#include "stroke/contact/hair_shape.h"

#include "footprint/outline/hair.h"
#include "stroke/drawing/line_width.h"

namespace tuft::stroke {

void LastHair::store(const brush::Tuft& tuft, const brush::Pose& at, const HairShape& hair,
                     const contact::Result& contact) {
    constexpr int kMostMissed = 2;
    if (!tuft.wide()) return;
    if (!touches(contact)) {
        if (++missed > kMostMissed) trails.clear();
        return;
    }
    missed = 0;
    trails = hair.trails;
    frame = contact.frame;
    root = at.position;
}

HairShape find_hair(const brush::Tuft& tuft, const contact::Result& contact, const LastHair& last) {
    HairShape hair;
    if (!brush::is_foam(tuft.preset))
        hair.trails =
            footprint::find_trails(contact.tuft, contact.frame, contact.branch_planes, tuft.preset.length, kSkinFilm);
    if (!contact.planes.empty() && !tuft.carried) hair.upright = brush::upright_hair_of(tuft, contact.planes.front());
    if (!last.trails.empty()) {
        const Vec2 hand(contact.frame.to_local(contact.frame.origin + tuft.pose.position - last.root));
        hair.leapt = footprint::leapt_trails(hair.trails, contact.frame, last.trails, last.frame, hand);
    }
    return hair;
}

void close_hair(HairShape& hair, const contact::Result& contact, double cell) {
    std::vector<footprint::Trail> trails = hair.trails;
    footprint::cover_upright_hair(trails, hair.upright, contact.frame, kSkinFilm);
    hair.outlines = footprint::outlines_of(trails, footprint::OutlineOptions{}.points, hair.leapt);
    hair.closed = footprint::rasterise(hair.outlines, contact.frame, contact.triangle, cell);
}

}  // namespace tuft::stroke
