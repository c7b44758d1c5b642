#include "writer/copy/photo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/error.h"

namespace tuft::writer {
namespace {

constexpr int kLongest = 1600;  // pixels; a larger picture is reduced
constexpr int kBlocks = 24;     // along the longer side
constexpr int kAround = 3;      // blocks from which the paper is taken at first
constexpr double kPaper = 0.9;  // percentile
constexpr double kSkew = 0.5;   // ink on a fifth of the picture has 1.5
constexpr int kBins = 256;
constexpr double kLeastContrast = 0.15;  // of ink and paper
constexpr double kLeastGrey = 0.06;      // the same as numbers of the picture
constexpr double kMostInk = 0.7;         // of the picture
constexpr double kAlongBorder = 0.1;     // of the border
constexpr double kSpeckOfInk = 1.0 / 400;
constexpr double kSpeck = 1.0 / 3, kHole = 1.0 / 6;  // of the square of a stroke's width
constexpr double kCell = 2;                          // units
constexpr double kDarkest = 0.02;                    // of the paper's light that a photo resolves
constexpr double kMarked = 0.5;                      // density of all channels from which a pixel has a colour
constexpr double kOtherColour = 0.35;                // radians between the densities of two colours; of vermilion 0.54

/// Numbers of pixels, row 0 at the top.
struct Raster {
    int width = 0, height = 0;
    std::vector<float> value;

    Raster(int w, int h, float v = 0) : width(w), height(h), value(std::size_t(w) * h, v) {}
    float& at(int x, int y) { return value[std::size_t(y) * width + x]; }
    float at(int x, int y) const { return value[std::size_t(y) * width + x]; }
    /// Bilinear between centres of pixels; the border goes on.
    double sample(double x, double y) const {
        x = std::clamp(x - 0.5, 0.0, width - 1.0), y = std::clamp(y - 0.5, 0.0, height - 1.0);
        const int i = std::min(static_cast<int>(x), std::max(width - 2, 0)),
                  j = std::min(static_cast<int>(y), std::max(height - 2, 0));
        const int i1 = std::min(i + 1, width - 1), j1 = std::min(j + 1, height - 1);
        return std::lerp(std::lerp(double(at(i, j)), double(at(i1, j)), x - i),
                         std::lerp(double(at(i, j1)), double(at(i1, j1)), x - i), y - j);
    }
};

/// Pixels along the side of the squares whose means are taken.
int reduction_of(const io::Image8& p) {
    return std::max(1, (std::max(p.width, p.height) + kLongest - 1) / kLongest);
}

constexpr Vec3 kLuma{0.2126, 0.7152, 0.0722};  // of Rec. 709

/// Light over white, 0–1, as a mean over squares of pixels where the picture is large. `weights`: of the channels of a
/// picture in colour.
Raster light_of(const io::Image8& p, const Vec3& weights) {
    const int n = reduction_of(p);
    Raster out(p.width / n, p.height / n);
    const auto pixel = [&](int x, int y) {
        const std::uint8_t* c = &p.pixels[(std::size_t(y) * p.width + x) * p.channels];
        const double light = p.channels < 3 ? c[0] : weights.x * c[0] + weights.y * c[1] + weights.z * c[2];
        const double alpha = p.channels == 2 ? c[1] : p.channels == 4 ? c[3] : 255;
        return 1 + alpha / 255 * (light / 255 - 1);
    };
    for (int y = 0; y < out.height; ++y)
        for (int x = 0; x < out.width; ++x) {
            double sum = 0;
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) sum += pixel(n * x + i, n * y + j);
            out.at(x, y) = static_cast<float>(sum / (n * n));
        }
    return out;
}

struct Threshold {
    double at = 0.5, dark = 0, light = 1;  ///< the threshold; means below and above it
    double part = 0;                       ///< of the pixels below it
};

/// Otsu's threshold: the largest variance between the two classes.
Threshold threshold_of(const Raster& r) {
    std::array<double, kBins> count{};
    for (const float v : r.value) ++count[static_cast<std::size_t>(std::clamp(v, 0.0f, 1.0f) * (kBins - 1) + 0.5f)];
    double all = 0, sum = 0;
    for (int i = 0; i < kBins; ++i) all += count[i], sum += i * count[i];
    Threshold best;
    double most = -1, n = 0, below = 0;
    for (int i = 0; i + 1 < kBins; ++i) {
        n += count[i], below += i * count[i];
        if (n == 0 || n == all) continue;
        const double dark = below / n, light = (sum - below) / (all - n),
                     between = n * (all - n) * std::pow(light - dark, 2);
        if (between > most)
            most = between,
            best = {0.5 * (dark + light) / (kBins - 1), dark / (kBins - 1), light / (kBins - 1), n / all};
    }
    return best;
}

int block_size(const Raster& r) {
    return std::max(8, std::max(r.width, r.height) / kBlocks);
}

/// A percentile of the pixels of each block.
Raster blocks_of(const Raster& r, double percentile) {
    const int size = block_size(r);
    Raster out((r.width + size - 1) / size, (r.height + size - 1) / size);
    std::vector<float> values;
    for (int j = 0; j < out.height; ++j)
        for (int i = 0; i < out.width; ++i) {
            values.clear();
            for (int y = j * size; y < std::min((j + 1) * size, r.height); ++y)
                for (int x = i * size; x < std::min((i + 1) * size, r.width); ++x) values.push_back(r.at(x, y));
            const auto nth =
                values.begin() + static_cast<std::ptrdiff_t>(percentile * static_cast<double>(values.size() - 1));
            std::nth_element(values.begin(), nth, values.end());
            out.at(i, j) = *nth;
        }
    return out;
}

/// Light of the paper in blocks.
class Paper {
  public:
    explicit Paper(const Raster& r) : size_(block_size(r)), blocks_(blocks_of(r, kPaper)) {
        const Raster high = blocks_;
        for_blocks([&](int i, int j) {
            for (int b = std::max(0, j - kAround); b <= std::min(blocks_.height - 1, j + kAround); ++b)
                for (int a = std::max(0, i - kAround); a <= std::min(blocks_.width - 1, i + kAround); ++a)
                    blocks_.at(i, j) = std::max(blocks_.at(i, j), high.at(a, b));
        });
    }

