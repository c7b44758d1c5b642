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
    Outline o{{257, -9}};  // outer bead
    const Vec2 outside[] = {{275, 0}, {302, 2}, {327, -6}};
    add_spline(o, outside, {0.7, 1}, {0.75, -0.75}, 7);
    add_curve(o, {337, -15}, {344, -24}, {346.4, -38}, 3);
    add_curve(o, {kTyreRadius + 0.4, -80}, {kTyreRadius + 0.4, -165}, {346.4, -207}, 4);
    add_curve(o, {344, -221}, {337, -230}, {327, -239}, 2);
    add_line(o, {275, -245});
    add_line(o, {253, -232});
    add_line(o, {253, -24});
    return turn_ring(o, 80);
}

/// A rim with five pairs of spokes. The columns of its polar cage stand along the
/// edges of the spokes; the openings between them are carved.
Shape make_rim() {
    constexpr double kPair[] = {-19, -9.5, 0, 9.5, 19, 27.5, 36, 44.5};  // degrees, of 72
    constexpr int kColumns = 5 * int(std::size(kPair));
    constexpr Vec2 kFace[] = {{34, -24}, {60, -20}, {78, -22}, {125, -29}, {178, -27}, {228, -13},
                              {246, -2}, {255, 2},  {259, -4}, {258, -40}, {250, -215}};
    Cage cage;
    std::vector<std::vector<std::uint32_t>> row;
    for (const Vec2& p : kFace) {
        row.emplace_back();
        for (int c = 0; c < kColumns; ++c) {
            const double a = kDegrees * (kPair[c % 8] + 72 * (c / 8));
            // Spokes widen little: their edges are nearly parallel.
            row.back().push_back(cage.add_point({p.x * std::cos(a), p.x * std::sin(a), p.y}));
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
        for (const std::size_t r : {0, 7, 8, 10})
            cage.crease(row[r][c], row[r][(c + 1) % kColumns], 1);
    for (std::size_t p = 0; p < kColumns; p += 8) {
        const auto opening = [&](std::initializer_list<std::size_t> columns,
                                 std::size_t first_row) {
            std::vector<std::uint32_t> faces;
            for (std::size_t r = first_row; r < 5; ++r)
                for (const std::size_t c : columns) faces.push_back(face[r][p + c]);
            const CarveLoop loops[] = {{5, 8, 1}, {8, 62, 1}};
            carve(cage, faces, {.sharp = 1}, loops);
        };
        opening({1, 2}, 3);
        opening({4, 5, 6, 7}, 2);
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
