#include "brush/rod/rod.h"

#include <Eigen/Eigenvalues>
#include <cmath>

#include "brush/rod/rod_energy.h"

namespace tuft::brush::rod {

Rod make_rod(const Profile& profile, int n, double tip_ratio) {
    return make_rod(profile, spine_segments(n, tip_ratio));
}

Rod make_rod(const Profile& profile, std::span<const double> lengths) {
    const std::size_t n = lengths.size();
    Rod rod;
    rod.length.assign(lengths.begin(), lengths.end());
    rod.stiffness.resize(n);
    rod.yield.resize(n);
    rod.weight.assign(n + 1, 0);
    double node = 0, from = 0;
    for (std::size_t j = 0; j < n; ++j) {
        const double to = node + 0.5 * rod.length[j];
        rod.stiffness[j] = 1 / compliance(profile, from, to);
        rod.yield[j] = yield_moment(profile, node) / rod.stiffness[j];
        rod.weight[j] += 0.5 * rod.length[j];
        rod.weight[j + 1] += 0.5 * rod.length[j];
        from = to;
        node += rod.length[j];
    }
    // The clamp joint stands for the half segment beside it, where the moment of a load at
    // the tip is less by a quarter segment's lever; a little less than that, because yielding
    // grows faster than the moment (set within 2 % at 16 segments).
    if (n > 0) rod.yield[0] /= 1 - 0.2 * rod.length[0];
    rod.buckling = buckling_load(rod);
    return rod;
}

Rod outer_part(const Rod& rod, int first, double share) {
    Rod part;
    part.plastic_share = rod.plastic_share;
    part.length.assign(rod.length.begin() + first, rod.length.end());
    part.stiffness.assign(rod.stiffness.begin() + first, rod.stiffness.end());
    for (double& k : part.stiffness) k /= share;
    part.yield.assign(rod.yield.begin() + first, rod.yield.end());
    part.weight.assign(rod.weight.begin() + first, rod.weight.end());
    part.buckling = buckling_load(part);
    return part;
}

double buckling_load(const Rod& rod) {
    const Eigen::Index n = rod.segments();
    if (n < 2) return 0;
    // In φ = √l θ the load's form is |φ|² and the tip is held where v·φ = 0.
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd v(n);
    for (Eigen::Index j = 0; j < n; ++j) {
        const double k = rod.stiffness[j], l = rod.length[j];
        v[j] = std::sqrt(l);
        a(j, j) += k / l;
        if (j == 0) continue;
        const double before = rod.length[j - 1];
        a(j - 1, j - 1) += k / before;
        a(j, j - 1) -= k / std::sqrt(l * before);
        a(j - 1, j) = a(j, j - 1);
    }
    v.normalize();
    const Eigen::MatrixXd held = Eigen::MatrixXd::Identity(n, n) - v * v.transpose();
    a = held * a * held + a.trace() * v * v.transpose();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(a, Eigen::EigenvaluesOnly);
    return eigen.info() == Eigen::Success ? eigen.eigenvalues()[0] : 0;
}

Memory make_memory(const Rod& rod, const Clamp& clamp) {
    Memory memory;
    memory.clamp = clamp;
    memory.tangent.assign(rod.segments(), clamp.tangent);
    memory.joint.resize(rod.segments());
    memory.contact.resize(rod.segments() + 1);
    memory.node = nodes(rod, memory);
    return memory;
}

void move_with_clamp(Memory& memory, const Clamp& clamp) {
    const Clamp& was = memory.clamp;
    const Mat3 turn = clamp_frame(clamp) * glm::transpose(clamp_frame(was));
    for (Vec3& t : memory.tangent) t = glm::normalize(turn * t);
    for (Vec3& x : memory.node) x = clamp.position + turn * (x - was.position);
    memory.clamp = clamp;
}

void turn_about_clamp(Memory& memory, double angle) {
    const Quat turn = glm::angleAxis(angle, memory.clamp.tangent);
    const Vec3& root = memory.clamp.position;
    for (Vec3& t : memory.tangent) t = glm::normalize(turn * t);
    for (Vec3& x : memory.node) x = root + turn * (x - root);
    for (ContactMemory& c : memory.contact) {
        c.anchor = root + turn * (c.anchor - root);
        c.normal = turn * c.normal;
    }
    // In the joints' frames, which are carried out from the clamp, a turn of all is a turn in the plane.
    const double co = std::cos(angle), si = std::sin(angle);
    const auto turned = [&](const Vec2& v) { return Vec2{co * v.x - si * v.y, si * v.x + co * v.y}; };
    for (JointMemory& joint : memory.joint) {
        for (Vec2& s : joint.stop) s = turned(s);
        joint.bend = turned(joint.bend);
    }
    memory.turn.clear();
}

Recycled<Vec3> nodes(const Rod& rod, const Memory& memory) {
    Recycled<Vec3> x(rod.segments() + 1);
    x[0] = memory.clamp.position;
    for (int j = 0; j < rod.segments(); ++j) x[j + 1] = x[j] + rod.length[j] * memory.tangent[j];
    return x;
}

}  // namespace tuft::brush::rod
