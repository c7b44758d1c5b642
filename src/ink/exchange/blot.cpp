#include "ink/exchange/blot.h"

#include <algorithm>
#include <array>
#include <memory>

namespace tuft::ink {
namespace {

constexpr int kN = atlas::kTileTexels, kSide = atlas::kTile;
constexpr int kTimes = 2;
constexpr float kGone = 0.02f;    // of what was there
constexpr float kRim = 1.0f / 3;  // of what was there: more is ink that stays
constexpr int kBroad = 5;         // texels: as wide is ink that stays, too

/// Film on the texels of a tile before and after.
struct Film {
    Plane was, is;
};

class Blotting {
  public:
    Blotting(const Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams, const EraseStarts& starts)
        : canvas_(canvas), map_(map), seams_(seams), starts_(starts) {}

    void forget(std::uint32_t slot) { films_.erase(slot); }

    /// Whether a texel is a rim that goes.
    bool goes(const atlas::TexelRef& ref) {
        if (!wet(ref)) return false;
        const Film& own = film(ref.slot);
        float most = own.is[ref.texel], thick = own.was[ref.texel];
        if (!(most > 0)) return false;
        bool beside_gone = false;
        each_neighbour(ref, [&](const atlas::TexelRef& other) {
            const Film& f = film(other.slot);
            const float was = f.was[other.texel], is = f.is[other.texel];
            most = std::max(most, is);
            thick = std::max(thick, was);
            beside_gone = beside_gone || (was > 0 && is <= kGone * was);
        });
        return beside_gone && (most <= kRim * thick || !broad(ref));
    }

  private:
    /// Whether a square of inked texels holds it; what is outside of the chart may be inked.
    bool broad(const atlas::TexelRef& ref) {
        constexpr int kReach = kBroad - 1, kWide = 2 * kReach + 1;
        const auto [x, y] = column_and_row(ref);
        std::array<std::array<bool, kWide>, kWide> inked;
        for (int j = 0; j < kWide; ++j)
            for (int i = 0; i < kWide; ++i) {
                const atlas::TexelRef other = atlas::texel_ref(map_, x + i - kReach, y + j - kReach);
                if (inked[j][i] = !other.valid(); inked[j][i]) continue;
                const Film& f = film(other.slot);
                inked[j][i] = f.is[other.texel] > kGone * f.was[other.texel];
            }
        const auto full = [&](int i0, int j0) {
            for (int j = j0; j < j0 + kBroad; ++j)
                for (int i = i0; i < i0 + kBroad; ++i)
                    if (!inked[j][i]) return false;
            return true;
        };
        for (int j = 0; j < kBroad; ++j)
            for (int i = 0; i < kBroad; ++i)
                if (full(i, j)) return true;
        return false;
    }
    std::array<std::int64_t, 2> column_and_row(const atlas::TexelRef& ref) const {
        const atlas::TexelPlace at = atlas::texel_place(map_, ref.slot, ref.texel);
        return {at.x, at.y};
    }
    bool wet(const atlas::TexelRef& ref) const {
        const auto has = [&](Liquid where) {
            const Plane* w = canvas_.liquid(ref.slot, where);
            return w && (*w)[ref.texel] > 0;
        };
        return has(Liquid::film) || has(Liquid::pores);
    }
    const Film& film(std::uint32_t slot) {
        std::unique_ptr<Film>& f = films_[slot];
        if (!f) {
            f = std::make_unique<Film>();
            f->is = erase_start(canvas_, slot).film;
            const auto start = starts_.find(slot);
            f->was = start == starts_.end() ? f->is : start->second.film;
        }
        return *f;
    }
    template <class Fn>
    void each_neighbour(const atlas::TexelRef& ref, Fn fn) const {
        const auto [x, y] = column_and_row(ref);
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
                if (dx || dy)
                    if (const atlas::TexelRef other = atlas::texel_ref(map_, x + dx, y + dy); other.valid()) fn(other);
        for (std::uint32_t k = seams_.start[ref.slot]; k < seams_.start[ref.slot + 1]; ++k)
            if (const atlas::SeamLink& l = seams_.links[k]; l.texel == ref.texel) fn({l.other_slot, l.other_texel});
    }

    const Canvas& canvas_;
    const atlas::TexelMap& map_;
    const atlas::SeamLinks& seams_;
    const EraseStarts& starts_;
    std::unordered_map<std::uint32_t, std::unique_ptr<Film>> films_;
};

/// The slots that were erased from, and those next to them, ascending.
std::vector<std::uint32_t> slots_about(const atlas::TexelMap& map, const atlas::SeamLinks& seams,
                                       const EraseStarts& starts) {
    std::vector<std::uint32_t> slots;
    const auto n = static_cast<std::int64_t>(map.tiles_per_side);
    for (const auto& [slot, start] : starts) {
        const std::int64_t x = map.tile_of_slot[slot] % n, y = map.tile_of_slot[slot] / n;
        for (std::int64_t by = std::max<std::int64_t>(y - 1, 0); by <= std::min(y + 1, n - 1); ++by)
            for (std::int64_t bx = std::max<std::int64_t>(x - 1, 0); bx <= std::min(x + 1, n - 1); ++bx)
                if (const std::uint32_t s = map.slot_of_tile[static_cast<std::size_t>(by * n + bx)]; s != kNone)
                    slots.push_back(s);
        for (std::uint32_t k = seams.start[slot]; k < seams.start[slot + 1]; ++k)
            slots.push_back(seams.links[k].other_slot);
    }
    std::sort(slots.begin(), slots.end());
    slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
    return slots;
}

}  // namespace

Amounts blot(Canvas& canvas, const atlas::TexelMap& map, const atlas::SeamLinks& seams, const EraseStarts& starts,
             const std::function<bool(std::uint32_t, int)>& free, const std::function<void(std::uint32_t)>& before) {
    Amounts gone;
    if (starts.empty() || !canvas.wet()) return gone;
    Blotting blotting(canvas, map, seams, starts);
    const std::vector<std::uint32_t> slots = slots_about(map, seams, starts);
    for (int time = 0; time < kTimes; ++time) {
        std::vector<atlas::TexelRef> rim;
        for (const std::uint32_t slot : slots)
            for (int t = 0; t < kN && canvas.touched(slot); ++t)
                if (const atlas::TexelRef ref{slot, static_cast<std::uint8_t>(t)};
                    map.tiles[slot].cluster[t] != atlas::kNoCluster && (!free || free(slot, t)) && blotting.goes(ref))
                    rim.push_back(ref);
        for (std::size_t i = 0; i < rim.size(); ++i) {
            const auto [slot, texel] = rim[i];
            if (i == 0 || rim[i - 1].slot != slot) before(slot), blotting.forget(slot), canvas.mark_dirty(slot);
            const auto area = static_cast<double>(map.tiles[slot].area[texel]);
            const auto empty = [area](Plane& plane, std::uint8_t t, double& sum) {
                sum += static_cast<double>(plane[t]) * area;
                plane[t] = 0;
            };
            for (int film = 0; film < kFilms; ++film)
                for (int p = 0; p < kMaxPigments; ++p)
                    if (canvas.film_plane(slot, film, p))
                        empty(canvas.touch_film(slot, film, p), texel, gone.pigment[p]);
            for (const Liquid where : {Liquid::film, Liquid::pores})
                if (canvas.liquid(slot, where)) empty(canvas.touch_liquid(slot, where), texel, gone.liquid);
        }
    }
    return gone;
}

}  // namespace tuft::ink
