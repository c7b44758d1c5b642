#include "stroke/drawing/plane_ink.h"

#include <algorithm>
#include <cmath>
#include <limits>

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

constexpr int kMostMissed = 2;  // poses in the air after which what was before is forgotten, as of a stroke

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

// Whole numbers: the order of the tiles does not matter.
std::optional<Vec2> PlaneInk::centre() const {
    std::int64_t sum = 0, x = 0, y = 0;
    for (const auto& [key, tile] : tiles_) {
        const auto i = static_cast<std::int64_t>(static_cast<std::int32_t>(key >> 32)) * kTile;
        const auto j = static_cast<std::int64_t>(static_cast<std::int32_t>(key & 0xFFFFFFFFu)) * kTile;
        for (int k = 0; k < kTile * kTile; ++k) {
            const std::int64_t c = tile.coverage[static_cast<std::size_t>(k)];
            sum += c, x += c * (i + k % kTile), y += c * (j + k / kTile);
        }
    }
    if (sum == 0) return std::nullopt;
    return cell_ * (Vec2(static_cast<double>(x), static_cast<double>(y)) / static_cast<double>(sum) + 0.5);
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

void PlaneInk::copy_row(std::int64_t i, std::int64_t j, std::span<float> to) const {
    for (std::size_t x = 0; x < to.size();) {
        std::size_t cell = 0;
        const Tile* t = tile(i + static_cast<std::int64_t>(x), j, cell);
        const std::size_t n = std::min(kTile - cell % kTile, to.size() - x);
        for (std::size_t k = 0; k < n; ++k) to[x + k] = t ? t->coverage[cell + k] / 255.0f : 0;
        x += n;
    }
}

PlaneDrawing::PlaneDrawing(const brush::Preset& preset, const HolderOptions& hold, double step, double cell)
    : hold_(hold), step_(step), tuft_(brush::make_tuft(preset)), ink_(cell) {
    fresh_.bend = tuft_;
    kept_ = fresh_;
}

std::vector<brush::Pose> PlaneDrawing::poses_of(const StrokeSamples& trace) const {
    std::vector<brush::Pose> samples;
    const StrokeSamples led =
        lift_off(compensate_tip_lag(lean_holder(add_turn_samples(trace, hold_), hold_), hold_), hold_);
    const std::vector<double> depths = tip_depths<StrokeSample>(led.samples, hold_);
    for (std::size_t i = 0; i < led.samples.size(); ++i) {
        const StrokeSample& s = led.samples[i];
        samples.push_back(pose_holder({s.position.x, -s.position.y, 0}, 0,
                                      {.depth = depths[i], .tilt = s.tilt, .roll = s.roll, .time = s.time}, hold_));
    }
    return resample(samples, {.step = step_, .lever = tuft_.preset.length});
}

void PlaneDrawing::begin(const State& from) {
    ink_ = PlaneInk(ink_.cell());
    static_cast<brush::TuftBend&>(tuft_) = from.bend;
    before_ = from.before;
    root_ = from.root, missed_ = from.missed;
}

void PlaneDrawing::draw_on(const std::vector<brush::Pose>& poses, State from, double until) {
    begin(from);
    last_ = std::move(from);
    for (; last_.poses < poses.size() && poses[last_.poses].time <= until; ++last_.poses) {
        const brush::Pose& pose = poses[last_.poses];
        add_stamp(pose, last_.poses == 0 ? 0 : pose.time - last_.time);
        last_.time = pose.time;
    }
    last_.bend = tuft_;
    last_.before = before_, last_.root = root_, last_.missed = missed_;
}

const PlaneInk& PlaneDrawing::draw(const StrokeSamples& trace) {
    draw_on(poses_of(trace), fresh_, std::numeric_limits<double>::infinity());
    return ink_;
}

const PlaneInk& PlaneDrawing::keep(const StrokeSamples& trace, double time) {
    draw_on(poses_of(trace), fresh_, time);
    kept_ = last_;
    return ink_;
}

const PlaneInk& PlaneDrawing::draw_part(const StrokeSamples& trace, double until) {
    draw_on(poses_of(trace), kept_, until);
    return ink_;
}

const PlaneInk& PlaneDrawing::draw_rest(const StrokeSamples& trace) {
    draw_on(poses_of(trace), last_, std::numeric_limits<double>::infinity());
    return ink_;
}

void PlaneDrawing::add_stamp(const brush::Pose& pose, double dt) {
    const Frame plane_frame;
    const brush::ContactPlane plane;
    const double cell = ink_.cell();
    const brush::TuftState state = brush::step(tuft_, pose, {&plane, 1}, dt);
    if (!state.touching) {
        if (++missed_ > kMostMissed) before_.clear();
        return;
    }
    missed_ = 0;
    if (tuft_.carried) {
        ink_.add(
            footprint::rasterise_polygons(
                footprint::shape_polygons(tuft_, state.shape, plane_frame, {.film = kSkinFilm}), plane_frame, 0, cell),
            std::max(0.0, pose.time));
        return;
    }
    Recycled<footprint::Trail> trails = footprint::find_trails(state, plane_frame, {}, tuft_.preset.length, kSkinFilm);
    footprint::cover_upright_hair(trails, brush::upright_hair_of(tuft_, plane), plane_frame, kSkinFilm);
    footprint::fill_rows(trails);
    Recycled<footprint::Trail> leapt;
    if (!before_.empty())
        leapt = footprint::leapt_trails(trails, plane_frame, before_, plane_frame, Vec2(pose.position - root_));
    const Recycled<footprint::Outline> outlines =
        footprint::outlines_of(trails, footprint::OutlineOptions{}.points, leapt);
    ink_.add(footprint::rasterise(outlines, plane_frame, 0, cell), std::max(0.0, pose.time));
    if (!tuft_.wide()) return;
    before_ = std::move(trails);
    root_ = pose.position;
}

PlaneInk plane_ink(const StrokeSamples& trace, const brush::Preset& preset, const HolderOptions& options, double step,
                   double cell) {
    return PlaneDrawing(preset, options, step, cell).draw(trace);
}

Vec2 middle_of_dot(const StrokeSamples& dot, const brush::Preset& preset, HolderOptions options) {
    constexpr double kSteps = 60, kCells = 20;  // to the tuft's length; to its radius
    options.dot_place = nullptr;
    const std::optional<Vec2> ink =
        plane_ink(dot, preset, options, preset.length / kSteps, preset.radius / kCells).centre();
    if (!ink) return Vec2{0};
    Vec2 sum{0};
    double pressed = 0;
    for (const StrokeSample& s : dot.samples) sum += s.pressure * Vec2(s.position), pressed += s.pressure;
    return Vec2{ink->x, -ink->y} - (pressed > 0 ? sum / pressed : Vec2(dot.samples.front().position));
}

}  // namespace tuft::stroke
