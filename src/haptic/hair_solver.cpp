#include "haptic/hair_solver.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/ease.h"
#include "core/system/cpu_time.h"
#include "haptic/device/limits.h"

namespace tuft::haptic {
namespace {

constexpr double kMargin = 5e-3;  // m from the surface at which a point of the handle becomes a bound
// m up the handle; the closest two points are nearer to each other than the handle is thick
constexpr std::array kUpTheHandle{0.006, 0.013, 0.021, 0.031, 0.044, 0.061, 0.083, 0.112, 0.15};

}  // namespace

HairSolver::HairSolver(brush::Tuft tuft, const mesh::SurfaceQuery& surface, const SolverOptions& options)
    : tuft_(std::move(tuft)), surface_(surface), options_(options) {
    const brush::Preset& p = tuft_.preset;
    stations_.push_back({.radius = -1});
    if (p.width > 0)
        for (const double side : {-0.5, 0.5}) stations_.push_back({.place = {side * p.width, 0, 0}, .radius = 0});
    for (const double up : kUpTheHandle)
        if (up <= options_.handle_length && stations_.size() < HairAnswer::kMostBounds)
            stations_.push_back({.place = {0, 0, up}, .radius = p.radius + options_.ferrule_wall});
}

void HairSolver::set_ink(double wetness, double ink_left) {
    tuft_.wetness = wetness;
    tuft_.ink_left = ink_left;
}

void HairSolver::restart(const RootPose& pose) {
    const brush::Pose at{pose.position, pose.rotation, 0};
    memory_ = {.smooth = std::move(memory_.smooth)};
    if (tuft_.posed) brush::step(tuft_, at, {}, 0);  // the hair comes through the air, as it sprang back
    const contact::NodeContactOptions reach{.reach = options_.handle_length};
    const Vec3 free = contact::find_outside_point(surface_, pose.position, -at.axis(), reach);
    for (Station& s : stations_) {
        s.outside = s.last = free;
        s.clear = 0;
        s.side = 1;
    }
    last_ = pose;
    started_ = true;
}

void HairSolver::bound_root(const RootPose& pose, HairAnswer& answer) {
    const Vec3 axis = pose.rotation * Vec3{0, 0, -1};
    for (Station& s : stations_) {
        const Vec3 lever = pose.rotation * s.place, p = pose.position + lever;
        const double reach = kMargin + (s.radius < 0 ? tuft_.preset.radius : s.radius);
        if (s.clear - glm::length(p - s.last) > reach) continue;
        const contact::NodeContact stand =
            contact::find_node_contact(surface_, {.node = p, .from = s.outside, .side = s.side}, {.reach = 2 * reach});
        s.outside = stand.triangle == kNone ? p : stand.outside;
        s.side = stand.triangle == kNone ? 1 : stand.side;
        s.last = p;
        s.clear = stand.triangle == kNone ? 2 * reach : std::max(0.0, stand.height);
        if (stand.triangle == kNone || answer.n_bounds == HairAnswer::kMostBounds) continue;
        const Vec3& n = stand.plane.normal;
        const double needed =
            s.radius < 0 ? contact::mouth_clearance(n, axis, contact::ferrule_pad(tuft_.preset)) : s.radius;
        if (stand.height > needed + kMargin) continue;
        answer.bounds[answer.n_bounds++] = {n, glm::dot(n, pose.position) + needed - stand.height, lever};
    }
}

// Bingham's law without its viscous part, over the area on which hair lies; smooth about rest, so that the hand at rest
// feels no flicker.
Vec3 HairSolver::paste_drag(const Vec3& velocity) const {
    constexpr double kSmooth = 5e-3;  // m/s
    double area = 0;
    for (const brush::Branch& branch : state_.branches)
        for (std::size_t i = 1; i < branch.sections.size(); ++i) {
            const brush::Section& s = branch.sections[i];
            if (s.pressure > 0) area += 2 * s.a * glm::distance(s.centre, branch.sections[i - 1].centre);
        }
    return -options_.added.yield_stress * area * velocity / (glm::length(velocity) + kSmooth);
}

HairAnswer HairSolver::solve(const RootPose& pose) {
    const double begin = thread_cpu_seconds();
    if (!started_ || pose.taken_up != last_.taken_up) restart(pose);
    const double dt = static_cast<double>(pose.tick - last_.tick) * kPeriod;
    const double time = static_cast<double>(pose.tick) * kPeriod;
    contact::Result result =
        contact::step(tuft_, {pose.position, pose.rotation, time}, surface_, memory_, dt, options_.contact);
    HairAnswer answer;
    answer.pose = pose;
    answer.force = result.tuft.force;
    answer.moment = result.tuft.moment;
    answer.stored = result.tuft.energy.stored();
    answer.distance = result.distance;
    answer.touching = result.tuft.touching;
    answer.converged = result.tuft.converged;
    state_ = std::move(result.tuft);
    if (options_.added.yield_stress > 0 && answer.touching && dt > 0)
        answer.force += paste_drag((pose.position - last_.position) / dt);
    if (options_.added.proximity > 0 && result.triangle != kNone) {
        constexpr double kReach = 1e-3;  // m: 0.1 N over a tenth of it would be 1,000 N/m
        answer.force += options_.added.proximity * smooth_step(1 - answer.distance / kReach) * result.frame.n;
    }
    bound_root(pose, answer);
    last_ = pose;
    answer.seconds = thread_cpu_seconds() - begin;
    return answer;
}

}  // namespace tuft::haptic
