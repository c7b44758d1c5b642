#include "decal/print.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/system/parallel.h"

namespace tuft::decal {
namespace {

constexpr double kMostPixels = 268435456;  // 2²⁸
constexpr int kMostSamples = 4;            // along a side of a pixel
constexpr std::size_t kMostPlates = 16;
constexpr double kMostSamplePoints = 4e6;

PrintImage blank_over(const Region& on_page, double pixel) {
    const Box2 box = box_of(on_page);
    const double columns = std::ceil(box.size().x / pixel) + 1, rows = std::ceil(box.size().y / pixel) + 1;
    if (!(columns * rows <= kMostPixels))
        throw Error(Message("a piece of film would have {} million pixels; choose fewer dots per inch",
                            static_cast<long>(columns * rows / 1e6)));
    PrintImage image;
    image.width = static_cast<int>(columns);
    image.height = static_cast<int>(rows);
    image.pixel = pixel;
    // On the page's own grid of pixels.
    image.origin = pixel * glm::floor(box.lo / pixel);
    return image;
}

/// Number of the triangle under each pixel's centre inside the region; kNone elsewhere. The panel's own win.
std::vector<std::uint32_t> triangles_under(const PrintSurface& surface, const PagePlacement& placement,
                                           const Region& on_page, const PrintImage& image) {
    const auto width = static_cast<std::size_t>(image.width);
    std::vector<std::uint32_t> under(width * static_cast<std::size_t>(image.height), kNone);
    const auto row_y = [&](int row) { return image.origin.y + image.pixel * (image.height - 1 - row + 0.5); };
    const auto draw = [&](std::size_t t) {
        std::array<Vec2, 3> p;
        for (std::size_t k = 0; k < 3; ++k) p[k] = placement(surface.flat[surface.faces[t][k]]);
        const double lo = std::min({p[0].y, p[1].y, p[2].y}), hi = std::max({p[0].y, p[1].y, p[2].y});
        const auto row_of = [&](double y) { return image.height - 0.5 - (y - image.origin.y) / image.pixel; };
        const int first = std::max(0, static_cast<int>(std::floor(row_of(hi))));
        const int last = std::min(image.height - 1, static_cast<int>(std::ceil(row_of(lo))));
        for (int row = first; row <= last; ++row) {
            const double y = row_y(row);
            double from = std::numeric_limits<double>::infinity(), to = -from;
            for (std::size_t k = 0; k < 3; ++k) {
                const Vec2 &a = p[k], &b = p[(k + 1) % 3];
                if ((a.y <= y) == (b.y <= y)) continue;
                const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
                from = std::min(from, x), to = std::max(to, x);
            }
            const double left = std::max(0.0, std::ceil((from - image.origin.x) / image.pixel - 0.5));
            for (double x = left; x < (to - image.origin.x) / image.pixel - 0.5 && x < image.width; ++x)
                under[static_cast<std::size_t>(row) * width + static_cast<std::size_t>(x)] =
                    static_cast<std::uint32_t>(t);
        }
    };
    for (std::size_t t = surface.n_own; t < surface.faces.size(); ++t) draw(t);
    for (std::size_t t = 0; t < surface.n_own; ++t) draw(t);
    parallel_for(static_cast<std::size_t>(image.height), 16, [&](std::size_t begin, std::size_t end) {
        std::vector<std::pair<double, int>> crossings;
        for (std::size_t row = begin; row < end; ++row) {
            crossings.clear();
            const double y = row_y(static_cast<int>(row));
            for (const Ring& ring : on_page)
                for (std::size_t i = 0; i < ring.size(); ++i) {
                    const Vec2 &a = ring[i], &b = ring[(i + 1) % ring.size()];
                    if ((a.y <= y) == (b.y <= y)) continue;
                    crossings.emplace_back(a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x), b.y > a.y ? -1 : 1);
                }
            std::sort(crossings.begin(), crossings.end());
            std::size_t next = 0;
            int winding = 0;
            for (std::size_t x = 0; x < width; ++x) {
                const double centre = image.origin.x + image.pixel * (static_cast<double>(x) + 0.5);
                for (; next < crossings.size() && crossings[next].first <= centre; ++next)
                    winding += crossings[next].second;
                if (winding <= 0) under[row * width + x] = kNone;
            }
        }
    });
    return under;
}

/// The map from the page to the weights in a triangle of the model.
struct PixelWeights {
    Vec2 corner{0}, x{0}, y{0};
    double det = 1;
    const std::array<Weights, 3>* weights = nullptr;

