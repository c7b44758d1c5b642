#include "brush/calibration/sweep.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>

#include "brush/tuft/tuft.h"
#include "core/error.h"
#include "paths.h"

namespace tuft::brush {
namespace {

/// Rows of a file of that text.
std::vector<SweepRow> read_back(const std::string& text) {
    const std::string path = testing::TempDir() + "/tuft_sweep_" + std::to_string(getpid()) + ".csv";
    std::ofstream(path) << text;
    try {
        std::vector<SweepRow> rows = read_sweep(path);
        std::filesystem::remove(path);
        return rows;
    } catch (...) {
        std::filesystem::remove(path);
        throw;
    }
}

TEST(Sweep, ABrushOfAnotherSizeDrawsTheSameLineInThatSize) {
    for (const char* name : {"wolf-medium", "mixed-medium", "goat-medium"}) {
        const Preset p = load_preset(name);
        for (const double factor : {0.25, 0.5, 2.0}) {
            const Preset q = scaled(p, factor);
            for (const double part : {0.15, 0.3, 0.45}) {
                const double depth = part * p.length, other = factor * depth;
                const double width = sweep_depth(p, std::span(&depth, 1)).front().width;
                const double of_other = sweep_depth(q, std::span(&other, 1)).front().width;
                // Similar, but for the force that flattens, which has a limit in newtons, and the damping in seconds:
                // within the thickness of a hair.
                EXPECT_NEAR(of_other, factor * width, 1.1e-4 * std::max(1.0, factor))
                    << name << " x " << factor << " at " << part;
            }
        }
    }
}

TEST(Sweep, LinesWidenEvenlyWithDepth) {
    for (const char* name : {"wolf-medium", "mixed-small", "goat-large"}) {
        const Preset p = load_preset(name);
        std::vector<double> depths;
        for (int i = 0; i <= 20; ++i) depths.push_back(0.022 * i * p.length);
        const std::vector<SweepRow> rows = sweep_depth(p, depths);
        EXPECT_LT(rows[0].width, 2.1 * p.tip_radius) << name << ": a touch draws the ends of the hair";
        for (std::size_t i = 1; i < rows.size(); ++i) {
            EXPECT_GE(rows[i].width, rows[i - 1].width) << name << " " << i;
            // No wiggles: a step never exceeds three times a mean step.
            EXPECT_LT(rows[i].width - rows[i - 1].width, 3 * rows.back().width / 20) << name << " " << i;
        }
        EXPECT_GT(rows.back().width, 1.5 * p.radius);
    }
}

/// A quarter more than one standard deviation of the measurement itself.
void expect_within_repeatability(const Preset& p, const std::vector<SweepRow>& measured) {
    SweepRow sum;
    for (const SweepRow& row : measured) {
        const SweepRow swept = sweep_depth(p, std::span(&row.depth, 1)).front();
        sum.width += std::pow(swept.width - row.width, 2) / measured.size();
        sum.drag += std::pow(swept.drag - row.drag, 2) / measured.size();
        sum.offset += std::pow(swept.offset - row.offset, 2) / measured.size();
    }
    EXPECT_LT(std::sqrt(sum.width), 1.25 * 1.4e-3);
    EXPECT_LT(std::sqrt(sum.drag), 1.25 * 0.5e-3);
    EXPECT_LT(std::sqrt(sum.offset), 1.25 * 0.7e-3);
}

TEST(Sweep, Robot2020DrawsTheMeasuredLines) {
    const std::string path = test_data() + "/brush/brush_robot2020_even.csv";
    const std::vector<SweepRow> measured = read_sweep(path);
    const Preset p = load_preset("robot-2020");
    EXPECT_NEAR(p.length, stated_length(path).value(), 1e-9);
    expect_within_repeatability(p, measured);
    // Depths between and beyond the table: even growth, steps back below the ruler's 0.5 mm.
    std::vector<double> depths;
    for (int i = 0; i <= 34; ++i) depths.push_back(5e-4 * i);
    const std::vector<SweepRow> rows = sweep_depth(p, depths);
    for (std::size_t i = 1; i < rows.size(); ++i) {
        EXPECT_GE(rows[i].width, rows[i - 1].width - 1e-5) << i;
        EXPECT_GT(rows[i].drag, rows[i - 1].drag - 5e-4) << i;
        EXPECT_NEAR(rows[i].offset, rows[i - 1].offset, i < 3 ? 2.5e-3 : 5e-4) << i;
    }
}

/// A brush with the drop that surface tension holds at its point against the ink's column in it: ρ = 2γ / (ρ g L) of
/// water, 0.072 N/m. The hair of its point is fine: a blunt one draws as wide by itself.
Preset with_drop(const std::string& name) {
    Preset p = load_preset(name);
    p.tip_radius = 9e-5;
    p.tip_drop = 2 * 0.072 / (1000 * 9.81 * p.length);
    return p;
}

TEST(Sweep, ALightPressDrawsAsWideAsMeasuredBrushes) {
    // Two brushes on robots drew 0.85 and 1.8 mm at 1 mm of depth. The width of a line repeats to 1.4 mm over all
    // depths and is read to 0.5 mm, so a light line is known to no better than a quarter.
    const auto width = [](const Preset& p, double depth) { return sweep_at(p, depth).row.width; };
    EXPECT_NEAR(width(load_preset("mixed-medium"), 1e-3), 0.85e-3, 0.25 * 0.85e-3);
    EXPECT_NEAR(width(load_preset("robot-2020"), 1e-3), 1.8e-3, 0.25 * 1.8e-3);
    EXPECT_NEAR(width(with_drop("mixed-medium"), 1e-3), 0.85e-3, 0.25 * 0.85e-3);
}

TEST(Sweep, TheFootOfWidthOverDepthHasNoKnob) {
    // A line that a light press begins is nowhere wider than what follows: else its head would be a ball on a neck. A
    // drawn width repeats to a hundredth of a millimetre.
    for (const char* name : {"goat-small", "goat-medium", "goat-large", "mixed-medium", "wolf-medium", "robot-2020"}) {
        const Preset p = load_preset(name);
        double before = 0;
        for (int i = 0; i <= 12; ++i) {
            const double width = sweep_at(p, p.length * i / 160).row.width;
            EXPECT_GT(width, before - 1e-5) << name << " " << i;
            before = width;
        }
    }
}

TEST(Sweep, ADropAtThePointWidensLightLinesAlone) {
    const auto width = [](const Preset& p, double depth) { return sweep_at(p, depth).row.width; };
    for (const char* name : {"goat-medium", "mixed-medium", "wolf-medium", "robot-2020"}) {
        const Preset p = with_drop(name);
        Preset dry = p;
        dry.tip_drop = 0;
        // A touch draws the hair alone. From 0.2 L on the line is that of the hair, to a hundredth of it.
        EXPECT_NEAR(width(p, 0), width(dry, 0), 1e-9) << name;
        for (const double part : {0.2, 0.3, 0.4}) {
            const double depth = part * p.length;
            EXPECT_NEAR(width(p, depth), width(dry, depth), 0.01 * width(dry, depth)) << name << " " << part;
            // The drop bends no hair.
            EXPECT_EQ(sweep_at(p, depth).spine, sweep_at(dry, depth).spine) << name;
        }
    }
}

TEST(Sweep, ADryPointHasNoDrop) {
    const Preset p = with_drop("mixed-medium");
    Preset without = p;
    without.tip_drop = 0;
    const auto widest = [](const Preset& preset, double wetness) {
        Tuft tuft = make_tuft(preset);
        tuft.wetness = wetness;
        const ContactPlane sheet;
        Pose pose{{0, 0, preset.length}, {1, 0, 0, 0}, 0};
        TuftState state = step(tuft, pose, {&sheet, 1}, 0);
        for (int i = 1; i <= 40; ++i) {
            pose.position += Vec3{5e-4, 0, -2.5e-5};
            pose.time += 0.01;
            state = step(tuft, pose, {&sheet, 1}, 0.01);
        }
        return state.branches.front().sections.front().a;
    };
    EXPECT_EQ(widest(p, 0), widest(without, 0));
    EXPECT_GT(widest(p, 0.5), widest(without, 0.5));
    EXPECT_GT(widest(p, 1), widest(p, 0.5));
}

TEST(Sweep, ChangesEvenlyWithTheBrush) {
    // What a fit steps by: the patch's ends must not jump from section to section (0.15 mm), so
    // each of 20 steps of 0.2 % is like their mean.
    const std::vector<double> depths{0.003, 0.006, 0.009};
    const auto swept = [&](double factor) {
        Preset p = load_preset("mixed-medium");
        p.radius *= factor;
        p.alpha *= factor;
        return sweep_depth(p, depths);
    };
    std::vector<std::vector<SweepRow>> at;
    for (int i = 0; i <= 20; ++i) at.push_back(swept(1 + 2e-3 * i));
    for (std::size_t d = 0; d < depths.size(); ++d) {
        for (double SweepRow::*column : {&SweepRow::width, &SweepRow::drag, &SweepRow::offset}) {
            const double slope = (at.back()[d].*column - at.front()[d].*column) / 20;
            for (std::size_t i = 1; i + 1 < at.size(); ++i) {
                const double step = at[i + 1][d].*column - at[i][d].*column;
                EXPECT_NEAR(step, slope, 0.5 * std::abs(slope) + 4e-6) << d << " " << i;
            }
        }
    }
}

TEST(Sweep, TableReadsBack) {
    const std::vector<SweepRow> rows{{0.002, 0.0015, 0.003, 0.001}, {0.004, 0.0035, 0.005, 0.0012}};
    const std::vector<SweepRow> back = read_back("# a brush\n" + sweep_csv(rows));
    ASSERT_EQ(back.size(), 2u);
    EXPECT_NEAR(back[1].width, 0.0035, 1e-9);
    EXPECT_NEAR(back[0].offset, 0.001, 1e-9);
}

TEST(Sweep, ATableMayHaveAnyOfTheColumns) {
    const std::vector<SweepRow> rows = read_back("z_mm,width_mm\n1,0.9\n2,2\n");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_NEAR(rows[1].width, 2e-3, 1e-12);
    EXPECT_TRUE(std::isnan(rows[1].drag));
    EXPECT_TRUE(std::isnan(rows[1].offset));
}

TEST(Sweep, ExcludedRowsAreSkippedAndMistakesNamed) {
    const std::vector<SweepRow> rows =
        read_back("z_mm,width_mm,drag_mm,offset_mm,excluded_by_authors\n1,1,1,1,0\n2,9,9,9,1\n");
    EXPECT_EQ(rows.size(), 1u);
    const auto error_of = [](const std::string& text) {
        try {
            read_back(text);
        } catch (const Error& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_THAT(error_of("z_mm\n1\n"), testing::HasSubstr("no column 'width_mm'"));
    EXPECT_THAT(error_of("width_mm\n1\n"), testing::HasSubstr("no column 'z_mm'"));
    EXPECT_THAT(error_of("z_mm,width_mm,drag_mm,offset_mm\n1,2,x,4\n"),
                testing::AllOf(testing::HasSubstr(":2:"), testing::HasSubstr("'x'")));
    EXPECT_THAT(error_of("z_mm,width_mm,drag_mm,offset_mm\n1,2\n"), testing::HasSubstr("is not a length"));
    EXPECT_THAT(error_of("z_mm,width_mm,drag_mm,offset_mm\n"), testing::HasSubstr("no measured rows"));
}

}  // namespace
}  // namespace tuft::brush
