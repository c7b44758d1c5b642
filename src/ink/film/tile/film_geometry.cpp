#include <algorithm>
#include <cmath>

#include "ink/film/tile/fibres.h"
#include "ink/film/tile/film_tile.h"

namespace tuft::ink::wet {
namespace {

constexpr int kWide = kSide + 4;          // two texels round the tile: metrics of the border need both sides
constexpr double kMostConductance = 4;    // over the smaller of the two areas
constexpr double kNoShear = 0.05;         // of √g g^12: less is left out; a blot gets 2.5 % longer or wider
constexpr double kLeastDiagonal = 0.02;   // beside seams: less is left out, as it costs as much as more
constexpr double kFlowAreaAtSeams = 0.4;  // of the area
constexpr double kLeastInBlock = 0.5;     // of the mean area
constexpr double kGrainDepth = 0.4;       // of the mean

struct Spot {
    bool valid = false;
    Vec3 position{0};
    double area = 0, reach = 0;
    std::uint8_t free = 255;
    double grain = 1, ease = 1;        // of the pin; of the flow, its root
    double m11 = 1, m12 = 0, m22 = 1;  // √g times the inverse metric
    bool border = false;               // beside a seam: its faces to other such texels are the seam's
    std::array<double, 4> faces{};     // of a border, by `SeamFace::Direction`
};

struct Neighbourhood {
    std::array<Spot, kWide * kWide> spots;

