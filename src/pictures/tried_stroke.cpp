#include "pictures/tried_stroke.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/calibration/sweep.h"
#include "core/ease.h"
#include "core/text/units.h"
#include "ink/spectra/srgb.h"
#include "stroke/document/document.h"
#include "stroke/placement/placement.h"
#include "stroke/surface/flat_sheet.h"

namespace tuft::pictures {
namespace {

constexpr int kWidth = TriedStroke::kWidth, kHeight = TriedStroke::kHeight;
constexpr std::uint32_t kTexels = 512;  // per side of the sheet's atlas
constexpr int kColumn = 96, kRow = 64;  // of the atlas: lower left texel of the picture
constexpr int kMargin = 16;             // texels of the sheet beyond the picture, for hair that reaches out
constexpr double kOfWidth = 1.9, kOfLength = 0.6, kOfFoam = 1.3, kOfCutHair = 3.2;
constexpr double kShownPressure = 0.8;            // at which the line's width is taken
constexpr double kHalfLength = 1.5;               // heights of the sheet, of the stroke
constexpr double kWave = 0.17, kBroadWave = 0.1;  // heights
constexpr double kSpeed = 0.08;                   // metres a second
constexpr int kSamples = 160;

/// Goes from 0 at `a` to 1 at `b` without a kink.
double rise(double a, double b, double at) {
    return smooth_step((at - a) / (b - a));
}

/// A flat sheet whose texels are `texel` metres; the middle of the picture is its origin, x to the right, y up.
stroke::Model make_sheet(double texel) {
    const Vec2 picture(kWidth, kHeight), high = texel * (0.5 * picture + double(kMargin));
    return stroke::make_flat_sheet({.frame = {},
                                    .low = -high,
                                    .high = high,
                                    .texels = kTexels,
                                    .texel = texel,
                                    .corner = -texel * (Vec2(kColumn, kRow) + 0.5 * picture)});
}

stroke::JournalEntry entry_of(const brush::Preset& preset, std::vector<stroke::StrokeSample> samples) {
    stroke::PaintStroke stroke{.trace = {}, .brush = preset.name, .ink = "carbon", .seed = 1};
    stroke.trace.placement = {.origin = Vec3(0), .right = {1, 0, 0}, .down = {0, -1, 0}};
    stroke.trace.samples = std::move(samples);
    return stroke::JournalEntry(std::move(stroke));
}

/// Pressed, travelled in a wave with a swell, lifted; a broad side is turned by a quarter and back.
std::vector<stroke::StrokeSample> wave(const brush::Preset& preset, double height) {
    const bool broad = brush::has_broad_side(preset), knife = preset.slant > 0;
    const double seconds = std::max(1.0, 2 * kHalfLength * height / kSpeed);
    std::vector<stroke::StrokeSample> samples;
    for (int i = 0; i <= kSamples; ++i) {
        const double s = double(i) / kSamples;
        const double along = s - 0.03 * std::sin(2 * std::numbers::pi * s);  // slower at both ends
        const double swell = 0.30 + 0.55 * std::pow(std::cos(1.35 * std::numbers::pi * (s - 0.07)), 2);
        // Hair follows a turn within its contact length.
        const double turned = rise(0.24, 0.36, s) - rise(0.68, 0.8, s), across = knife ? turned : 1 - turned;
        const double pressure = (broad ? 0.6 - 0.35 * turned : swell) * rise(0, 0.05, s) * (1 - rise(0.82, 1, s));
        samples.push_back(
            {.time = seconds * s,
             .position = {height * kHalfLength * (2 * along - 1),
                          -height * (broad ? kBroadWave : kWave) * std::sin(2.3 * std::numbers::pi * along), 0},
             .pressure = std::max(pressure, 0.0),
             .roll = broad ? (100 * across - 10) * kDegree : 0});
    }
    return samples;
}

/// Whether a brush makes dots: foam, and hair that is cut flat.
bool makes_dots(const brush::Preset& preset) {
    return brush::is_foam(preset) || (preset.spines > 1 && !brush::has_broad_side(preset));
}

/// Pressed and lifted in one place.
std::vector<stroke::StrokeSample> dot_stroke(double x, double pressure, double roll) {
    std::vector<stroke::StrokeSample> samples;
    for (int i = 0; i <= 20; ++i) {
        const double s = i / 20.0;
        samples.push_back({.time = 0.4 * s,
                           .position = {x, 0, 0},
                           .pressure = pressure * rise(0, 0.4, s) * (1 - rise(0.7, 1, s)),
                           .roll = roll});
    }
    return samples;
}

TriedStroke picture_of(const stroke::Document& painting) {
    TriedStroke out;
    const ink::Substrate& paper = painting.appearance().substrate();
    const auto code = [](float linear) {
        return static_cast<std::uint8_t>(std::lround(255 * std::clamp(ink::srgb_encode(linear), 0.0f, 1.0f)));
    };
    out.rgb.resize(std::size_t{3} * kWidth * kHeight);
    for (std::size_t i = 0; i < out.rgb.size(); ++i) out.rgb[i] = code(paper.reflectance[i % 3]);
    const ink::Canvas& canvas = painting.layers().canvas();
    const atlas::TexelMap& map = painting.model().texels;
    for (const std::uint32_t slot : canvas.touched_slots()) {
        const ink::TileAppearance appearance = ink::shade_tile(canvas, slot, paper);
        for (std::uint32_t t = 0; t < atlas::kTileTexels; ++t) {
            const atlas::TexelPlace at = atlas::texel_place(map, slot, t);
            const int x = static_cast<int>(at.x) - kColumn, y = kHeight - 1 - (static_cast<int>(at.y) - kRow);
            if (x < 0 || y < 0 || x >= kWidth || y >= kHeight) continue;
            for (std::size_t c = 0; c < 3; ++c)
                out.rgb[3 * static_cast<std::size_t>(y * kWidth + x) + c] = code(appearance.colour[c][t]);
        }
    }
    return out;
}

}  // namespace

double tried_height(const brush::Preset& preset) {
    double width = 0;
    if (makes_dots(preset)) {
        width = 2 * preset.radius * (brush::is_foam(preset) ? kOfFoam : kOfCutHair) / kOfWidth;
    } else if (brush::has_broad_side(preset)) {
        width = preset.width + 2 * preset.length * std::sin(preset.splay);
    } else {
        const double depth = kShownPressure * stroke::working_depth(preset);
        width = brush::sweep_depth(preset, std::span(&depth, 1)).front().width;
    }
    return std::max(kOfWidth * width, kOfLength * preset.length);
}

TriedStroke paint_tried_stroke(const brush::Preset& preset, const ProgressFn& progress, const DiskCache& tip_lags) {
    const double height = tried_height(preset);
    const stroke::Model sheet = make_sheet(height / kHeight);
    stroke::Document painting(sheet, {.substrate = "rice-paper", .tip_lags = tip_lags});
    painting.use(preset);
    if (makes_dots(preset)) {
        for (int k = -1; k <= 1; ++k)
            painting.paint(entry_of(preset, dot_stroke(1.15 * k * height, 0.5 - 0.3 * k, 25 * k * kDegree)), progress);
    } else {
        painting.paint(entry_of(preset, wave(preset, height)), progress);
    }
    return picture_of(painting);
}

}  // namespace tuft::pictures