    Raster flat(const Raster& r) const {
        Raster out = r;
        for (int y = 0; y < r.height; ++y)
            for (int x = 0; x < r.width; ++x) {
                const double paper = blocks_.sample((x + 0.5) / size_, (y + 0.5) / size_);
                out.at(x, y) = static_cast<float>(r.at(x, y) / std::max(paper, 1e-3));
            }
        return out;
    }

    /// Takes the paper anew as the mean of what is no ink.
    void refine(const Raster& r, const Raster& flat, const Threshold& threshold) {
        const double paper = 0.5 * (threshold.at + threshold.light);  // the soft edge of ink is neither
        std::vector<std::uint8_t> known(blocks_.value.size(), 0);
        for_blocks([&](int i, int j) {
            double sum = 0;
            int n = 0, all = 0;
            for_pixels(r, i, j, [&](int x, int y) {
                ++all;
                if (static_cast<double>(flat.at(x, y)) > paper) sum += static_cast<double>(r.at(x, y)), ++n;
            });
            if (8 * n < all) return;
            blocks_.at(i, j) = static_cast<float>(sum / n), known[std::size_t(j) * blocks_.width + i] = 1;
        });
        for (int pass = 0; pass < kBlocks; ++pass) fill_unknown(known);
    }

  private:
    template <class F>
    void for_blocks(F&& f) {
        for (int j = 0; j < blocks_.height; ++j)
            for (int i = 0; i < blocks_.width; ++i) f(i, j);
    }
    template <class F>
    void for_pixels(const Raster& r, int i, int j, F&& f) const {
        for (int y = j * size_; y < std::min((j + 1) * size_, r.height); ++y)
            for (int x = i * size_; x < std::min((i + 1) * size_, r.width); ++x) f(x, y);
    }
    void fill_unknown(std::vector<std::uint8_t>& known) {
        const std::vector<std::uint8_t> before = known;
        const Raster old = blocks_;
        for_blocks([&](int i, int j) {
            const std::size_t here = std::size_t(j) * blocks_.width + i;
            if (before[here]) return;
            double sum = 0;
            int n = 0;
            for (int b = std::max(0, j - 1); b <= std::min(blocks_.height - 1, j + 1); ++b)
                for (int a = std::max(0, i - 1); a <= std::min(blocks_.width - 1, i + 1); ++a)
                    if (before[std::size_t(b) * blocks_.width + a]) sum += static_cast<double>(old.at(a, b)), ++n;
            if (n > 0) blocks_.at(i, j) = static_cast<float>(sum / n), known[here] = 1;
        });
    }

