#pragma once

#include <cmath>
#include <numbers>

#include "test_mesh.h"

/// Plain bodies of some centimetres.
namespace tuft::test {

inline mesh::TriangleMesh sheet() {
    return grid_mesh(40, 30, false, false, [](double u, double v) { return Vec3(0.2 * u, 0.15 * v, 0); });
}

inline mesh::TriangleMesh cylinder() {
    return grid_mesh(96, 40, true, false, [](double u, double v) {
        return Vec3(0.05 * std::cos(2 * std::numbers::pi * u), 0.05 * std::sin(2 * std::numbers::pi * u), 0.2 * v);
    });
}

inline mesh::TriangleMesh cone() {
    return grid_mesh(96, 40, true, false, [](double u, double v) {
        const double r = 0.02 + 0.06 * v;
        return Vec3(r * std::cos(2 * std::numbers::pi * u), r * std::sin(2 * std::numbers::pi * u), 0.1 * v);
    });
}

inline mesh::TriangleMesh torus(int round = 96, int across = 48) {
    return grid_mesh(round, across, true, true, [](double u, double v) {
        const double r = 0.05 + 0.02 * std::cos(2 * std::numbers::pi * v);
        return Vec3(r * std::cos(2 * std::numbers::pi * u), r * std::sin(2 * std::numbers::pi * u),
                    0.02 * std::sin(2 * std::numbers::pi * v));
    });
}

inline mesh::TriangleMesh sphere() {
    return grid_mesh(96, 48, true, false, [](double u, double v) {
        const double polar = std::numbers::pi * (0.001 + 0.998 * v);
        return Vec3(0.05 * std::sin(polar) * std::cos(2 * std::numbers::pi * u),
                    0.05 * std::sin(polar) * std::sin(2 * std::numbers::pi * u), -0.05 * std::cos(polar));
    });
}

}  // namespace tuft::test
