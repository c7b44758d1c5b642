#include "stroke/placement/registration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/random.h"

namespace tuft::stroke {
namespace {

constexpr double kLeastEigenvalue = 1e-4;  // of the largest
constexpr double kStill = 1e-7;            // of the size
constexpr double kFacing = 0.34;           // cosine between normals of a pair
constexpr double kSideways = 0.5;          // cosine between a pair and its normal: less lies past a border
constexpr double kFar = 5;                 // times the median distance
constexpr int kMostUnknowns = 12;

using Row = Eigen::Matrix<double, 1, Eigen::Dynamic, Eigen::RowMajor, 1, kMostUnknowns>;
using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMostUnknowns, kMostUnknowns>;
using Column = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostUnknowns, 1>;

/// A moved point, and where it should come to lie.
struct Pair {
    Vec3 moved{0}, direction{0};  // unit direction in which the distance counts
    double distance = 0;          // along it, signed
    double apart = 0;             // metres between the points
};

std::vector<Pair> find_pairs(std::span<const OrientedPoint> points, const mesh::SurfaceQuery& surface,
                             const ModelMotion& motion, double slack) {
    std::vector<Pair> pairs;
    for (const OrientedPoint& point : points) {
        const Vec3 p = motion(point.position);
        const auto hit = surface.closest_point(p);
        if (!hit || glm::dot(motion.rotation * point.normal, hit->normal) < kFacing) continue;
        const Vec3 apart = p - hit->position;
        const double length = glm::length(apart);
        const bool past_border = std::abs(glm::dot(apart, hit->face_normal)) < kSideways * length;
        const Vec3 direction = past_border ? apart / length : hit->normal;
        pairs.push_back({p, direction, glm::dot(apart, direction), length});
    }
    if (pairs.empty()) return pairs;
    std::vector<double> distances;
    distances.reserve(pairs.size());
    for (const Pair& pair : pairs) distances.push_back(pair.apart);
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>(distances.size() / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    const double farthest = std::max(slack, kFar * *middle);
    std::erase_if(pairs, [&](const Pair& pair) { return pair.apart > farthest; });
    return pairs;
}

int unknowns_of(MotionFreedom freedom) {
    return freedom == MotionFreedom::rigid ? 6 : freedom == MotionFreedom::similarity ? 7 : kMostUnknowns;
}

/// Change of a pair's distance by each unknown: shift, then rotation (and growth), or all of a matrix; about `centre`,
/// in units of `size`.
Row row_of(const Pair& pair, const Vec3& centre, double size, MotionFreedom freedom) {
    const Vec3 q = (pair.moved - centre) / size, n = pair.direction;
    Row row(unknowns_of(freedom));
    for (int k = 0; k < 3; ++k) row[k] = n[k];
    if (freedom == MotionFreedom::affine) {
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) row[3 + 3 * i + j] = n[i] * q[j];
        return row;
    }
    const Vec3 turn = glm::cross(q, n);
    for (int k = 0; k < 3; ++k) row[3 + k] = turn[k];
    if (freedom == MotionFreedom::similarity) row[6] = glm::dot(n, q);
    return row;
}

/// Least squares without the directions that the pairs do not decide.
Column solve_truncated(const Square& matrix, const Column& right) {
    const Eigen::SelfAdjointEigenSolver<Square> solver(matrix);
    const auto& values = solver.eigenvalues();
    Column sum = Column::Zero(right.size());
    for (Eigen::Index k = 0; k < values.size(); ++k) {
        if (!(values[k] > kLeastEigenvalue * values[values.size() - 1])) continue;
        const Column axis = solver.eigenvectors().col(k);
        sum += (axis.dot(right) / values[k]) * axis;
    }
    return sum;
}

/// The map p → centre + shift + linear (p − centre) that the unknowns stand for.
struct Step {
    Vec3 centre{0}, shift{0};
    Mat3 linear{1};
    double largest = 0;  // metres that a point of the size moves by

