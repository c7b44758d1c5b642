#include <cmath>
#include <numbers>

#include "compositions.h"
#include "core/text/units.h"
#include "hand.h"

namespace tuft::samples {

namespace {

using stroke::BrushAction;
using stroke::Dry;
using stroke::Preparation;

/// Pressed down at its outer end, pulled to the middle and lifted there.
Stroke petal(double turn, double from, double length, double width) {
    const Vec2 u{std::sin(turn), -std::cos(turn)}, v{-u.y, u.x};
    const auto at = [&](double f, double side, double w, double rest = -1) {
        const Vec2 p = (from + (1 - f) * length) * u + side * length * v;
        return Key{p.x, p.y, w, 1, rest};
    };
    return {"petal",
            {at(0.22, 0, 0), at(0.14, 0, 0.6 * width), at(0, 0, width, 0.05), at(0.35, 0.04, width),
             at(0.7, 0.03, 0.75 * width), at(1, 0, 0)}};
}

}  // namespace

std::vector<stroke::RecordedStroke> impasto() {
    constexpr const char* kWhite = "titanium-white-paste";
    constexpr const char* kBlue = "samples/inks/blue-paste.toml";
    constexpr const char* kYellow = "samples/inks/yellow-paste.toml";
    constexpr const char* kGreen = "samples/inks/green-paste.toml";
    Series k{{{0, 0, 0}, {1, 0, 0}, {0, -1, 0}, stroke::SurfaceMapping::wrap}};
    // Broad strokes side by side, each into the wet paint of the one before.
    for (int row = 0; row < 5; ++row) {
        const double y = -26 + 12.0 * row, left = row % 2 ? 3.0 : 0.0;
        k.add({"ground",
               {{-46 + left, y + 1, 0},
                {-44 + left, y + 1, 14},
                {-20, y - 2.5, 14},
                {10, y + 1.5, 14},
                {42 + left, y - 1, 14},
                {46 + left, y - 1, 0}}},
              "mixed-large", row < 3 ? kBlue : kGreen, 0.06);
    }
    // A flower on top of it when it is dry.
    for (int p = 0; p < 8; ++p)
        k.add(petal(2 * std::numbers::pi * (p + 0.15) / 8, 5, 20, 10), "mixed-medium", kWhite, 0.04,
              p ? std::vector<Preparation>{} : std::vector<Preparation>{Dry{}});
    for (int d = 0; d < 3; ++d) {
        const double a = 2.1 * d;
        const double x = 2.2 * std::cos(a), y = 2.2 * std::sin(a);
        k.add({"heart", {{x - 1, y + 1, 0}, {x, y, 6}, {x + 1.5, y - 0.5, 6, 1, 0.05}, {x + 0.5, y - 1.5, 0}}},
              "mixed-medium", kYellow, 0.03);
    }
    return std::move(k.out);
}

}  // namespace tuft::samples