    int size_;
    Raster blocks_;
};

/// Densities of the inks on a picture in colour, −ln of its light over that of the paper about it. [pixels]
std::vector<Vec3> densities_of(const io::Image8& p) {
    std::vector<Vec3> out;
    for (int c = 0; c < 3; ++c) {
        Vec3 weights{0};
        weights[c] = 1;
        const Raster light = light_of(p, weights), flat = Paper(light).flat(light);
        out.resize(flat.value.size());
        for (std::size_t k = 0; k < out.size(); ++k)
            out[k][c] = -std::log(std::clamp(static_cast<double>(flat.value[k]), kDarkest, 1.0));
    }
    return out;
}

/// The direction of the densities of most ink: for each channel the median, weighed by the density.
Vec3 most_ink(const std::vector<Vec3>& marked) {
    Vec3 out{0};
    double all = 0;
    for (const Vec3& d : marked) all += glm::length(d);
    for (int c = 0; c < 3; ++c) {
        std::array<double, kBins + 1> weight{};
        for (const Vec3& d : marked) weight[static_cast<std::size_t>(d[c] / glm::length(d) * kBins)] += glm::length(d);
        std::size_t bin = 0;
        for (double below = weight[0]; below < 0.5 * all; below += weight[++bin]) {
        }
        out[c] = (static_cast<double>(bin) + 0.5) / kBins;
    }
    return glm::normalize(out);
}

/// The light of a picture in colour without what is of another colour than most of its ink, such as a seal. Densities
/// add where inks lie over each other: d = a ink + b other, a and b at least 0, and the light is that of a alone.
/// Nothing where all is of one colour. `part`: of the marked pixels, those of another colour.
std::optional<Raster> without_other_colours(const io::Image8& p, double& part) {
    if (p.channels < 3) return std::nullopt;
    const std::vector<Vec3> densities = densities_of(p);
    std::vector<Vec3> marked;
    for (const Vec3& d : densities)
        if (glm::length(d) > kMarked) marked.push_back(d);
    if (marked.empty()) return std::nullopt;
    const Vec3 ink = most_ink(marked);
    Vec3 other{0};
    std::size_t n = 0;
    for (const Vec3& d : marked)
        if (glm::dot(d, ink) < std::cos(kOtherColour) * glm::length(d)) other += d, ++n;
    if (static_cast<double>(n) < kSpeckOfInk * static_cast<double>(marked.size())) return std::nullopt;
    other = glm::normalize(other);
    const double both = glm::dot(ink, other);
    if (both > std::cos(kOtherColour)) return std::nullopt;  // several colours about that of the ink
    part = static_cast<double>(n) / static_cast<double>(marked.size());
    const int reduction = reduction_of(p);
    Raster out(p.width / reduction, p.height / reduction);
    for (std::size_t k = 0; k < densities.size(); ++k) {
        const double of_ink = glm::dot(densities[k], ink), of_other = glm::dot(densities[k], other);
        const double a = of_other > both * of_ink ? (of_ink - both * of_other) / (1 - both * both) : of_ink;
        out.value[k] = static_cast<float>(std::exp(-std::max(a, 0.0) * (ink.x + ink.y + ink.z) / 3));
    }
    return out;
}

/// A connected part of cells.
struct Part {
    std::vector<std::size_t> cells;
    std::size_t on_border = 0;
};

/// Parts of the cells with a value; neighbours by edges and, for ink, by corners too.
std::vector<Part> parts_of(const std::vector<std::uint8_t>& mask, int w, int h, std::uint8_t value) {
    std::vector<Part> parts;
    std::vector<std::uint8_t> seen(mask.size(), 0);
    for (std::size_t start = 0; start < mask.size(); ++start) {
        if (seen[start] || mask[start] != value) continue;
        Part part;
        part.cells.push_back(start), seen[start] = 1;
        for (std::size_t k = 0; k < part.cells.size(); ++k) {
            const int x = static_cast<int>(part.cells[k] % std::size_t(w)),
                      y = static_cast<int>(part.cells[k] / std::size_t(w));
            part.on_border += x == 0 || y == 0 || x == w - 1 || y == h - 1;
            for (int b = std::max(0, y - 1); b <= std::min(h - 1, y + 1); ++b)
                for (int a = std::max(0, x - 1); a <= std::min(w - 1, x + 1); ++a) {
                    const std::size_t to = std::size_t(b) * w + a;
                    if (seen[to] || mask[to] != value || (value == 0 && a != x && b != y)) continue;
                    seen[to] = 1, part.cells.push_back(to);
                }
        }
        parts.push_back(std::move(part));
    }
    return parts;
}

/// Width of a stroke of the area: 2 area / length of the edge, which counts 4/π of a slanted line.
double width_of(const Cells& c) {
    std::size_t edges = 0;
    for (int j = 0; j < c.height; ++j)
        for (int i = 0; i < c.width; ++i)
            if (c.at(i, j)) edges += !c.at(i + 1, j) + !c.at(i - 1, j) + !c.at(i, j + 1) + !c.at(i, j - 1);
    if (edges == 0) return 0;
    return 2 * c.cell * static_cast<double>(c.count()) / (static_cast<double>(edges) * std::numbers::pi / 4);
}

void clean(Cells& c) {
    for (int pass = 0; pass < 2; ++pass) {
        const Cells old = c;
        for (int j = 0; j < c.height; ++j)
            for (int i = 0; i < c.width; ++i) {
                int n = 0;
                for (int b = -1; b <= 1; ++b)
                    for (int a = -1; a <= 1; ++a) n += old.at(i + a, j + b);
                c.inside[std::size_t(j) * c.width + i] = n >= 5;
            }
    }
    const double square = std::pow(width_of(c) / c.cell, 2);
    for (const Part& part : parts_of(c.inside, c.width, c.height, 1))
        if (static_cast<double>(part.cells.size()) < kSpeck * square)
            for (const std::size_t k : part.cells) c.inside[k] = 0;
    for (const Part& part : parts_of(c.inside, c.width, c.height, 0))
        if (static_cast<double>(part.cells.size()) < kHole * square && part.on_border == 0)
            for (const std::size_t k : part.cells) c.inside[k] = 1;
}

/// Units of a pixel, by the box of the ink.
double units_of(const Vec2& lo, const Vec2& hi) {
    return kCopiedPart * kSide / std::max(hi.x - lo.x, hi.y - lo.y);
}

/// Cells over the box (pixels) of the ink.
Cells cells_of(const Raster& flat, double threshold, const Vec2& lo, const Vec2& hi) {
    const double units = units_of(lo, hi);
    Cells c{.lo = Vec2(-kCell * 8), .cell = kCell};
    c.width = c.height = static_cast<int>(kSide / kCell) + 16;
    c.inside.assign(std::size_t(c.width) * c.height, 0);
    const int n = std::max(1, static_cast<int>(std::ceil(kCell / units)));
    for (int j = 0; j < c.height; ++j)
        for (int i = 0; i < c.width; ++i) {
            double sum = 0;
            for (int b = 0; b < n; ++b)
                for (int a = 0; a < n; ++a) {
                    const Vec2 p = c.lo + c.cell * Vec2(i + (a + 0.5) / n, j + (b + 0.5) / n) - 0.5 * kSide;
                    const Vec2 at = 0.5 * (lo + hi) + Vec2(p.x, -p.y) / units;
                    const bool in = at.x > lo.x - 1 && at.y > lo.y - 1 && at.x < hi.x + 1 && at.y < hi.y + 1;
                    sum += in ? flat.sample(at.x, at.y) : 1;
                }
            c.inside[std::size_t(j) * c.width + i] = sum / (n * n) < threshold;
        }
    return c;
}

/// Whether the writing is lighter than what it is on: whether deviations from the middle light about a place are skewed
/// to the light.
bool light_on_dark(const Raster& r) {
    const Raster middle = blocks_of(r, 0.5);
    const int size = block_size(r);
    Raster wide = middle;
    for (int j = 0; j < middle.height; ++j)
        for (int i = 0; i < middle.width; ++i) {
            double sum = 0;
            int n = 0;
            for (int b = std::max(0, j - kAround); b <= std::min(middle.height - 1, j + kAround); ++b)
                for (int a = std::max(0, i - kAround); a <= std::min(middle.width - 1, i + kAround); ++a)
                    sum += static_cast<double>(middle.at(a, b)), ++n;
            wide.at(i, j) = static_cast<float>(sum / n);
        }
    double square = 0, cube = 0;
    for (int y = 0; y < r.height; ++y)
        for (int x = 0; x < r.width; ++x) {
            const double d = static_cast<double>(r.at(x, y)) - wide.sample((x + 0.5) / size, (y + 0.5) / size);
            square += d * d, cube += d * d * d;
        }
    const double n = static_cast<double>(r.value.size());
    return cube / n > kSkew * std::pow(square / n, 1.5);
}

/// Takes what is no part of the character out of the picture. Returns the box round the rest, pixels.
std::pair<Vec2, Vec2> keep_character(Raster& flat, double threshold) {
    std::vector<std::uint8_t> mask(flat.value.size());
    for (std::size_t i = 0; i < mask.size(); ++i) mask[i] = static_cast<double>(flat.value[i]) < threshold;
    std::size_t ink = 0;
    const std::vector<Part> parts = parts_of(mask, flat.width, flat.height, 1);
    const double border = kAlongBorder * 2 * (flat.width + flat.height);
    const auto framed = [&](const Part& p) { return static_cast<double>(p.on_border) > border; };
    for (const Part& part : parts) ink += framed(part) ? 0 : part.cells.size();
    Vec2 lo(1e300), hi(-1e300);
    for (const Part& part : parts) {
        const bool keep =
            !framed(part) && static_cast<double>(part.cells.size()) > kSpeckOfInk * static_cast<double>(ink);
        for (const std::size_t k : part.cells) {
            const Vec2 p(static_cast<double>(k % std::size_t(flat.width)),
                         static_cast<double>(k / std::size_t(flat.width)));
            if (keep) lo = glm::min(lo, p), hi = glm::max(hi, p + 1.0);
            if (!keep) flat.value[k] = 1;
        }
    }
    return {lo, hi};
}

}  // namespace