    Step(const Column& x, const Vec3& about, double size, MotionFreedom freedom) : centre(about) {
        shift = {x[0], x[1], x[2]};
        if (freedom == MotionFreedom::affine) {
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j) linear[j][i] += x[3 + 3 * i + j] / size;
        } else {
            const Vec3 turn = Vec3(x[3], x[4], x[5]) / size;
            const double angle = glm::length(turn);
            if (angle > 0) linear = glm::mat3_cast(glm::angleAxis(angle, turn / angle));
            if (freedom == MotionFreedom::similarity) linear *= std::exp(x[6] / size);
        }
        largest = glm::length(shift);
        for (int j = 0; j < 3; ++j) largest += size * glm::length(linear[j] - Mat3(1)[j]);
    }
};

}  // namespace

std::vector<OrientedPoint> even_points(const mesh::TriangleMesh& mesh, std::size_t count) {
    std::vector<double> until(mesh.n_triangles());
    double area = 0;
    for (std::uint32_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec3 a = mesh.position(t, 0);
        area += 0.5 * glm::length(glm::cross(mesh.position(t, 1) - a, mesh.position(t, 2) - a));
        until[t] = area;
    }
    std::vector<OrientedPoint> points;
    for (std::size_t i = 0; i < count && area > 0; ++i) {
        const double at = area * (static_cast<double>(i) + uniform(1, i)) / static_cast<double>(count);
        const auto t = static_cast<std::uint32_t>(
            std::min<std::ptrdiff_t>(std::upper_bound(until.begin(), until.end(), at) - until.begin(),
                                     static_cast<std::ptrdiff_t>(until.size()) - 1));
        const double r = std::sqrt(uniform(2, i)), s = uniform(3, i);
        const mesh::SurfacePoint point = mesh::surface_point(mesh, t, r * (1 - s), r * s);
        points.push_back({point.position, point.normal});
    }
    return points;
}

MeanDistance mean_distance(std::span<const OrientedPoint> points, const mesh::SurfaceQuery& surface,
                           const ModelMotion& motion, double most) {
    std::vector<double> distances;
    for (const OrientedPoint& p : points) {
        const auto hit = surface.closest_point(motion(p.position), most);
        distances.push_back(hit ? std::min(most, hit->distance) : most);
    }
    if (distances.empty()) return {most, most};
    std::ranges::sort(distances);
    const auto mean = [&](double part) {
        const auto n = static_cast<std::ptrdiff_t>(std::ceil(part * static_cast<double>(distances.size())));
        return std::accumulate(distances.begin(), distances.begin() + n, 0.0) / static_cast<double>(n);
    };
    return {mean(kFittingPart), mean(1)};
}

ModelMotion register_points(std::span<const OrientedPoint> points, const mesh::SurfaceQuery& surface, ModelMotion start,
                            const RegistrationOptions& options) {
    const MotionFreedom freedom = options.freedom;
    const double size = options.size;
    ModelMotion motion = start;
    for (int i = 0; i < options.iterations && size > 0; ++i) {
        const std::vector<Pair> pairs = find_pairs(points, surface, motion, options.slack);
        const int n = unknowns_of(freedom);
        if (pairs.size() < static_cast<std::size_t>(2 * n)) return motion;
        Vec3 centre(0);
        for (const Pair& pair : pairs) centre += pair.moved / static_cast<double>(pairs.size());
        Square matrix = Square::Zero(n, n);
        Column right = Column::Zero(n);
        for (const Pair& pair : pairs) {
            const Row row = row_of(pair, centre, size, freedom);
            matrix += row.transpose() * row;
            right -= pair.distance * row.transpose();
        }
        const Step step(solve_truncated(matrix, right), centre, size, freedom);
        if (!(step.largest < size) || !(glm::determinant(step.linear) > 0)) return motion;
        motion.to = step.centre + step.shift + step.linear * (motion.to - step.centre);
        motion.set_linear(step.linear * motion.linear());
        if (freedom != MotionFreedom::affine) motion.stretch = Mat3(1);
        if (step.largest < kStill * size) break;
    }
    return motion;
}

}  // namespace tuft::stroke
