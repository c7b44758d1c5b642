#include "ink/film/seepage.h"

#include <algorithm>
#include <cmath>

#include "ink/film/film_seams.h"

namespace tuft::ink::wet {
namespace {

constexpr std::size_t kGrain = 8;  // tiles
constexpr int kMostStages = 60;
constexpr double kFreshStep = 0.05;  // seconds
// Film units: by so little rounding may bring an amount below 0.
constexpr float kRounding = 1e-5f;
constexpr float kMostNear = 8;         // of what smears between two texels, over that of whole texels side by side
constexpr float kMostSmeared = 0.04f;  // of the lesser amount, times the link's weight
constexpr float kHalfHeld = 0.1f;      // pigment over liquid at which fibres hold half of what they hold of thick ink
constexpr Plane kDry{};

/// Stages of a step in which (with one stage) `part` of a texel would leave it; kMostStages at most.
int stages_of(double part) {
    const double n = std::ceil(0.5 * (std::sqrt(9 + 16 * part) - 3) * (1 - 1e-9));
    return static_cast<int>(std::clamp(n, 1.0, static_cast<double>(kMostStages)));
}
bool all_zero(std::span<const float> plane) {
    float most = 0;
    for (const float v : plane) most = std::max(most, std::abs(v));
    return !(most > 0);
}
double part_of(int n_stages) {
    return (n_stages * n_stages + 3 * n_stages) / 4.0;
}

}  // namespace

bool Seepage::find(const TileList& tiles, std::span<const Sources> sources) {
    const auto& list = tiles.list;
    std::vector<std::uint8_t> wanted(list.size(), 0);
    for (std::uint32_t at = 0; at < list.size(); ++at)
        if (sources[at].liquid[0] || sources[at].liquid[1]) {
            for (const std::uint32_t i : list[at].around)
                if (i != kNone) wanted[i] = 1;
            for (const SeamNeighbour& other : list[at].seams.others)
                if (other.linked && other.place != kNone) wanted[other.place] = 1;
        }
    places_.clear();
    for (std::uint32_t i = 0; i < list.size(); ++i)
        if (wanted[i]) places_.push_back(i);
    return !places_.empty();
}

void Seepage::take_tiles(const TileList& tiles, std::span<const Sources> sources) {
    tiles_.take(places_, tiles.list.size());
    for (const auto& tile : tiles_) {
        const auto [w, s] = sources[tile->place].liquid;
        tile->film = (w ? w : &kDry)->data();
        tile->start = (s ? s : &kDry)->data();
    }
    tiles_.each(kGrain, [&](SeepTile& t) { open_tile(t, tiles.list[t.place]); });
}

void Seepage::open_tile(SeepTile& tile, const Active& active) const {
    static constexpr auto kAll = [] {
        std::array<float, kTexels> ones;
        ones.fill(1);
        return ones;
    }();
    const auto in_set = [&](std::uint32_t place) { return tiles_.index(place); };
    std::array<const float*, 9> open;
    for (std::size_t i = 0; i < 9; ++i) {
        tile.around[i] = in_set(active.around[i]);
        open[i] = tile.around[i] == kNone ? kDry.data() : kAll.data();
    }
    gather_field(tile.open, open);
    tile.fed = !all_zero({tile.film, kTexels});
    tile.starts_dry = !tile.fed && all_zero({tile.start, kTexels});
    tile.links.clear();
    for (std::size_t i = 0; i < active.seams.links.size(); ++i) {
        const atlas::SeamLink& l = active.seams.links[i];
        const std::uint32_t other = in_set(active.seams.others[active.seams.link_others[i]].place);
        if (other != kNone)
            tile.links.push_back({other, l.texel, l.other_texel, l.weight, static_cast<float>(l.apart) / 64});
    }
}

Field Seepage::padded(const SeepTile& tile, int plane) const {
    std::array<const float*, 9> from;
    for (std::size_t i = 0; i < 9; ++i)
        from[i] = tile.around[i] == kNone ? kDry.data() : plane_of(tiles_[tile.around[i]], plane);
    Field field;
    std::fill(field.begin() + kRow * kRow, field.end(), 0.0f);
    gather_field(field, from);
    return field;
}

const float* Seepage::plane_of(const SeepTile& tile, int plane) {
    if (plane == kStart) return tile.start;
    return plane == kCarried ? tile.carried.data() : tile.s[static_cast<std::size_t>(plane)].data();
}

bool Seepage::run_stages(const TileList& tiles, double flow, double soak, int n_stages) {
    tiles_.each(kGrain, [&](SeepTile& t) {
        t.dry = t.starts_dry;
        if (t.dry) t.s = {};
        t.least = 0;
        t.faces = {};
        t.soaked = {};
        for (SeepLink& l : t.links) l.through = {};
        t.beyond.fill(0);
    });
    for (int j = 1; j <= n_stages; ++j) {
        const SeepStage stage{
            .flow = static_cast<float>(flow * params_.pores.capacity / (kSaturationPower + 1) / part_of(n_stages)),
            .soak = static_cast<float>(soak / part_of(n_stages)),
            .per_pores = static_cast<float>(1 / params_.pores.capacity),
            .now = static_cast<float>(2 * j + 1) / static_cast<float>(j + 2),
            .before = static_cast<float>(j - 1) / static_cast<float>(j + 2),
            .from = (j + 1) % 2};
        const int from = j == 1 ? kStart : stage.from;
        tiles_.each(kGrain, [&](SeepTile& t) { run_stage(tiles, t, from, stage); });
        last_ = 1 - stage.from;
    }
    return std::all_of(tiles_.begin(), tiles_.end(), [](const auto& t) { return t->least >= -kRounding; });
}

bool Seepage::reached(const SeepTile& tile, const Field& s, int from) const {
    return !all_zero(s) || std::any_of(tile.links.begin(), tile.links.end(), [&](const SeepLink& l) {
        return plane_of(tiles_[l.other], from)[l.other_texel] != 0;
    });
}

void Seepage::run_stage(const TileList& tiles, SeepTile& tile, int from, const SeepStage& stage) const {
    const Field s = padded(tile, from);
    if (tile.dry && !reached(tile, s, from)) return;
    tile.dry = false;
    for (const SeepLink& l : tile.links) tile.beyond[l.texel] = 0;
    for (SeepLink& l : tile.links) {
        seep_over_link(l, plane_of(tile, from)[l.texel], plane_of(tiles_[l.other], from)[l.other_texel], stage);
        tile.beyond[l.texel] += l.through[static_cast<std::size_t>(1 - stage.from)];
    }
    seep_stage(tile, s, *tiles.list[tile.place].faces.geometry, stage);
}

double Seepage::fresh_step(const atlas::TexelMap& map) const {
    const double area = map.texel_size * map.texel_size;
    return std::max(kFreshStep, params_.pores.suction > 0 ? area / params_.pores.suction : 0);
}

double Seepage::solve(const TileList& tiles, std::span<const Sources> sources, double dt) {
    take_tiles(tiles, sources);
    double stiffness = 4, w = 0, most = 0;
    for (const auto& t : tiles_) {
        const Active& active = tiles.list[t->place];
        const auto own = static_cast<double>(active.faces.stiffness);
        stiffness = std::max({stiffness, own, t->links.empty() ? 0 : own + kSeamPart});
        w = std::max(w, static_cast<double>(active.outcome.most_w));
        most =
            std::max(most, static_cast<double>(active.outcome.most_s + active.outcome.most_w) / params_.pores.capacity);
    }
    const double area = tiles.map.texel_size * tiles.map.texel_size,
                 rate = params_.pores.suction / (kFrontConstant * kFrontConstant) / area,
                 fastest = std::pow(std::min(most, 1.0), kSaturationPower),
                 leaving = rate * stiffness * fastest + params_.pores.absorbency * (1 + w / params_.pores.capacity);
    if (dt * leaving > part_of(kMostStages)) dt = part_of(kMostStages) / leaving;
    while (!run_stages(tiles, dt * rate, dt * params_.pores.absorbency, stages_of(dt * leaving)) && dt * leaving > 1)
        dt *= 0.5;
    tiles_.each(kGrain, [&](SeepTile& t) {
        if (t.dry) return;
        smear_links(t);
        find_carried(t, tiles, sources[t.place]);
    });
    return dt;
}

void Seepage::smear_links(SeepTile& tile) const {
    const auto total = [](const SeepTile& t, std::uint8_t texel) { return t.start[texel] + t.film[texel]; };
    for (SeepLink& l : tile.links) {
        const float near = std::min(std::max(1 / std::max(l.apart * l.apart, 1e-6f), 1.0f), kMostNear) - 1;
        const float least = std::min(total(tile, l.texel), total(tiles_[l.other], l.other_texel));
        l.smeared = 0.5f * std::min(near * std::abs(l.through[static_cast<std::size_t>(last_)]),
                                    kMostSmeared * l.weight * least);
    }
}

void Seepage::find_carried(SeepTile& tile, const TileList& tiles, const Sources& from) const {
    const auto retention = static_cast<float>(params_.pores.retention), grip = static_cast<float>(params_.grip);
    Plane pigments{}, rate;
    for (const Plane* open : from.open)
        for (int i = 0; open && i < kTexels; ++i) pigments[i] += (*open)[i];
    for (int i = 0; i < kTexels; ++i) {
        const float total = tile.film[i] + tile.start[i],
                    held = retention * pigments[i] / (pigments[i] + kHalfHeld * total + kRounding);
        rate[i] = total > 0 ? (1 - held) / std::max(total, grip) : 0;
    }
    limit_carried(tile, *tiles.list[tile.place].faces.geometry, last_, rate);
}

void Seepage::flow(std::uint32_t place, const TileList& tiles, std::span<const Sources> sources, int pigments,
                   Work& work, Crossing& crossing) const {
    const SeepTile& tile = *this->tile(place);
    const Active& active = tiles.list[place];
    seepage_flow(work, tile, *active.faces.geometry, last_, padded(tile, kCarried));
    crossing.clear(tile.links.size(), pigments);
    for (const SeepLink& l : tile.links) {
        const SeepTile& other = tiles_[l.other];
        const Sources& from = sources[other.place];
        for (int p = 0; p < pigments; ++p) {
            const Plane* open = from.open[static_cast<std::size_t>(p)];
            crossing.beyond[static_cast<std::size_t>(p) * crossing.links + crossing.size] = at(open, l.other_texel);
            crossing.pigments |= static_cast<std::uint32_t>(open != nullptr) << p;
        }
        const float through = l.through[static_cast<std::size_t>(last_)];
        SeamLanes& lanes = crossing.lanes[crossing.size / kSide];
        lanes.a[crossing.size % kSide] = (std::max(through, 0.0f) + l.smeared) * tile.carried[l.texel];
        lanes.b[crossing.size % kSide] = (std::min(through, 0.0f) - l.smeared) * other.carried[l.other_texel];
        crossing.texels[crossing.size++] = l.texel;
    }
}

}  // namespace tuft::ink::wet
