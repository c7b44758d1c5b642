#include "stroke/drawing/plane_ink.h"

#include <algorithm>
#include <cmath>

#include "brush/tuft/tuft.h"
#include "brush/tuft/upright_hair.h"
#include "footprint/outline/cuts.h"
#include "footprint/outline/section_outline.h"
#include "stroke/drawing/line_width.h"
#include "stroke/gesture/resample.h"
#include "stroke/placement/holder.h"
#include "stroke/placement/tip_lag.h"

namespace tuft::stroke {
namespace {

std::uint64_t key_of(std::int64_t i, std::int64_t j) {
    return (static_cast<std::uint64_t>(i) << 32) ^ (static_cast<std::uint64_t>(j) & 0xFFFFFFFFu);
}

std::int64_t tile_of(std::int64_t cell, int tile) {
    return cell >= 0 ? cell / tile : -((tile - 1 - cell) / tile);
}

}  // namespace

void PlaneInk::add(const footprint::Footprint& f, double time) {
    if (f.empty()) return;
    const auto i0 = static_cast<std::int64_t>(std::llround(f.lo.x / cell_)),
               j0 = static_cast<std::int64_t>(std::llround(f.lo.y / cell_));
    for (int y = 0; y < f.height; ++y) {
        const std::int64_t j = j0 + y, tile_j = tile_of(j, kTile);
        for (int x = 0; x < f.width;) {
            const std::int64_t i = i0 + x, tile_i = tile_of(i, kTile);
            const int in = static_cast<int>(i - tile_i * kTile), n = std::min(kTile - in, f.width - x);
            const std::uint8_t* from = f.coverage.data() + std::size_t(y) * f.width + x;
            if (std::any_of(from, from + n, [](std::uint8_t c) { return c > 0; })) {
                Tile& tile = tiles_[key_of(tile_i, tile_j)];
                const std::size_t at = std::size_t(j - tile_j * kTile) * kTile + in;
                for (int k = 0; k < n; ++k) {
                    if (from[k] > 127 && tile.coverage[at + k] <= 127) tile.first[at + k] = static_cast<float>(time);
                    tile.coverage[at + k] = std::max(tile.coverage[at + k], from[k]);
                }
            }
            x += n;
        }
    }
}

const PlaneInk::Tile* PlaneInk::tile(std::int64_t i, std::int64_t j, std::size_t& cell) const {
    const std::int64_t tile_i = tile_of(i, kTile), tile_j = tile_of(j, kTile);
    cell = static_cast<std::size_t>((j - tile_j * kTile) * kTile + i - tile_i * kTile);
    const auto found = tiles_.find(key_of(tile_i, tile_j));
    return found == tiles_.end() ? nullptr : &found->second;
}

double PlaneInk::value(std::int64_t i, std::int64_t j) const {
    std::size_t cell = 0;
    const Tile* t = tile(i, j, cell);
    return t ? t->coverage[cell] / 255.0 : 0;
}

double PlaneInk::when(const Vec2& p) const {
    std::size_t cell = 0;
    const Tile* t = tile(static_cast<std::int64_t>(std::floor(p.x / cell_)),
                         static_cast<std::int64_t>(std::floor(p.y / cell_)), cell);
    return t && t->coverage[cell] > 127 ? static_cast<double>(t->first[cell]) : -1;
}

double PlaneInk::at(const Vec2& p) const {
    const Vec2 cells = p / cell_ - 0.5, low = glm::floor(cells), f = cells - low;
    const auto i = static_cast<std::int64_t>(low.x), j = static_cast<std::int64_t>(low.y);
    std::size_t cell = 0;
    const Tile* one = tile(i, j, cell);
    if (cell % kTile + 1 < kTile && cell / kTile + 1 < kTile) {  // all four in one tile
        if (!one) return 0;
        const auto in_tile = [&](std::size_t k) { return one->coverage[cell + k] / 255.0; };
        return std::lerp(std::lerp(in_tile(0), in_tile(1), f.x), std::lerp(in_tile(kTile), in_tile(kTile + 1), f.x),
                         f.y);
    }
    return std::lerp(std::lerp(value(i, j), value(i + 1, j), f.x), std::lerp(value(i, j + 1), value(i + 1, j + 1), f.x),
                     f.y);
}

PlaneInk plane_ink(const StrokeSamples& trace, const brush::Preset& preset, const HolderOptions& options, double step,
                   double cell) {
    const Frame plane_frame;
    std::vector<brush::Pose> poses;
    const StrokeSamples led = lift_off(compensate_tip_lag(trace, options), options);
    const std::vector<double> depths = tip_depths<StrokeSample>(led.samples, options);
    for (std::size_t i = 0; i < led.samples.size(); ++i) {
        const StrokeSample& s = led.samples[i];
        poses.push_back(pose_holder({s.position.x, -s.position.y, 0}, 0,
                                    {.depth = depths[i], .tilt = s.tilt, .roll = s.roll, .time = s.time}, options));
    }
    brush::Tuft tuft = brush::make_tuft(preset);
    const brush::ContactPlane plane;
    PlaneInk ink(cell);
    double time = 0;
    bool first = true;
    Recycled<footprint::Outline> outlines;
    for (const brush::Pose& pose : resample(poses, {.step = step, .lever = preset.length})) {
        const brush::TuftState state = brush::step(tuft, pose, {&plane, 1}, first ? 0 : pose.time - time);
        time = pose.time;
        first = false;
        if (!state.touching) continue;
        if (tuft.carried) {
            ink.add(footprint::rasterise_polygons(
                        footprint::shape_polygons(tuft, state.shape, plane_frame, {.film = kSkinFilm}), plane_frame, 0,
                        cell),
                    std::max(0.0, time));
            continue;
        }
        Recycled<footprint::Trail> trails = footprint::find_trails(state, plane_frame, {}, preset.length, kSkinFilm);
        footprint::cover_upright_hair(trails, brush::upright_hair_of(tuft, plane), plane_frame, kSkinFilm);
        outlines.clear();
        for (const footprint::Trail& trail : trails)
            if (footprint::Outline o = footprint::outline_of(trail, footprint::OutlineOptions{}.points);
                o.left.size() >= 3)
                outlines.push_back(std::move(o));
        ink.add(footprint::rasterise(outlines, plane_frame, 0, cell), std::max(0.0, time));
    }
    return ink;
}

}  // namespace tuft::stroke
