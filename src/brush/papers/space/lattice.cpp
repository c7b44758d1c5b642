#include "brush/papers/space/lattice.h"

#include <algorithm>
#include <cmath>

namespace tuft::brush {

namespace {

/// Bernstein polynomials of degree K at u. [K+1]
std::vector<double> bernstein(int degree, double u) {
    std::vector<double> b{1};
    for (int n = 1; n <= degree; ++n) {
        b.push_back(0);
        for (std::size_t k = b.size() - 1; k > 0; --k) b[k] = (1 - u) * b[k] + u * b[k - 1];
        b[0] *= 1 - u;
    }
    return b;
}

Vec3 along(std::span<const double> at, std::span<const Vec3> values, double u) {
    const auto after = std::upper_bound(at.begin() + 1, at.end() - 1, u);
    const std::size_t i = static_cast<std::size_t>(after - at.begin());
    return glm::mix(values[i - 1], values[i], (u - at[i - 1]) / (at[i] - at[i - 1]));
}

}  // namespace

Vec3 lattice_point(const Lattice& lattice, double s, double t, double u) {
    const std::vector<double> b = bernstein(lattice.degree, u);
    Vec3 sum{0};
    for (std::size_t k = 0; k < b.size(); ++k) {
        const auto& layer = lattice.control[k];
        sum += b[k] * glm::mix(glm::mix(layer[0][0], layer[0][1], t), glm::mix(layer[1][0], layer[1][1], t), s);
    }
    return sum;
}

Lattice span_lattice(const LatticeSpines& spines, int degree) {
    Lattice lattice{degree, {}};
    lattice.control.resize(static_cast<std::size_t>(degree) + 1);
    for (int k = 0; k <= degree; ++k) {
        const double u = static_cast<double>(k) / degree;
        for (std::size_t i = 0; i < 2; ++i) {
            const Vec3 middle = along(spines.at, spines.node[i], u) + along(spines.at, spines.outward[i], u);
            const Vec3 across = along(spines.at, spines.across[i], u);
            lattice.control[static_cast<std::size_t>(k)][i] = {middle - across, middle + across};
        }
    }
    return lattice;
}

}  // namespace tuft::brush
