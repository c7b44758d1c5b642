#include "stroke/gesture/symmetry.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>

namespace tuft::stroke {
namespace {

constexpr std::size_t kMostElements = 128;

bool same(const Mat3& a, const Mat3& b) {
    double difference = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) difference = std::max(difference, std::abs(a[column][row] - b[column][row]));
    return difference < 1e-9;
}

}  // namespace

brush::Pose PoseMap::pose(const brush::Pose& pose) const {
    Mat3 turned = linear * glm::mat3_cast(pose.rotation);
    if (glm::determinant(turned) < 0) turned[1] = -turned[1];
    return {point(pose.position), glm::normalize(glm::quat_cast(turned)), pose.time};
}

std::vector<PoseMap> symmetry_copies(const Symmetry& s) {
    std::vector<Mat3> elements{Mat3(1)};
    const auto multiply = [&](const Mat3& generator) {
        for (std::size_t i = 0; i < elements.size() && elements.size() < kMostElements; ++i) {
            const Mat3 product = generator * elements[i];
            if (std::none_of(elements.begin(), elements.end(), [&](const Mat3& e) { return same(e, product); }))
                elements.push_back(product);
        }
    };
    const int n = std::clamp(s.radial, 1, 32);
    // Twice: a plane may make new copies of the turned ones, and a turn of the mirrored.
    for (int pass = 0; pass < 2; ++pass) {
        if (n > 1) multiply(Mat3(glm::rotate(glm::dmat4(1), 2 * std::numbers::pi / n, s.axis)));
        if (s.mirror_x) multiply(Mat3(Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)));
        if (s.mirror_y) multiply(Mat3(Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0, 0, 1)));
        if (s.mirror_z) multiply(Mat3(Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)));
    }
    std::vector<PoseMap> copies;
    for (std::size_t i = 1; i < elements.size(); ++i) copies.push_back({elements[i], s.centre});
    return copies;
}

}  // namespace tuft::stroke