    Spot& at(int column, int row) { return spots[(row + 2) * kWide + column + 2]; }
    const Spot& at(int column, int row) const { return spots[(row + 2) * kWide + column + 2]; }
};

bool together(const Spot& a, const Spot& b, double stretch = 1) {
    return a.valid && b.valid && glm::distance(a.position, b.position) <= stretch * std::max(a.reach, b.reach);
}

/// Derivative of the position along the atlas at `s`, from the neighbours that hang together with it.
Vec3 derivative(const Spot& before, const Spot& s, const Spot& after) {
    const bool back = together(before, s), on = together(s, after);
    if (back && on) return 0.5 * (after.position - before.position);
    if (on) return after.position - s.position;
    if (back) return s.position - before.position;
    return Vec3{0};
}

void set_metric(Neighbourhood& n, int column, int row) {
    Spot& s = n.at(column, row);
    if (!s.valid) return;
    const Vec3 x = derivative(n.at(column - 1, row), s, n.at(column + 1, row));
    const Vec3 y = derivative(n.at(column, row - 1), s, n.at(column, row + 1));
    const double g11 = glm::dot(x, x), g12 = glm::dot(x, y), g22 = glm::dot(y, y);
    const double root = std::sqrt(std::max(0.0, g11 * g22 - g12 * g12));
    if (!(root > 1e-3 * (g11 + g22))) return;  // alone or folded: as if undistorted
    s.m11 = g22 / root;
    s.m12 = -g12 / root;
    s.m22 = g11 / root;
}

/// The mixed term at the corner above and right of a texel; 0 where the square is broken.
double shear(const Neighbourhood& n, int column, int row) {
    const Spot &a = n.at(column, row), &b = n.at(column + 1, row), &c = n.at(column, row + 1),
               &d = n.at(column + 1, row + 1);
    if (!together(a, d, 1.5) || !together(b, c, 1.5) || !together(a, b)) return 0;
    const double m = 0.25 * ((a.m12 + d.m12) + (b.m12 + c.m12));
    return std::abs(m) < kNoShear ? 0 : m;
}

/// The diagonal at the corner above and right of a texel: > 0 from it to the next, < 0 the other one.
double diagonal(const Neighbourhood& n, int column, int row) {
    const Spot &a = n.at(column, row), &b = n.at(column + 1, row), &c = n.at(column, row + 1),
               &d = n.at(column + 1, row + 1);
    const bool broken = !(a.valid && b.valid && c.valid && d.valid);
    if (!broken && !(a.border && b.border && c.border && d.border)) return shear(n, column, row);
    const double up = a.faces[atlas::SeamFace::above_right], down = b.faces[atlas::SeamFace::above_left];
    return std::max(up, down) < kLeastDiagonal ? 0 : up > down ? up : -down;
}

/// Of a tile that lies off by (x, y).
void take_borders(Neighbourhood& n, const atlas::SeamLinks& seams, std::uint32_t slot, int x, int y) {
    const auto spot = [&](int texel, int dx, int dy) -> Spot* {
        const int column = x + texel % kSide + dx, row = y + texel / kSide + dy;
        return column < -2 || row < -2 || column > kSide + 1 || row > kSide + 1 ? nullptr : &n.at(column, row);
    };
    constexpr std::array<std::array<int, 2>, 4> kSteps{{{1, 0}, {0, 1}, {1, 1}, {-1, 1}}};
    for (std::uint32_t i = seams.start[slot]; i < seams.start[slot + 1]; ++i)
        if (Spot* s = spot(seams.links[i].texel, 0, 0)) s->border = true;
    for (std::uint32_t i = seams.face_start[slot]; i < seams.face_start[slot + 1]; ++i) {
        const atlas::SeamFace& f = seams.faces[i];
        if (Spot* s = spot(f.texel, 0, 0)) s->border = true, s->faces[f.direction] = static_cast<double>(f.conductance);
        if (Spot* s = spot(f.texel, kSteps[f.direction][0], kSteps[f.direction][1])) s->border = true;
    }
}

Neighbourhood collect_texels(const atlas::TexelMap& map, const atlas::SeamLinks& seams, std::uint32_t slot,
                             const FlowMedium& medium) {
    Neighbourhood n;
    const auto [x0, y0] = atlas::texel_place(map, slot, 0);
    for (int row = -2; row < kSide + 2; ++row)
        for (int column = -2; column < kSide + 2; ++column) {
            const atlas::TexelRef ref = atlas::texel_ref(map, x0 + column, y0 + row);
            if (!ref.valid()) continue;
            const float area = map.tiles[ref.slot].area[ref.texel];
            n.at(column, row) = {.valid = area > 0,
                                 .position = Vec3(map.position(ref.slot, ref.texel)),
                                 .area = static_cast<double>(area),
                                 .reach = static_cast<double>(map.reach[ref.slot]),
                                 .free = medium.free ? medium.free(ref.slot, ref.texel) : std::uint8_t{255}};
        }
    EaseOfFlow ease(medium, map.texel_size);
    for (int row = -1; row < kSide + 1; ++row)
        for (int column = -1; column < kSide + 1; ++column) {
            set_metric(n, column, row);
            Spot& s = n.at(column, row);
            if (!s.valid) continue;
            s.grain = 1 + kGrainDepth * place_noise(s.position, kGrainLength);
            if (!(medium.unevenness > 0)) continue;
            const atlas::TexelRef ref = atlas::texel_ref(map, x0 + column, y0 + row);
            s.ease = ease.root_at(s.position, Vec3(map.normal(ref.slot, ref.texel)));
        }
    const auto tiles = static_cast<std::int64_t>(map.tiles_per_side);
    for (std::int64_t y = std::max<std::int64_t>(y0 / kSide - 1, 0); y < std::min(y0 / kSide + 2, tiles); ++y)
        for (std::int64_t x = std::max<std::int64_t>(x0 / kSide - 1, 0); x < std::min(x0 / kSide + 2, tiles); ++x)
            if (const std::uint32_t near = map.slot_of_tile[static_cast<std::size_t>(y * tiles + x)]; near != kNone)
                take_borders(n, seams, near, static_cast<int>(x * kSide - x0), static_cast<int>(y * kSide - y0));
    return n;
}

/// One side of a straight face: m11 or m22 of its texel, and the shear.
struct FaceSide {
    const Spot& spot;
    double m = 0, shear = 0;
};

double straight(const FaceSide& side_a, const FaceSide& side_b, atlas::SeamFace::Direction direction) {
    const Spot &a = side_a.spot, &b = side_b.spot;
    // Never quite closed: slopes are taken from one to the other all the same.
    if (a.border && b.border) return std::max(a.faces[direction], static_cast<double>(kConductanceUnit));
    return 0.5 * (side_a.m + side_b.m) - 0.5 * (std::abs(side_a.shear) + std::abs(side_b.shear));
}

double conductance(double g, const Spot& a, const Spot& b, double mean_area) {
    return std::clamp(g * (a.ease * b.ease) * passing(a.free, b.free), 0.0,
                      kMostConductance * std::min(a.area, b.area) / mean_area);
}

std::uint16_t packed(double g) {
    return static_cast<std::uint16_t>(std::min(std::round(g / static_cast<double>(kConductanceUnit)), 65535.0));
}

/// Whether a block of 4 × 4 texels is all of one cluster, away from seams and stencil edge.
bool whole(const Neighbourhood& n, int block, double least_area) {
    for (int i = 0; i < kBlock * kBlock; ++i) {
        const Spot& s = n.at(block % kBlocks * kBlock + i % kBlock, block / kBlocks * kBlock + i / kBlock);
        if (!s.valid || s.border || s.free < 255 || s.area < least_area) return false;
    }
    return true;
}

/// Σ conductances of a texel.
float sum_at(const Geometry& g, int t) {
    const int column = t % kSide, row = t / kSide;
    const int straight =
        g.gx[Geometry::right_of(column, row)] + g.gx[Geometry::right_of(column - 1, row)] + g.gy[t] + g.gy[t + kSide];
    float sum = static_cast<float>(straight) * kConductanceUnit;
    if (!g.gd) return sum;
    const auto& d = *g.gd;
    const auto diagonal = [](int size) { return static_cast<float>(std::max(size, 0)) * kDiagonalUnit; };
    for (const int back : {0, 1}) sum += diagonal(d[Geometry::corner_of(column - back, row - back)]);
    for (const int back : {0, 1}) sum += diagonal(-d[Geometry::corner_of(column - 1 + back, row - back)]);
    return sum;
}

}  // namespace

double passing(std::uint8_t free_a, std::uint8_t free_b) {
    if (free_a == 0 || free_b == 0) return free_a == free_b;
    // A sliver along a hard edge would suck ink in through a crack and dry to a dark speck.
    constexpr int kSliver = 64;
    const int low = std::min(free_a, free_b), high = std::max(free_a, free_b);
    return low < kSliver && high - low > kSliver ? 0 : low / 255.0;
}

Geometry make_geometry(const atlas::TexelMap& map, const atlas::SeamLinks& seams, std::uint32_t slot,
                       const FlowMedium& medium) {
    const Neighbourhood n = collect_texels(map, seams, slot, medium);
    const double mean = map.texel_size * map.texel_size;
    Geometry g;
    Geometry::Diagonals diagonals{};
    bool any = false;
    for (int row = -1; row < kSide + 1; ++row)
        for (int column = -1; column < kSide + 1; ++column) {
            const Spot& s = n.at(column, row);
            if (!s.valid) continue;
            g.valid[row + 1] |= 1u << (column + 1);
            g.grain[field_at(column, row)] = static_cast<float>(s.grain);
            g.flow_area[static_cast<std::size_t>(field_at(column, row))] = static_cast<std::uint16_t>(std::min(
                (s.border ? kFlowAreaAtSeams : 1) * s.area / (mean * static_cast<double>(kFlowAreaUnit)), 65535.0));
            if (row >= 0 && row < kSide && column >= 0 && column < kSide)
                g.inverse[row * kSide + column] = static_cast<float>(mean / s.area);
        }
    for (int row = -1; row < kSide; ++row)
        for (int column = -1; column < kSide; ++column) {
            const Spot& s = n.at(column, row);
            if (const Spot& right = n.at(column + 1, row); row >= 0 && together(s, right))
                g.gx[Geometry::right_of(column, row)] =
                    packed(conductance(straight({s, s.m11, shear(n, column, row)},
                                                {right, right.m11, shear(n, column, row - 1)}, atlas::SeamFace::right),
                                       s, right, mean));
            if (const Spot& up = n.at(column, row + 1); column >= 0 && together(s, up))
                g.gy[(row + 1) * kSide + column] =
                    packed(conductance(straight({s, s.m22, shear(n, column, row)},
                                                {up, up.m22, shear(n, column - 1, row)}, atlas::SeamFace::above),
                                       s, up, mean));
            const double m = diagonal(n, column, row);
            const double size = m > 0 ? conductance(m, s, n.at(column + 1, row + 1), mean)
                                      : conductance(-m, n.at(column + 1, row), n.at(column, row + 1), mean);
            const double units = std::min(std::round(size / static_cast<double>(kDiagonalUnit)), 32767.0);
            diagonals[Geometry::corner_of(column, row)] = static_cast<std::int16_t>(m > 0 ? units : -units);
            any |= m != 0;
            g.ups |= m > 0 && units > 0;
            g.downs |= m < 0 && units > 0;
        }
    for (int block = 0; block < kBlocks * kBlocks; ++block)
        g.blocks |= static_cast<std::uint16_t>(whole(n, block, kLeastInBlock * mean) << block);
    if (any) g.gd = std::make_unique<Geometry::Diagonals>(diagonals);
    for (int t = 0; t < kTexels; ++t) g.stiffness = std::max(g.stiffness, g.inverse[t] * sum_at(g, t));
    return g;
}

namespace {

Geometry without_faces(const Geometry& g) {
    Geometry out;
    out.inverse = g.inverse;
    out.valid = g.valid;
    out.stiffness = g.stiffness;
    out.grain = g.grain;
    out.flow_area = g.flow_area;
    out.blocks = g.blocks;
    if (g.gd) out.gd = std::make_unique<Geometry::Diagonals>();
    return out;
}

}  // namespace

std::unique_ptr<SplitGeometry> split(const Geometry& g, const std::array<bool, 9>& in_zone) {
    auto out = std::make_unique<SplitGeometry>(SplitGeometry{without_faces(g), without_faces(g)});
    const auto side = [](int i) { return i < 0 ? 0 : i < kSide ? 1 : 2; };
    const auto within = [&](int column, int row) {
        return in_zone[static_cast<std::size_t>(side(row) * 3 + side(column))];
    };
    const auto deal = [](std::uint16_t conductance, bool both, std::uint16_t& inside, std::uint16_t& outside) {
        inside = both ? conductance : 0;
        outside = both ? std::min<std::uint16_t>(conductance, 1) : conductance;
    };
    for (int row = -1; row < kSide; ++row)
        for (int column = -1; column < kSide; ++column) {
            if (row >= 0) {
                const auto k = static_cast<std::size_t>(Geometry::right_of(column, row));
                deal(g.gx[k], within(column, row) && within(column + 1, row), out->inside.gx[k], out->outside.gx[k]);
            }
            if (column >= 0) {
                const auto k = static_cast<std::size_t>((row + 1) * kSide + column);
                deal(g.gy[k], within(column, row) && within(column, row + 1), out->inside.gy[k], out->outside.gy[k]);
            }
            if (!g.gd) continue;
            const auto k = static_cast<std::size_t>(Geometry::corner_of(column, row));
            const std::int16_t d = (*g.gd)[k];
            const bool both = d > 0 ? within(column, row) && within(column + 1, row + 1)
                                    : within(column + 1, row) && within(column, row + 1);
            Geometry& to = both ? out->inside : out->outside;
            (*to.gd)[k] = d;
            to.ups |= d > 0;
            to.downs |= d < 0;
        }
    return out;
}

}  // namespace tuft::ink::wet