    PixelWeights(const PrintSurface& surface, const PagePlacement& placement, std::uint32_t t)
        : weights(&surface.weights[t]) {
        corner = placement(surface.flat[surface.faces[t][0]]);
        x = placement(surface.flat[surface.faces[t][1]]) - corner;
        y = placement(surface.flat[surface.faces[t][2]]) - corner;
        det = x.x * y.y - x.y * y.x;
    }
    Weights at(const Vec2& p) const {
        const Vec2 d = p - corner;
        const double b = (d.x * y.y - d.y * y.x) / det, c = (x.x * d.y - x.y * d.x) / det;
        Weights w;
        for (std::size_t k = 0; k < 3; ++k)
            w[k] = (1 - b - c) * (*weights)[0][k] + b * (*weights)[1][k] + c * (*weights)[2][k];
        return w;
    }
};

/// Clears what is printed outside the film and does not hang together with what is printed inside; `inside` is kNone
/// outside.
void drop_islands(PrintImage& image, const std::vector<std::uint32_t>& inside) {
    const int width = image.width, height = image.height;
    std::vector<std::uint8_t> kept(image.alpha.size(), 0);
    std::vector<std::size_t> stack;
    for (std::size_t i = 0; i < kept.size(); ++i)
        if (image.alpha[i] > 0 && inside[i] != kNone) kept[i] = 1, stack.push_back(i);
    while (!stack.empty()) {
        const int x = static_cast<int>(stack.back() % static_cast<std::size_t>(width));
        const int y = static_cast<int>(stack.back() / static_cast<std::size_t>(width));
        stack.pop_back();
        for (int v = std::max(0, y - 1); v <= std::min(height - 1, y + 1); ++v)
            for (int u = std::max(0, x - 1); u <= std::min(width - 1, x + 1); ++u) {
                const auto i =
                    static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u);
                if (kept[i] || image.alpha[i] == 0) continue;
                kept[i] = 1;
                stack.push_back(i);
            }
    }
    for (std::size_t i = 0; i < kept.size(); ++i) {
        if (kept[i] || image.alpha[i] == 0) continue;
        image.alpha[i] = 0;
        for (std::size_t c = 0; c < 3; ++c) image.rgb[3 * i + c] = 255;
        for (std::vector<std::uint8_t>& plate : image.plates) plate[i] = 0;
    }
}

std::uint8_t byte_of(double part) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(part, 0.0, 1.0)));
}

}  // namespace

Region placed(const Region& region, const PagePlacement& placement) {
    Region out = region;
    for (Ring& ring : out)
        for (Vec2& p : ring) p = placement(p);
    return out;
}

void spread_colours(ink::AtlasMap<std::uint8_t>& colour, const ink::AtlasMap<float>& coverage, int rings) {
    const std::size_t n = colour.size;
    std::vector<std::uint8_t> known(n * n), now;
    for (std::size_t i = 0; i < known.size(); ++i) known[i] = coverage.texels[i] >= 0.5f;
    for (int ring = 0; ring < rings; ++ring) {
        now = known;
        parallel_for(n, 16, [&](std::size_t begin, std::size_t end) {
            for (std::size_t y = begin; y < end; ++y)
                for (std::size_t x = 0; x < n; ++x) {
                    if (known[y * n + x]) continue;
                    std::array<unsigned, 3> sum{};
                    unsigned count = 0;
                    for (std::size_t v = y > 0 ? y - 1 : 0; v <= y + 1 && v < n; ++v)
                        for (std::size_t u = x > 0 ? x - 1 : 0; u <= x + 1 && u < n; ++u) {
                            if (!known[v * n + u]) continue;
                            ++count;
                            for (std::size_t c = 0; c < 3; ++c) sum[c] += colour.texels[3 * (v * n + u) + c];
                        }
                    if (count == 0) continue;
                    now[y * n + x] = 1;
                    for (std::size_t c = 0; c < 3; ++c)
                        colour.texels[3 * (y * n + x) + c] = static_cast<std::uint8_t>((sum[c] + count / 2) / count);
                }
        });
        known.swap(now);
    }
}

