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

std::optional<PrintedInk> find_single_ink(const PaintSamples& samples) {
    const std::size_t n = samples.cover.size();
    if (n == 0) return std::nullopt;
    const std::size_t n_plates = samples.amounts.size() / n;
    const auto film_at = [&](std::size_t i) { return std::span(samples.amounts).subspan(i * n_plates, n_plates); };
    std::vector<double> sums(n);
    for (std::size_t i = 0; i < n; ++i)
        for (const float amount : film_at(i)) sums[i] += amount;
    const double thick = kThickFilm * *std::ranges::max_element(sums);
    if (!(thick > 0)) return std::nullopt;
    PrintedInk ink;
    ink.mix.assign(n_plates, 0);
    double weights = 0, differences = 0, covered = 0;
    for (std::size_t i = 0; i < n; ++i) {
        covered += samples.cover[i];
        for (std::size_t c = 0; c < 3; ++c) ink.colour[c] += samples.cover[i] * samples.colour[i][c];
        if (!(sums[i] > 0)) continue;
        const double weight = std::min(sums[i], thick);
        for (std::size_t m = 0; m < n_plates; ++m) ink.mix[m] += weight * film_at(i)[m] / sums[i];
        weights += weight;
    }
    for (double& part : ink.mix) part /= weights;
    for (double& c : ink.colour) c /= covered;
    ink.weight = covered * samples.area;
    std::vector<double> mix(n_plates);
    for (std::size_t i = 0; i < n; ++i) {
        if (!(sums[i] > 0)) continue;
        for (std::size_t m = 0; m < n_plates; ++m) mix[m] = film_at(i)[m] / sums[i];
        differences += std::min(sums[i], thick) * difference(mix, ink.mix);
    }
    if (differences > kOneInk * weights) return std::nullopt;
    return ink;
}

bool is_same_mix(std::span<const double> a, std::span<const double> b) {
    return a.size() == b.size() && difference(a, b) <= kOneInk;
}

}  // namespace tuft::decal