PictureInk picture_ink(const io::Image8& picture, const std::string& source, double shift) {
    if (std::min(picture.width, picture.height) < 16 || picture.channels < 1)
        throw Error(source, Message("the picture is smaller than 16 pixels"));
    Raster grey = light_of(picture, kLuma);
    double other = 0;
    if (light_on_dark(grey))
        for (float& v : grey.value) v = 1 - v;
    else if (std::optional<Raster> one = without_other_colours(picture, other))
        grey = std::move(*one);
    Paper paper(grey);
    Raster flat = paper.flat(grey);
    // Without ink the classes would be light and shade.
    if (const Threshold first = threshold_of(flat); first.light - first.dark > kLeastContrast) {
        paper.refine(grey, flat, first);
        flat = paper.flat(grey);
    }
    const Threshold threshold = threshold_of(flat);
    double mean = 0;
    for (const float v : grey.value) mean += static_cast<double>(v) / static_cast<double>(grey.value.size());
    const double contrast = threshold.light - threshold.dark;
    if (contrast < kLeastContrast || contrast * mean < kLeastGrey || threshold.part > kMostInk)
        throw Error(source, Message("no ink stands out from the paper in this picture"));
    shift = std::clamp(shift, -kMostThreshold, kMostThreshold);
    const double at = std::lerp(threshold.at, shift < 0 ? threshold.dark : threshold.light, std::abs(shift));
    const auto [lo, hi] = keep_character(flat, at);
    if (!(hi.x > lo.x)) throw Error(source, Message("no ink stands out from the paper in this picture"));
    const int n = reduction_of(picture);
    PictureInk out{.cells = cells_of(flat, at, lo, hi),
                   .middle = 0.5 * n * (lo + hi),
                   .units = units_of(lo, hi) / n,
                   .other_colour = other};
    clean(out.cells);
    return out;
}

Cells ink_of(const io::Image8& picture, const std::string& source, double threshold) {
    return picture_ink(picture, source, threshold).cells;
}

}  // namespace tuft::writer
