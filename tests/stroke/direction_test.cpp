#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>

#include "ink/colour/pigments.h"
#include "sheet.h"

namespace tuft::stroke {
namespace {

/// Film of each texel of a line that a hand draws over a sheet, both turned by `frame`.
std::map<std::uint32_t, double> film_of_line(const Frame& frame, const std::string& brush, double depth) {
    const Model model = sheet(frame, 512);
    Document painting(model, {});
    ink::Substrate ground = ink::load_substrate("porcelain");
    ground.relief = 0;  // its grain lies in space, and would not be turned
    painting.use(ground);
    // One bundle: which hair comes to lie where across the line is decided at the first touch.
    brush::Preset preset = brush::load_preset(brush);
    preset.bundles = 1;
    painting.use(preset);
    painting.paint(line(brush, depth, frame));
    const ink::Canvas& canvas = painting.layers().canvas();
    std::map<std::uint32_t, double> film;
    for (const std::uint32_t slot : canvas.touched_slots()) {
        const ink::Plane* plane = canvas.plane(slot, 0);
        for (std::uint32_t t = 0; plane && t < plane->size(); ++t) film[slot * plane->size() + t] = (*plane)[t];
    }
    return film;
}

Frame turned(double degrees) {
    const double a = degrees * std::numbers::pi / 180;
    return {.origin = Vec3{0}, .t = {std::cos(a), std::sin(a), 0}, .b = {-std::sin(a), std::cos(a), 0}, .n = {0, 0, 1}};
}

TEST(Direction, SheetAndHandTurnedTogetherGiveTheSameInk) {
    // The same texels of the same atlas, turned about the sheet's normal. Vertices are floats, and so is the film:
    // 2e-7. Where a sample just touches or just leaves, one more or less gives ink, 3e-4 of the line.
    for (const auto& [brush, depth] : {std::pair{"wolf-small", 4.3e-3}, std::pair{"mixed-medium", 5.2e-3}}) {
        const auto first = film_of_line({}, brush, depth);
        double mass = 0;
        for (const auto& [texel, film] : first) mass += film;
        ASSERT_GT(mass, 0);
        for (const double degrees : {1, 15, 40, 200}) {
            auto second = film_of_line(turned(degrees), brush, depth);
            double apart = 0;
            for (const auto& [texel, film] : first) apart += std::abs(second[texel] - film);
            EXPECT_LT(apart, 5e-4 * mass) << brush << " " << degrees;
        }
    }
}

}  // namespace
}  // namespace tuft::stroke
