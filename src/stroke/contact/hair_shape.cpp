#include "stroke/contact/hair_shape.h"

#include "footprint/outline/hair.h"
#include "stroke/drawing/line_width.h"

namespace tuft::stroke {

HairShape find_hair(const brush::Tuft& tuft, const contact::Result& contact) {
    HairShape hair;
    if (!brush::is_foam(tuft.preset))
        hair.trails =
            footprint::find_trails(contact.tuft, contact.frame, contact.branch_planes, tuft.preset.length, kSkinFilm);
    if (!contact.planes.empty() && !tuft.carried) hair.upright = brush::upright_hair_of(tuft, contact.planes.front());
    return hair;
}

void close_hair(HairShape& hair, const contact::Result& contact, double cell) {
    std::vector<footprint::Trail> trails = hair.trails;
    footprint::cover_upright_hair(trails, hair.upright, contact.frame, kSkinFilm);
    hair.outlines = footprint::outlines_of(trails, footprint::OutlineOptions{}.points);
    hair.closed = footprint::rasterise(hair.outlines, contact.frame, contact.triangle, cell);
}

}  // namespace tuft::stroke
