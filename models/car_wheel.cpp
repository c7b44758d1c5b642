#include <algorithm>
#include <cmath>
#include <numbers>

#include "cage.h"
#include "car_parts.h"
#include "turned.h"

namespace tuft::models {

namespace {

constexpr double kDegrees = std::numbers::pi / 180;
constexpr double kTyreRadius = 348;

/// Wheels are made lying down, axle up, outer face at z = 0 and below; mm.
Shape make_tyre() {
    Outline o{{238, -20}};  // inside the rim's lip, which is turned with the tyre
    add_curve(o, {239, -8}, {243, 1}, {251, 2}, 3);
    add_curve(o, {256, 3}, {258, -1}, {258, -8}, 2);
    const Vec2 outside[] = {{275, 0}, {302, 2}, {327, -6}};
    add_spline(o, outside, {0.9, 0.6}, {0.75, -0.75}, 6);
    add_curve(o, {337, -15}, {344, -24}, {346.4, -38}, 3);
    add_curve(o, {kTyreRadius + 0.4, -80}, {kTyreRadius + 0.4, -165}, {346.4, -207}, 3);
    add_curve(o, {344, -221}, {337, -230}, {327, -239}, 2);
    add_line(o, {275, -245});
    add_line(o, {242, -228});
    add_line(o, {238, -120});
    std::reverse(o.begin(), o.end());  // so that the rubber lies to the left of the pen
    return turn_ring(o, 72);
}

/// The disc of a rim with five pairs of spokes. The columns of its polar cage stand along the
/// edges of the spokes; the openings between them are carved.
Shape make_rim() {
    constexpr int kLines = 7;  // per pair of spokes
    constexpr int kColumns = 5 * kLines;
    constexpr Vec2 kFace[] = {{30, -24}, {66, -24}, {125, -31}, {180, -29}, {226, -17}, {246, -14}, {244, -205}};
    Cage cage;
    std::vector<std::vector<std::uint32_t>> row;
    for (const Vec2& p : kFace) {
        // The edges of a spoke are parallel: their angles from its middle line grow inwards.
        const double spoke = 14.5;  // degrees from the middle of the pair
        const double half = std::asin(13.0 / std::max(p.x, 90.0)) / kDegrees;
        const double outer = spoke + half, inner = spoke - half;
        const double lines[kLines] = {-outer, -inner, inner, outer, (outer + 36) / 2, 36, 72 - (outer + 36) / 2};
        row.emplace_back();
        const auto angle = [&](int c) {
            const int pair = (c + kLines) / kLines - 1;
            return kDegrees * (lines[c - pair * kLines] + 72 * pair);
        };
        for (int c = 0; c < kColumns; ++c) {
            const double a = angle(c);
            // Subdivision pulls the corners of a polygon inwards.
            const double grown = 6 * p.x / (4 + std::cos(angle(c + 1) - a) + std::cos(a - angle(c - 1)));
            row.back().push_back(cage.add_point({grown * std::cos(a), grown * std::sin(a), p.y}));
        }
    }
    cage.add_face(row.front());
    cage.add_face({row.back().rbegin(), row.back().rend()});
    std::vector<std::vector<std::uint32_t>> face(row.size() - 1);
    for (std::size_t r = 0; r + 1 < row.size(); ++r)
        for (std::size_t c = 0; c < kColumns; ++c) {
            const std::size_t d = (c + 1) % kColumns;
            face[r].push_back(cage.add_face({row[r][c], row[r + 1][c], row[r + 1][d], row[r][d]}));
        }
    for (std::size_t c = 0; c < kColumns; ++c)
        for (const std::size_t r : {0, 6}) cage.crease(row[r][c], row[r][(c + 1) % kColumns], 1);
    for (std::size_t p = 0; p < kColumns; p += kLines) {
        const auto opening = [&](std::initializer_list<std::size_t> columns, std::size_t first_row) {
            std::vector<std::uint32_t> faces;
            for (std::size_t r = first_row; r < 4; ++r)
                for (const std::size_t c : columns) faces.push_back(face[r][p + c]);
            const CarveLoop loops[] = {{3, 8, 1}, {5, 62, 1}};
            carve(cage, faces, {.sharp = 1}, loops);
        };
        opening({1}, 1);
        opening({3, 4, 5, 6}, 1);
    }
    return triangulate(subdivide(cage, 1));
}

}  // namespace

Shape make_car_wheel() {
    Shape wheel = make_tyre();
    append(wheel, make_rim());
    for (Vec3& p : wheel.points) p = {p.x, p.z, -p.y};  // axle along y, outer face to the left
    return wheel;
}

}  // namespace tuft::models
