#pragma once

#include "stroke/document/document.h"

/// \file
/// Where ink lies on a model, for tests of placement.
namespace tuft::stroke::test {

/// Returns the centroid of the ink of an empty painting after an entry, metres.
inline Vec3 ink_centre(Document& painting, const JournalEntry& entry) {
    painting.paint(entry);
    const Model& model = painting.model();
    Vec3 sum(0);
    double all = 0;
    const ink::Canvas& canvas = painting.layers().canvas();
    for (const std::uint32_t slot : canvas.touched_slots())
        if (const ink::Plane* plane = canvas.plane(slot, 0))
            for (int t = 0; t < atlas::kTileTexels; ++t) {
                const double amount = (*plane)[t] * static_cast<double>(model.texels.tiles[slot].area[t]);
                if (amount > 0) all += amount, sum += amount * Vec3(model.texels.position(slot, t));
            }
    return sum / all;
}

/// Returns the centroid of the ink that an entry leaves on a model, metres.
inline Vec3 ink_centre(const Model& model, const JournalEntry& entry) {
    Document painting(model);
    return ink_centre(painting, entry);
}

}  // namespace tuft::stroke::test