PrintImage print_piece(const PrintSurface& surface, const PrintSource& source, const PagePlacement& placement,
                       const Region& film, double bleed, double pixel) {
    const Region on_page = placed(offset(film, bleed), placement);
    PrintImage image = blank_over(on_page, pixel);
    const std::vector<std::uint32_t> under = triangles_under(surface, placement, on_page, image);
    const std::size_t n_plates = source.amounts ? std::min(source.full.size(), kMostPlates) : 0;
    image.rgb.assign(3 * under.size(), 255);
    image.alpha.assign(under.size(), 0);
    image.plates.assign(n_plates, std::vector<std::uint8_t>(under.size(), 0));
    const int fine = std::clamp(static_cast<int>(std::lround(pixel / source.texel)), 1, kMostSamples);
    const auto width = static_cast<std::size_t>(image.width);
    parallel_for(under.size(), 4096, [&](std::size_t begin, std::size_t end) {
        std::array<float, kMostPlates> amounts{};
        for (std::size_t i = begin; i < end; ++i) {
            if (under[i] == kNone) continue;
            const PixelWeights weights(surface, placement, under[i]);
            const Vec2 corner =
                image.origin + pixel * Vec2(static_cast<double>(i % width),
                                            static_cast<double>(image.height - 1) - static_cast<double>(i / width));
            double cover = 0;
            std::array<double, 3> colour{};
            std::array<double, kMostPlates> tint{};
            for (int k = 0; k < fine * fine; ++k) {
                const Vec2 p = corner + pixel / fine * Vec2(k % fine + 0.5, k / fine + 0.5);
                const PrintedPoint at =
                    printed_at(surface, source.coverage, under[i], placement.inverse(p), weights.at(p));
                const double c = at.coverage;
                if (!(c > 0)) continue;
                const Vec2 uv = uv_of(source.corner_uvs, at.triangle, at.weights);
                cover += c;
                std::array<float, 3> rgb;
                sample(*source.colour, uv, rgb.data());
                for (std::size_t m = 0; m < 3; ++m) colour[m] += c * rgb[m];
                if (n_plates == 0) continue;
                sample(*source.amounts, uv, amounts.data());
                for (std::size_t m = 0; m < n_plates; ++m) tint[m] += amounts[m] / source.full[m];
            }
            if (!(cover > 0)) continue;
            image.alpha[i] = byte_of(cover / (fine * fine));
            for (std::size_t m = 0; m < 3; ++m) image.rgb[3 * i + m] = byte_of(colour[m] / cover / 255);
            for (std::size_t m = 0; m < n_plates; ++m) image.plates[m][i] = byte_of(tint[m] / (fine * fine));
        }
    });
    drop_islands(image, triangles_under(surface, placement, placed(film, placement), image));
    return image;
}

PaintSamples sample_paint(const PrintSurface& surface, const PrintSource& source, const Region& film) {
    PaintSamples samples;
    const Vec2 size = box_of(film).size();
    PrintImage grid = blank_over(film, std::max(source.texel, std::sqrt(size.x * size.y / kMostSamplePoints)));
    const std::vector<std::uint32_t> under = triangles_under(surface, {}, film, grid);
    const std::size_t n_plates = std::min(source.full.size(), kMostPlates);
    const auto width = static_cast<std::size_t>(grid.width);
    std::array<float, kMostPlates> amounts{};
    samples.area = grid.pixel * grid.pixel;
    for (std::size_t i = 0; i < under.size(); ++i) {
        if (under[i] == kNone) continue;
        const Vec2 p = grid.origin +
                       grid.pixel * Vec2(static_cast<double>(i % width) + 0.5,
                                         static_cast<double>(grid.height - 1) - static_cast<double>(i / width) + 0.5);
        const PrintedPoint at =
            printed_at(surface, source.coverage, under[i], p, PixelWeights(surface, {}, under[i]).at(p));
        if (!(at.coverage > 0)) continue;
        const Vec2 uv = uv_of(source.corner_uvs, at.triangle, at.weights);
        std::array<float, 3> rgb;
        sample(*source.colour, uv, rgb.data());
        sample(*source.amounts, uv, amounts.data());
        samples.cover.push_back(static_cast<float>(at.coverage));
        samples.colour.push_back({rgb[0] / 255, rgb[1] / 255, rgb[2] / 255});
        samples.amounts.insert(samples.amounts.end(), amounts.begin(),
                               amounts.begin() + static_cast<std::ptrdiff_t>(n_plates));
    }
    return samples;
}

PrintImage print_strain(const PrintSurface& surface, const PagePlacement& placement, const Region& printed,
                        double pixel, double limit) {
    const Region on_page = placed(printed, placement);
    PrintImage image = blank_over(on_page, pixel);
    const std::vector<std::uint32_t> under = triangles_under(surface, placement, on_page, image);
    image.rgb.assign(3 * under.size(), 255);
    image.alpha.assign(under.size(), 0);
    for (std::size_t i = 0; i < under.size(); ++i) {
        if (under[i] == kNone) continue;
        const std::array<std::uint8_t, 3> colour = strain_colour(surface.strain[under[i]], limit);
        std::copy(colour.begin(), colour.end(), image.rgb.begin() + static_cast<std::ptrdiff_t>(3 * i));
        image.alpha[i] = 255;
    }
    return image;
}

std::array<std::uint8_t, 3> strain_colour(double strain, double limit) {
    constexpr std::array<std::array<double, 3>, 4> kColours{
        {{255, 255, 255}, {255, 225, 90}, {240, 130, 30}, {190, 20, 30}}};
    if (!(strain <= limit)) return {120, 20, 150};
    const double at = 3 * strain / limit;
    const auto i = std::min<std::size_t>(static_cast<std::size_t>(at), 2);
    std::array<std::uint8_t, 3> colour;
    for (std::size_t c = 0; c < 3; ++c)
        colour[c] = static_cast<std::uint8_t>(
            std::lround(kColours[i][c] + (at - static_cast<double>(i)) * (kColours[i + 1][c] - kColours[i][c])));
    return colour;
}

}  // namespace tuft::decal
