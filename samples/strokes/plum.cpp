#include <cmath>
#include <numbers>
#include <utility>

#include "compositions.h"
#include "core/text/units.h"
#include "hand.h"

// A plum branch in blossom beside a rock, and bamboo, on the vase's belly: eight pigments.
namespace tuft::samples {

namespace {

using stroke::BrushAction;
using stroke::Dry;
using stroke::Preparation;

constexpr double kPi = std::numbers::pi;

const BrushAction kTip(const char* ink, double depth) {
    return BrushAction{.what = stroke::Dip{.depth = depth}, .ink = ink};
}
const BrushAction kWipeTip(double depth) {
    return BrushAction{.what = stroke::Wipe{.depth = depth, .amount = 0.95}};
}
const BrushAction kFlank(const char* ink, double side) {
    return BrushAction{.what = stroke::Dip{.depth = 1, .side = side}, .ink = ink};
}
const Dry kDry{};
const BrushAction kWipe(double amount) {
    return BrushAction{.what = stroke::Wipe{.amount = amount}};
}

struct Branch : Series {
    /// A stroke along (x, y) places that swells from 0 to `width` at `swell` of its length and runs out.
    static Stroke leaf(const char* name, const Vec2& from, double turn, double length, double width, double bend) {
        const Vec2 u{std::cos(turn), std::sin(turn)}, v{-u.y, u.x};
        const auto at = [&](double f, double w, double pace = 1) {
            const Vec2 p = from + f * length * u + bend * length * f * f * v;
            return Key{p.x, p.y, w, pace};
        };
        return {name, {at(0, 0), at(0.12, 0.45 * width), at(0.42, width), at(0.75, 0.55 * width), at(1, 0, 1.4)}};
    }

