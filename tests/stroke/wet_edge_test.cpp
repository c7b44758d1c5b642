#include <gtest/gtest.h>

#include <cmath>

#include "sheet.h"

/// Edge and tone of a wet stroke with still ink.
namespace tuft::stroke {
namespace {

constexpr double kInked = 0.9, kFull = 1.5;  // film units: inside; of a stroke of 1.8 at this pressure

struct Mark {
    double ink = 0;        // film·m²
    double area = 0;       // m² that look covered: f of g(f), see ink::deposit
    double mean = 0;       // film units inside
    double deviation = 0;  // of the film inside over its mean
};

/// The mark between two places of the stroke.
Mark mark_of(const Document& p, double from, double to) {
    Mark mark;
    double sum = 0, square = 0, inside = 0;
    const double extinction = static_cast<double>(ink::extinction_of(ink::load_ink("carbon")));
    const atlas::TexelMap& map = p.model().texels;
    for (const std::uint32_t slot : p.layers().canvas().touched_slots()) {
        const ink::Plane* plane = p.layers().canvas().plane(slot, 0);
        for (int t = 0; plane && t < atlas::kTileTexels; ++t) {
            const auto area = static_cast<double>(map.tiles[slot].area[t]), film = static_cast<double>((*plane)[t]);
            const double x = map.position(slot, t).x;
            if (!(area > 0) || x < from || x > to) continue;
            mark.ink += film * area;
            mark.area += std::min(1.0, std::expm1(-extinction * film) / std::expm1(-extinction * kFull)) * area;
            if (film < kInked) continue;
            inside += area;
            sum += film * area;
            square += film * film * area;
        }
    }
    mark.mean = sum / inside;
    mark.deviation = std::sqrt(std::max(0.0, square / inside - mark.mean * mark.mean)) / mark.mean;
    return mark;
}

Mark paint_line(const Model& model, const std::string& substrate, const std::string& brush = "goat-small") {
    Document painting(model, {.substrate = substrate});
    const StrokeReport report = painting.paint(line(brush, 4e-3));
    double on_sheet = 0;
    for (int p = 0; p < ink::kMaxPigments; ++p) on_sheet += painting.layers().canvas().total(model.texels, p);
    // Texels are of single precision.
    EXPECT_NEAR(on_sheet / report.ink_given, 1, 1e-5) << substrate;
    return mark_of(painting, -6e-3, 6e-3);
}

// The sheet's texels are 0.06 and 0.24 mm: the coarse ones show neither hair nor strands. Two flanks of 12 mm with
// cells of 3 mm leave the mean width of 3.4 mm a standard deviation of 0.8 %; that it has no bias is tested with the
// outlines.
TEST(WetEdge, AtArmsLengthNothingChanges) {
    const Model fine = sheet(), coarse = sheet({}, 256);
    for (const std::string substrate : {"porcelain", "rice-paper"}) {
        const Mark near = paint_line(fine, substrate), far = paint_line(coarse, substrate);
        EXPECT_NEAR(near.area / far.area, 1, 0.02) << substrate;
        EXPECT_NEAR(near.mean / far.mean, 1, 0.01) << substrate;
    }
}

// Strands and loads vary the film by some hundredths on any ground; the grain of others than glaze adds its share to
// that, 0.35 ζ / (ζ + 18 µm). On 12 mm of line lie some 2,000 independent heights; texels of 0.06 mm take the tops off.
TEST(WetEdge, ShowsTheLoadOfItsHairAndTheGrainOfItsSubstrate) {
    const Model model = sheet();
    const Mark porcelain = paint_line(model, "porcelain");
    EXPECT_GT(porcelain.deviation, 0.02);
    EXPECT_LT(porcelain.deviation, 0.12);
    for (const auto& [ground, relief] : {std::pair{"rice-paper", 15.0}, {"bisque", 8.0}, {"clay", 12.0}}) {
        const Mark mark = paint_line(model, ground);
        const double share = 0.35 * relief / (relief + 18), more = mark.deviation * mark.deviation;
        EXPECT_NEAR(std::sqrt(more - porcelain.deviation * porcelain.deviation) / share, 1, 0.15) << ground;
        EXPECT_NEAR(mark.mean / porcelain.mean, 1, 0.02) << ground << ": the grain moves ink, it makes none";
    }
}

}  // namespace
}  // namespace tuft::stroke
