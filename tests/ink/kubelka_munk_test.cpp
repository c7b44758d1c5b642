#include "ink/spectra/kubelka_munk.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "core/error.h"
#include "paths.h"

namespace tuft::ink {
namespace {

std::vector<std::vector<double>> rows_of(const std::string& name) {
    std::ifstream file(test_data() + "/optics/" + name);
    EXPECT_TRUE(file) << name;
    std::vector<std::vector<double>> rows;
    std::string line;
    while (std::getline(file, line)) {
        if (line.empty() || std::isalpha(static_cast<unsigned char>(line[0])) || line[0] == '#') continue;
        std::vector<double> row;
        std::stringstream cells(line);
        std::string cell;
        while (std::getline(cells, cell, ',')) row.push_back(std::stod(cell));
        rows.push_back(row);
    }
    return rows;
}

TEST(KubelkaMunk, MatchesEveryRowOfTheReferenceTable) {
    const auto rows = rows_of("km.csv");
    ASSERT_EQ(rows.size(), 432u);
    for (const auto& row : rows) {
        const double k = row[0], s = row[1], x = row[2], rg = row[3];
        SCOPED_TRACE(::testing::Message() << "K=" << k << " S=" << s << " X=" << x << " Rg=" << rg);
        // The table is good to 2e-12 absolute and has 15 digits.
        const double eps = 3e-12;
        const Layer one = layer(k, s, x);
        EXPECT_NEAR(one.r, row[4], eps);
        EXPECT_NEAR(one.t, row[5], eps);
        EXPECT_NEAR(one.t, row[5], 1e-9 * row[5]);
        EXPECT_NEAR(over(one, rg), row[6], eps);
        EXPECT_NEAR(r_infinity(k, s), row[7], eps);
        const Layer two = stack(layer(row[8], row[9], row[10]), one);
        EXPECT_NEAR(two.r, row[11], eps);
        EXPECT_NEAR(two.t, row[12], eps);
        EXPECT_NEAR(over(two, rg), row[13], eps);
    }
}

TEST(KubelkaMunk, MixturesMatchTheUnicolourVectors) {
    const double k[3][5] = {{1, .5, 1, .5, 1}, {1, 1, .25, .5, .5}, {1, 1, .75, .25, .25}};
    const double s[3][5] = {{.2, .4, .6, .8, 1}, {1, .8, .6, .4, .2}, {.2, .8, .2, .8, .2}};
    const auto rows = rows_of("km_unit_vectors.csv");
    ASSERT_EQ(rows.size(), 18u);
    for (const auto& row : rows) {
        for (int band = 0; band < 5; ++band) {
            const std::vector<Coefficients> parts{
                {k[0][band], s[0][band]}, {k[1][band], s[1][band]}, {k[2][band], s[2][band]}};
            const Coefficients m = mixture(parts, std::span(row).subspan(1, 3));
            double r = r_infinity(m.k, m.s);
            if (row[0] == 1) r = saunderson(r, {.k1 = 0.033, .k2 = 0.66}, false);
            EXPECT_NEAR(r, row[4 + band], 1e-14) << "the vectors have 15 decimals";
        }
    }
}

TEST(KubelkaMunk, EnergyIsConservedAndOnlyAbsorptionTakesIt) {
    for (double k : {0.0, 1e-300, 1e-9, 0.3, 7.0, 1e12})
        for (double s : {0.0, 1e-300, 1e-9, 0.2, 5.0, 1e12})
            for (double x : {0.0, 1e-300, 1e-6, 1.0, 40.0, 1e12}) {
                const Layer l = layer(k, s, x);
                ASSERT_TRUE(std::isfinite(l.r) && std::isfinite(l.t)) << k << " " << s << " " << x;
                EXPECT_GE(l.r, 0);
                EXPECT_GE(l.t, 0);
                EXPECT_LE(l.r + l.t, 1 + 4e-16);
                if (k == 0) {
                    EXPECT_NEAR(l.r + l.t, 1, 4e-16);
                }
                if (k == 0) {
                    EXPECT_NEAR(l.r, s * x / (1 + s * x), 1e-15);
                }
                if (s == 0) {
                    EXPECT_NEAR(l.t, std::exp(-k * x), 1e-15);
                }
                for (double rg : {0.0, 0.5, 1.0}) {
                    const double r = over(l, rg);
                    EXPECT_GE(r, 0);
                    EXPECT_LE(r, 1 + 4e-16);
                }
            }
}

TEST(KubelkaMunk, HugeArgumentsStayFinite) {
    const Layer l = layer(1e100, 1e100, 1e100);
    EXPECT_NEAR(l.r, r_infinity(1, 1), 1e-15);
    EXPECT_EQ(l.t, 0);
}

TEST(KubelkaMunk, ThickFilmsHideTheSubstrate) {
    for (double k : {0.01, 0.7, 9.0})
        for (double s : {0.01, 0.5, 4.0})
            for (double rg : {0.0, 0.4, 0.95}) EXPECT_NEAR(over(layer(k, s, 4000), rg), r_infinity(k, s), 1e-12);
}

TEST(KubelkaMunk, SplittingALayerChangesNothing) {
    for (double k : {0.0, 1e-8, 0.4, 6.0})
        for (double s : {0.0, 1e-8, 0.3, 5.0}) {
            const Layer whole = layer(k, s, 1.7);
            const Layer parts = stack(layer(k, s, 0.6), layer(k, s, 1.1));
            EXPECT_NEAR(parts.r, whole.r, 1e-14);
            EXPECT_NEAR(parts.t, whole.t, 1e-14);
            EXPECT_NEAR(parts.r_back, whole.r, 1e-14);
        }
}

TEST(KubelkaMunk, StackingIsAssociativeAndOneSidedFromBelow) {
    const Layer a = layer(0.3, 0.9, 0.5), b = layer(2, 0.1, 0.4), c = layer(0.05, 1.4, 1.2);
    const Layer left = stack(stack(a, b), c), right = stack(a, stack(b, c));
    EXPECT_NEAR(left.r, right.r, 1e-15);
    EXPECT_NEAR(left.t, right.t, 1e-15);
    EXPECT_NEAR(left.r_back, right.r_back, 1e-15);
    const Layer turned = stack(c, stack(b, a));
    EXPECT_NEAR(turned.r, left.r_back, 1e-15);
    EXPECT_NEAR(turned.t, left.t, 1e-15);
    EXPECT_NEAR(over(left, 0.6), over(a, over(b, over(c, 0.6))), 1e-14) << "layer by layer over the substrate";
}

TEST(KubelkaMunk, TheInverseRecoversAbsorptionAndScattering) {
    for (double k : {0.02, 0.5, 3.0})
        for (double s : {0.05, 0.6, 4.0}) {
            const Layer film = layer(k, s, 1);
            const Coefficients found = from_white_and_black(over(film, 1), over(film, 0));
            // The formula subtracts nearly equal numbers where the film hides all.
            EXPECT_NEAR(found.k, k, 1e-6 * k) << k << " " << s;
            EXPECT_NEAR(found.s, s, 1e-6 * s) << k << " " << s;
        }
    EXPECT_THROW(from_white_and_black(0.3, 0.4), Error);
    EXPECT_THROW(from_white_and_black(1.0, 0.4), Error);
    EXPECT_THROW(from_white_and_black(0.5, 0.0), Error);
}

TEST(Saunderson, InverseUndoesForward) {
    for (bool included : {false, true})
        for (double r = 0; r <= 1; r += 0.125)
            EXPECT_NEAR(saunderson_inverse(saunderson(r, {}, included), {}, included), r, 1e-14);
    EXPECT_NEAR(saunderson(1.0), 1.0, 1e-15) << "a perfect white stays white under glass";
}

}  // namespace
}  // namespace tuft::ink
