#include "atlas/texels/seam_links.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

#include "atlas/texels/border_cells.h"

namespace tuft::atlas {
namespace {

std::array<std::int64_t, 2> place(const TexelMap& map, const TexelRef& ref) {
    const TexelPlace at = texel_place(map, ref.slot, ref.texel);
    return {at.x, at.y};
}

/// The face as its lower texel, or the left one of a row, holds it.
std::pair<std::uint32_t, SeamFace> face_of(const TexelMap& map, const BorderFace& f) {
    const auto a = place(map, f.a), b = place(map, f.b);
    const bool first = a[1] != b[1] ? a[1] < b[1] : a[0] < b[0];
    const TexelRef& low = first ? f.a : f.b;
    const std::int64_t dx = first ? b[0] - a[0] : a[0] - b[0];
    SeamFace out{low.texel, SeamFace::right, static_cast<float>(f.conductance)};
    if (a[1] != b[1]) out.direction = dx == 0 ? SeamFace::above : dx > 0 ? SeamFace::above_right : SeamFace::above_left;
    return {low.slot, out};
}

}  // namespace

SeamLinks build_seam_links(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map) {
    const BorderCells border = build_border_cells(mesh, atlas, map);
    std::vector<std::pair<std::uint32_t, SeamLink>> links;
    std::vector<std::pair<std::uint32_t, SeamFace>> faces;
    for (const BorderFace& f : border.faces) {
        const auto weight = static_cast<float>(f.conductance);
        if (f.over_seam) {
            if (!(weight > 0)) continue;
            const auto apart = static_cast<std::uint8_t>(std::min(std::round(64 * f.distance), 255.0));
            links.push_back({f.a.slot, {f.b.slot, weight, f.a.texel, f.b.texel, apart}});
            links.push_back({f.b.slot, {f.a.slot, weight, f.b.texel, f.a.texel, apart}});
        } else
            faces.push_back(face_of(map, f));
    }
    std::sort(links.begin(), links.end(), [](const auto& x, const auto& y) {
        return std::tie(x.first, x.second.texel, x.second.other_slot, x.second.other_texel) <
               std::tie(y.first, y.second.texel, y.second.other_slot, y.second.other_texel);
    });
    std::sort(faces.begin(), faces.end(), [](const auto& x, const auto& y) {
        return std::tie(x.first, x.second.texel, x.second.direction) <
               std::tie(y.first, y.second.texel, y.second.direction);
    });
    SeamLinks result;
    result.start.assign(map.n_slots() + 1, 0);
    result.face_start.assign(map.n_slots() + 1, 0);
    for (const auto& [slot, link] : links) {
        ++result.start[slot + 1];
        result.links.push_back(link);
    }
    for (const auto& [slot, face] : faces) {
        ++result.face_start[slot + 1];
        result.faces.push_back(face);
    }
    result.tap_start.assign(map.n_slots() + 1, 0);
    for (const BorderTap& t : border.taps) {
        ++result.tap_start[t.texel.slot + 1];
        SeamTap& tap = result.taps.emplace_back(
            SeamTap{t.other.slot, static_cast<float>(t.weight), t.texel.texel, t.other.texel, t.side});
        if (t.over_seam) continue;
        const auto from = place(map, t.texel), to = place(map, t.other);
        tap.other_slot = kNone;
        tap.other_texel = static_cast<std::uint8_t>(to[0] - from[0] + 1 + 3 * (to[1] - from[1] + 1));
    }
    std::partial_sum(result.tap_start.begin(), result.tap_start.end(), result.tap_start.begin());
    std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
    std::partial_sum(result.face_start.begin(), result.face_start.end(), result.face_start.begin());
    return result;
}

}  // namespace tuft::atlas