    /// One press: the tuft leans away from the heart, so that its tip, in the deeper red, points
    /// to it and its belly goes down outside and prints the round of the petal.
    struct Petal {
        double from = 0, to = 0;  ///< millimetres from the heart
        double width = 0;         ///< millimetres
        double red_tip = 0;       ///< fraction of the tuft's length
        bool wait = false;        ///< until the ink before is dry
    };
    void petal(const Vec2& heart, const Vec2& u, const Petal& petal) {
        const auto& [from, to, width, red_tip, wait] = petal;
        const auto at = [&](double f, double w, double pace) {
            const Vec2 p = heart + f * u;
            return Key{p.x, p.y, w, pace};
        };
        std::vector<Preparation> preparations{kWipeTip(red_tip), kTip("cinnabar", red_tip)};
        if (wait) preparations.insert(preparations.begin(), kDry);
        add({"petal",
             {at(from, 0, 0.5), at(from + 0.35 * (to - from), 0.5 * width, 0.5), at(to, width, 0.5),
              at(to - 0.2, 0.4 * width, 0.6), at(to - 1.3, 0, 1)}},
            "mixed-medium", "samples/inks/blossom-pink.toml", 0.03, preparations, 20 * kDegree * glm::normalize(u));
    }
    void blossom(const Vec2& heart, double size, double turn, double flat) {
        for (int k = 0; k < 5; ++k) {
            const double a = turn + 2 * kPi * k / 5 + 0.07 * std::sin(3.0 * k + turn);
            petal(heart, {std::cos(a), flat * std::sin(a)},
                  {0.24 * size, 0.74 * size, (1.0 + 0.06 * std::cos(2.0 * k + turn)) * size, 0.07});
        }
    }
    void stamens(const Vec2& heart, double size, double turn, double flat) {
        for (int k = 0; k < 7; ++k) {
            const double a = turn + 2 * kPi * (k + 0.3 * std::sin(5.0 * k)) / 7,
                         r = size * (0.5 + 0.1 * std::cos(3.0 * k));
            const Vec2 end = heart + r * Vec2{std::cos(a), flat * std::sin(a)};
            const Vec2 begin = heart + 0.12 * size * Vec2{std::cos(a), flat * std::sin(a)};
            const std::vector<Preparation> preparations =
                k ? std::vector<Preparation>{} : std::vector<Preparation>{kDry};
            add({"filament",
                 {{begin.x, begin.y, 0},
                  {0.5 * (begin.x + end.x), 0.5 * (begin.y + end.y), 0.35},
                  {end.x, end.y, 0.15}}},
                "wolf-small*0.6", "cinnabar", 0.05, preparations);
            add({"anther", {{end.x, end.y, 0}, {end.x + 0.15, end.y + 0.05, 0.9, 0.5}, {end.x + 0.25, end.y, 0}}},
                "wolf-small*0.6", "gamboge", 0.02);
        }
    }
    /// Two petals still closed, and the calyx that holds them.
    void bud(const Vec2& at, double size, double turn, bool wait) {
        const Vec2 u{std::cos(turn), std::sin(turn)};
        petal(at, {std::cos(turn - 0.3), std::sin(turn - 0.3)}, {0.1 * size, 0.5 * size, 0.85 * size, 0.1, wait});
        petal(at, {std::cos(turn + 0.35), std::sin(turn + 0.35)}, {0.05 * size, 0.4 * size, 0.75 * size, 0.1});
        add(leaf("calyx", at - 0.35 * size * u, turn + 0.1, 0.55 * size, 0.28 * size, 0.1), "wolf-small", "carbon",
            0.04);
    }
};

}  // namespace

std::vector<stroke::RecordedStroke> vase_plum() {
    Branch p{{{{0, -66.7 * kMillimetre, 118 * kMillimetre}, {1, 0, 0}, {0, 0, -1}, stroke::SurfaceMapping::wrap}}};
    // Two boulders: a thin wash, axe-cut strokes with the side of a half-dry tuft, and their edges.
    const double washes[][4] = {
        {-43, 33, -46, 50}, {-38, 29, -41, 52}, {-33, 31, -35, 53}, {-14.5, 47, -16, 54}, {-12, 44, -13, 53}};
    for (const auto& c : washes) {
        const double x = 0.5 * (c[0] + c[2]), y = 0.5 * (c[1] + c[3]);
        p.add({"rock",
               {{c[2], c[3], 0, 0.6},
                {0.5 * (c[2] + x), 0.5 * (c[3] + y), 6, 0.9},
                {x, y, 6.5, 1},
                {c[0], c[1], 0, 1.2}}},
              "mixed-medium", "samples/inks/cobalt-wash.toml", 0.08);
    }
    p.add({"ground", {{-47, 53, 0, 0.7}, {-40, 54, 4, 0.9}, {-28, 54.5, 5, 1}, {-14, 54, 4.5, 1}, {-2, 55.5, 0, 1.2}}},
          "mixed-medium", "samples/inks/cobalt-wash.toml", 0.08);
    const double cuts[][3] = {{-38, 35, 9},   {-34.5, 36, 9}, {-31.5, 38, 8}, {-37, 43, 8},     {-33.5, 45, 8},
                              {-30.5, 46, 7}, {-46, 42, 8},   {-13, 48, 6},   {-10.5, 49.5, 5}, {-18, 50, 5}};
    for (const auto& c : cuts)
        p.add({"axe cut",
               {{c[0], c[1], 0, 0.6},
                {c[0] + 0.3, c[1] + 1.4, 3.4, 0.7},
                {c[0] - 0.02 * c[2], c[1] + 0.5 * c[2], 3, 1},
                {c[0] - 0.2 * c[2], c[1] + c[2], 0, 1.4}}},
              "wolf-large", "cobalt", 0.2, {kDry, kWipe(0.3), kFlank("bone-black", 0.4), kWipe(0.7)}, {0.3, 0.2});
    const std::vector<Key> edges[] = {
        {{-50, 57, 0.8, 1},
         {-50, 47, 2, 1},
         {-45, 36, 1.4, 0.7, 0.04},
         {-39, 31, 2.4, 0.8, 0.04},
         {-31, 33, 1.6, 0.8, 0.04},
         {-27, 41, 2.6, 1},
         {-25, 50, 1.4, 1},
         {-24, 57, 0.6, 1.2}},
        {{-39, 32, 0.8, 0.8}, {-40, 38, 1.8, 0.8, 0.03}, {-37, 43, 1.3, 1}, {-38, 50, 0.4, 1.2}},
        {{-22, 57, 0.8, 1},
         {-20, 50, 1.8, 0.8, 0.04},
         {-15, 44.5, 2.2, 0.8, 0.04},
         {-10, 46, 1.6, 0.8, 0.04},
         {-6, 51, 2.2, 1},
         {-6, 57, 0.6, 1.2}},
        {{-15, 45, 0.8, 0.8}, {-15.5, 49, 1.6, 0.8, 0.03}, {-13.5, 51, 1, 1}, {-14, 55, 0.4, 1.2}}};
    for (const auto& keys : edges) p.add({"rock's edge", keys}, "wolf-medium", "bone-black", 0.09, {kWipe(0.45)});
    // The trunk and its branches: iron red with bone black in one flank, faster where they are thin.
    p.add({"trunk",
           {{36, -38, 0, 1.4},
            {24, -28, 3, 1.2},
            {14, -12, 4.5, 1, 0.04},
            {0, -2, 6, 0.9},
            {-8, 12, 7, 0.8, 0.05},
            {-20, 22, 8.5, 0.7},
            {-26, 40, 8, 0.7},
            {-27, 52, 4, 0.9}}},
          "mixed-large", "iron-red", 0.12, {kDry, kWipe(0.4), kFlank("bone-black", 0.5), kWipe(0.62)});
    p.add({"branch",
           {{-11, 20, 0, 0.7}, {-15, 13, 4, 0.9}, {-20, -4, 3, 1, 0.04}, {-30, -16, 2.4, 1.2}, {-33, -30, 0, 1.4}}},
          "mixed-medium", "iron-red", 0.09, {kFlank("bone-black", 0.4), kWipe(0.3)});
    p.add({"branch", {{2, -3, 0}, {10, -3, 3.4, 0.9}, {22, 2, 2.6, 1.1, 0.04}, {36, -2, 0, 1.4}}}, "mixed-medium",
          "iron-red", 0.09, {kFlank("bone-black", 0.4), kWipe(0.3)});
    const double twigs[][6] = {
        {-20, -4, -12, -14, -9, -27}, {14, -12, 10, -24, 14, -38}, {22, 2, 30, 9, 40, 12}, {24, -28, 32, -27, 42, -24}};
    for (const auto& t : twigs)
        p.add({"twig", {{t[0], t[1], 0}, {t[2], t[3], 1.3, 1}, {t[4], t[5], 0, 1.4}}}, "wolf-medium", "carbon", 0.1,
              {kWipe(0.3)});
    // Moss on the trunk.
    for (int k = 0; k < 9; ++k) {
        const double x = -27 + 3.8 * k, y = 33 - 3.3 * k + 2.5 * std::sin(2.0 * k);
        p.add({"moss", {{x - 1, y - 4, 0}, {x + 0.6, y - 3.2, 1.6, 0.6}, {x + 2.2, y - 2.4, 0}}}, "wolf-medium",
              "carbon", 0.02);
    }
    // Bamboo behind the rock: indigo with gamboge in the tip.
    const double leaves[][4] = {{5, 31, 0.75, 20},  {4, 32, 1.35, 19}, {6, 30, 0.2, 22},   {19, 35, 0.9, 17},
                                {20, 34, 0.35, 20}, {3, 32, 1.9, 15},  {20, 33, -0.15, 17}};
    for (const auto& l : leaves)
        p.add(Branch::leaf("bamboo", {l[0], l[1]}, l[2], l[3], 4.2, 0.06), "mixed-medium", "indigo", 0.07,
              {kWipe(0.6), kTip("gamboge", 0.16)});
    p.add({"stem", {{-4, 52, 1.2}, {-2, 46, 1.3}, {1, 36, 1.1, 1, 0.05}, {6, 30, 0}}}, "wolf-medium", "indigo", 0.07);
    p.add({"stem", {{6, 52, 1.1}, {9, 46, 1.2}, {14, 40, 0.9}, {20, 34, 0}}}, "wolf-medium", "indigo", 0.07);
    // Blossoms on what is dry, the open ones last.
    bool first = true;
    const double buds[][4] = {{-33, -30, 5, -1.5}, {36, -38, 5, -0.9},  {14, -38, 4.5, -1.4},
                              {40, 12, 4.5, 0.4},  {42, -24, 4.5, 0.2}, {-9, -27, 4.2, -1.2}};
    for (const auto& b : buds) p.bud({b[0], b[1]}, b[2], b[3], std::exchange(first, false));
    const double blossoms[][5] = {{-20, -12, 8.5, 0.4, 0.92},
                                  {8, -8, 9.5, 1.1, 1},
                                  {25, -20, 8.5, 0.2, 0.9},
                                  {27, 3, 8, 0.7, 0.75},
                                  {-9, 8, 7.5, 1.4, 0.85}};
    for (const auto& b : blossoms) p.blossom({b[0], b[1]}, b[2], b[3], b[4]);
    for (const auto& b : blossoms) p.stamens({b[0], b[1]}, b[2], b[3] + 0.3, b[4]);
    // The seal.
    const double seal[][4] = {{36, 33, 44, 33},     {36, 41, 44, 41},     {36, 33, 36, 41},     {44, 33, 44, 41},
                              {37.5, 35, 42.5, 35}, {37.5, 37, 42.5, 37}, {37.5, 39, 42.5, 39}, {40, 35, 40, 39}};
    for (const auto& l : seal)
        p.add({"seal", {{l[0], l[1], 0.5}, {0.5 * (l[0] + l[2]), 0.5 * (l[1] + l[3]), 0.8}, {l[2], l[3], 0.5}}},
              "wolf-small", "cinnabar", 0.03);
    return std::move(p.out);
}

}  // namespace tuft::samples
