#include "decal/ink_areas.h"

#include <algorithm>
#include <cmath>

#include "decal/paint_field.h"
#include "decal/smooth_ring.h"

namespace tuft::decal {
namespace {

constexpr double kCellsPerTexel = 2;
constexpr double kMostCells = 16e6;
constexpr double kStraight = 1e-6;   // metres: points nearer than this to the line without them are left out
constexpr double kSpeck = 0.25;      // texels
constexpr double kOneInk = 0.02;     // mean difference of the parts
constexpr double kThickFilm = 0.25;  // of the thickest

Grid grid_over(const Box2& box, double texel) {
    const Vec2 size = box.size();
    Grid grid;
    grid.cell = std::max(texel / kCellsPerTexel, std::sqrt(size.x * size.y / kMostCells));
    grid.width = static_cast<int>(std::ceil(size.x / grid.cell)) + 4;
    grid.height = static_cast<int>(std::ceil(size.y / grid.cell)) + 4;
    grid.origin = box.lo - grid.cell * Vec2(1.382, 1.236);  // no edge of a regular mesh lies along a row
    return grid;
}

/// Film units of each pigment on a pixel; returns their sum.
double amounts_at(const PrintImage& image, std::span<const float> full, std::size_t i, std::vector<double>& amounts) {
    double sum = 0;
    for (std::size_t m = 0; m < amounts.size(); ++m) sum += amounts[m] = image.plates[m][i] / 255.0 * full[m];
    return sum;
}

double difference(std::span<const double> a, std::span<const double> b) {
    double sum = 0;
    for (std::size_t m = 0; m < a.size(); ++m) sum += std::abs(a[m] - b[m]);
    return 0.5 * sum;
}

}  // namespace

Region find_ink_area(const PrintSurface& surface, const CoverageFn& coverage, const Region& film, double bleed,
                     double texel) {
    const Region allowed = offset(film, bleed);
    if (allowed.empty()) return {};
    const Grid grid = grid_over(box_of(allowed), texel);
    const PaintField field = find_paint(surface, coverage, grid, texel);
    if (!field.any) return {};
    Region painted = zero_lines(grid, field.painted);
    std::erase_if(painted, [&](const Ring& ring) { return std::abs(area_of(ring)) < kSpeck * texel * texel; });
    for (Ring& ring : painted) ring = smooth_ring(ring, texel);
    Region out;
    for (const Region& part : separate(simplify(intersect(painted, allowed), kStraight)))
        if (contains(film, part[0][0]) || !intersect(part, film).empty())
            out.insert(out.end(), part.begin(), part.end());
    return out;
}

std::optional<PrintedInk> find_single_ink(const PrintImage& image, std::span<const float> full) {
    PrintedInk ink;
    ink.mix.assign(image.plates.size(), 0);
    std::vector<double> amounts(image.plates.size());
    double thickest = 0;
    for (std::size_t i = 0; i < image.alpha.size(); ++i)
        thickest = std::max(thickest, amounts_at(image, full, i, amounts));
    if (!(thickest > 0)) return std::nullopt;
    const double thick = kThickFilm * thickest;
    double weights = 0, differences = 0;
    for (std::size_t i = 0; i < image.alpha.size(); ++i) {
        const double sum = amounts_at(image, full, i, amounts);
        if (sum > 0) {
            const double weight = std::min(sum, thick);
            for (std::size_t m = 0; m < amounts.size(); ++m) ink.mix[m] += weight * amounts[m] / sum;
            weights += weight;
        }
        const double cover = image.alpha[i] / 255.0;
        for (std::size_t c = 0; c < 3; ++c) ink.colour[c] += cover * image.rgb[3 * i + c] / 255.0;
        ink.weight += cover;
    }
    if (!(ink.weight > 0)) return std::nullopt;
    for (double& part : ink.mix) part /= weights;
    for (double& c : ink.colour) c /= ink.weight;
    for (std::size_t i = 0; i < image.alpha.size(); ++i) {
        const double sum = amounts_at(image, full, i, amounts);
        if (!(sum > 0)) continue;
        for (double& a : amounts) a /= sum;
        differences += std::min(sum, thick) * difference(amounts, ink.mix);
    }
    if (differences > kOneInk * weights) return std::nullopt;
    return ink;
}

bool is_same_mix(std::span<const double> a, std::span<const double> b) {
    return a.size() == b.size() && difference(a, b) <= kOneInk;
}

}  // namespace tuft::decal
