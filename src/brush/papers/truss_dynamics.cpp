#include "brush/papers/truss_dynamics.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace tuft::brush::truss {

namespace {

constexpr int kContractions = 20;    ///< sweeps of the stretch limit [X]
constexpr double kSlack = 1e-4;      ///< of the rest length, by which a contracted spring is shorter than its longest
constexpr double kOnSurface = 1e-9;  ///< m, a particle so near touches

int truss_count(Kind kind) {
    return kind == Kind::round ? 1 : kind == Kind::flat ? 2 : 4;
}

void join(Truss& truss, int from, int to) {
    truss.springs.push_back({from, to, truss.stiffness, glm::length(truss.rest[from] - truss.rest[to])});
}

/// Length of truss j: the outer two of a filbert are shorter.
double truss_length(const Shape& shape, int j, int count) {
    const bool outer = shape.kind == Kind::filbert && (j == 0 || j == count - 1);
    return shape.length * (outer ? shape.outer_length : 1);
}

Vec3 base_centre(const Truss& truss, std::span<const Vec3> particles) {
    Vec3 sum{0};
    for (int i = 0; i < truss.base_count(); ++i) sum += particles[i];
    return sum / static_cast<double>(truss.base_count());
}

bool too_long(const Spring& s, std::span<const Vec3> particles) {
    return glm::length(particles[s.to] - particles[s.from]) > (1 + kMostStretch) * s.rest;
}

/// Displacement that takes a vector d to length `most`. On the surface of a half space it runs along the surface if it
/// can, so that hair that is drawn along keeps touching.
Vec3 shortening(const Vec3& d, double most, const HalfSpace* touched) {
    if (touched != nullptr) {
        const double rise = glm::dot(d, touched->normal);
        const Vec3 along = d - rise * touched->normal;
        const double run = glm::length(along);
        if (std::abs(rise) < most && run > 0) return (std::sqrt(most * most - rise * rise) / run - 1) * along;
    }
    return (most / glm::length(d) - 1) * d;
}

/// Contracts all springs that are too long by the mean displacement of those at each point; whether there were any.
bool contract_all(const Truss& truss, const StepContact& contact, std::vector<Vec3>& particles) {
    std::vector<Vec3> displacement(static_cast<std::size_t>(truss.count), Vec3{0});
    std::vector<int> count(displacement.size(), 0);
    const int base = truss.base_count();
    const auto pull = [&](int point, int other, const Spring& s, double share) {
        const HalfSpace* space = contact.below.empty() ? nullptr : &contact.below[point - base];
        const bool touches = space != nullptr && space->height(particles[point]) <= kOnSurface;
        const double most = (1 + kMostStretch - kSlack) * s.rest;
        displacement[point - base] +=
            share * shortening(particles[point] - particles[other], most, touches ? space : nullptr);
        ++count[point - base];
    };
    bool any = false;
    for (const Spring& s : truss.springs) {
        if (!too_long(s, particles)) continue;
        any = true;
        const bool driven = s.from < base;
        pull(s.to, s.from, s, driven ? 1 : 0.5);
        if (!driven) pull(s.from, s.to, s, 0.5);
    }
    for (std::size_t j = 0; j < displacement.size(); ++j)
        if (count[j] > 0) particles[base + j] += displacement[j] / static_cast<double>(count[j]);
    return any;
}

/// Largest factor f <= 1 for which the spring is short enough after p ← centre + f (p − centre) of its free ends.
double fitting_factor(const Truss& truss, const Spring& s, std::span<const Vec3> particles, const Vec3& centre) {
    const double most = (1 + kMostStretch) * s.rest;
    const Vec3 b = particles[s.to] - centre;
    if (s.from >= truss.base_count()) return std::min(1.0, most / glm::length(particles[s.to] - particles[s.from]));
    // |c + f b| = most, c from the base particle to the centre.
    const Vec3 c = centre - particles[s.from];
    const double bb = glm::dot(b, b), bc = glm::dot(b, c), rest = glm::dot(c, c) - most * most;
    if (!(bb > 0) || bb + 2 * bc + rest <= 0) return 1;
    return std::clamp((-bc + std::sqrt(std::max(0.0, bc * bc - bb * rest))) / bb, 0.0, 1.0);
}

}  // namespace

Truss make_truss(const Shape& shape, double stiffness, double relaxation) {
    Truss truss;
    truss.count = truss_count(shape.kind);
    const double hx = shape.half_width / truss.count, hy = shape.half_thickness;
    for (int j = 0; j < truss.count; ++j) {
        const double x = (2 * j + 1 - truss.count) * hx;
        for (const Vec2 corner : {Vec2{hx, hy}, Vec2{-hx, hy}, Vec2{-hx, -hy}, Vec2{hx, -hy}})
            truss.rest.emplace_back(x + corner.x / std::sqrt(2.0), corner.y / std::sqrt(2.0), 0);
    }
    for (int j = 0; j < truss.count; ++j)
        truss.rest.emplace_back((2 * j + 1 - truss.count) * hx, 0, -truss_length(shape, j, truss.count));
    truss.half_diagonal = std::sqrt(0.5 * (hx * hx + hy * hy));
    const double edge = std::hypot(shape.length, truss.half_diagonal), slope = truss.half_diagonal / edge;
    const double lateral = 3 * stiffness / truss.count / std::pow(shape.length, 3);
    truss.stiffness = lateral / (2 * slope * slope);
    truss.drag = relaxation * lateral;
    for (int j = 0; j < truss.count; ++j)
        for (int k = 0; k < 4; ++k) join(truss, 4 * j + k, truss.base_count() + j);
    for (int j = 0; j + 1 < truss.count; ++j) join(truss, truss.base_count() + j, truss.base_count() + j + 1);
    return truss;
}

std::vector<Vec3> spring_forces(const Truss& truss, std::span<const Vec3> particles) {
    std::vector<Vec3> force(particles.size(), Vec3{0});
    for (const Spring& s : truss.springs) {
        const Vec3 d = particles[s.to] - particles[s.from];
        const double length = glm::length(d);
        if (!(length > 0)) continue;
        const Vec3 f = s.stiffness * (length - s.rest) / length * d;
        force[s.from] += f;
        force[s.to] -= f;
    }
    return force;
}

double spring_energy(const Truss& truss, std::span<const Vec3> particles) {
    double sum = 0;
    for (const Spring& s : truss.springs) {
        const double longer = glm::length(particles[s.to] - particles[s.from]) - s.rest;
        sum += 0.5 * s.stiffness * longer * longer;
    }
    return sum;
}

double largest_stretch(const Truss& truss, std::span<const Vec3> particles) {
    double most = 0;
    for (const Spring& s : truss.springs)
        if (s.rest > 0) most = std::max(most, glm::length(particles[s.to] - particles[s.from]) / s.rest - 1);
    return most;
}

std::vector<double> step_matrix(const Truss& truss, double h) {
    Eigen::MatrixXd a = Eigen::MatrixXd::Identity(truss.count, truss.count);
    const double unit = h / truss.drag;
    for (const Spring& s : truss.springs) {
        const int from = s.from - truss.base_count(), to = s.to - truss.base_count();
        a(to, to) += unit * s.stiffness;
        if (from < 0) continue;
        a(from, from) += unit * s.stiffness;
        a(from, to) -= unit * s.stiffness;
        a(to, from) -= unit * s.stiffness;
    }
    const Eigen::MatrixXd inverse = unit * a.llt().solve(Eigen::MatrixXd::Identity(truss.count, truss.count));
    return {inverse.data(), inverse.data() + inverse.size()};
}

void move_points(const Truss& truss, std::span<const double> matrix, const StepContact& contact,
                 std::vector<Vec3>& particles) {
    const std::vector<Vec3> force = spring_forces(truss, particles);
    const int base = truss.base_count();
    for (int j = 0; j < truss.count; ++j) {
        Vec3& x = particles[base + j];
        Vec3 move{0};
        for (int i = 0; i < truss.count; ++i) move += matrix[j * truss.count + i] * force[base + i];
        if (!contact.below.empty()) {
            const HalfSpace& space = contact.below[j];
            const double pressing = -glm::dot(force[base + j], space.normal);
            if (pressing > 0 && space.height(x) <= kOnSurface) {
                const Vec3 tangential = force[base + j] + pressing * space.normal;
                const double size = glm::length(tangential), held = contact.friction * pressing;
                const Vec3 along = move - glm::dot(move, space.normal) * space.normal;
                move -= along * (held < size ? held / size : 1.0);
            }
            x = space.projected(x + move);
        } else {
            x += move;
        }
    }
}

void limit_stretch(const Truss& truss, const StepContact& contact, std::vector<Vec3>& particles) {
    const int base = truss.base_count();
    for (int sweep = 0; sweep < kContractions; ++sweep) {
        for (int j = 0; j < truss.count && !contact.below.empty(); ++j)
            particles[base + j] = contact.below[j].projected(particles[base + j]);
        if (!contract_all(truss, contact, particles)) return;
    }
    const Vec3 centre = base_centre(truss, particles);
    double factor = 1;
    for (const Spring& s : truss.springs) factor = std::min(factor, fitting_factor(truss, s, particles, centre));
    for (int j = 0; j < truss.count; ++j) particles[base + j] = centre + factor * (particles[base + j] - centre);
}

}  // namespace tuft::brush::truss
