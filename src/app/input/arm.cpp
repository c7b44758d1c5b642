#include "app/input/arm.h"

#include <algorithm>
#include <glm/gtx/quaternion.hpp>
#include <iterator>
#include <utility>

#include "core/error.h"
#include "haptic/device/exchange.h"
#include "haptic/device/haply.h"
#include "haptic/recording.h"

namespace tuft::app {
namespace {

constexpr double kAbove = 0.01;    // m of the tip over the surface where the brush begins
constexpr double kOnModel = 0.05;  // m round the model within which a recording is in the model's own frame

haptic::HandMotion motion_of(const std::string& hand) {
    for (int i = 0; i <= static_cast<int>(haptic::HandMotion::slide); ++i)
        if (haptic::name_of(static_cast<haptic::HandMotion>(i)) == hand) return static_cast<haptic::HandMotion>(i);
    throw Error(Message("unknown hand '{}'", hand));
}

/// The rotation in which the brush is upright on a surface.
Quat upright(const Vec3& normal) {
    return glm::rotation(Vec3{0, 0, 1}, normal);
}

bool lies_within(const Box& box, const Vec3& p, double margin) {
    return glm::all(glm::greaterThan(p, box.lo - margin)) && glm::all(glm::lessThan(p, box.hi + margin));
}

}  // namespace

/// Where the pointer wants the hand: written by the window's thread, read by the servo's.
struct Arm::PointerHand {
    haptic::TripleBuffer<haptic::HandTarget> wanted;
    haptic::HandTarget now;

    haptic::HandTarget at_present() {
        wanted.read(now);
        return now;
    }
};

Arm::Arm(const ArmSettings& settings) : settings_(settings) {
    const haptic::DeviceLimits& limits = haptic::device_preset(settings.preset);
    if (settings.source == ArmSource::service)
        device_ = std::make_unique<haptic::HaplyDevice>(limits, haptic::HaplyAddress{settings.host, settings.port});
    else if (settings.source == ArmSource::recording) {
        std::vector<haptic::RecordedPeriod> periods = haptic::read_recording(settings.recording);
        const auto first = std::ranges::find_if(periods, [](const auto& p) { return p.fresh; });
        if (first == periods.end()) throw Error(settings.recording.string(), Message("has no position of an arm"));
        first_ = first->state;
        known_ = true;
        device_ = std::make_unique<haptic::ReplayDevice>(limits, std::move(periods));
    } else {
        if (settings.hand != "pointer") motion_of(settings.hand);
        hand_ = std::make_shared<PointerHand>();
        device_ = std::make_unique<haptic::SimulatedDevice>(
            haptic::SimulatedArm(limits, [](double) { return haptic::HandTarget{}; }));
        known_ = true;
    }
}

Arm::~Arm() {
    leave();
}

bool Arm::ready() {
    if (!known_ && !loop_) known_ = device_->read(first_);
    return known_;
}

void Arm::open_simulated() {
    haptic::HandPath path;
    if (follows_pointer()) {
        hand_->wanted.write({});
        path = [hand = hand_](double) { return hand->at_present(); };
    } else {
        const haptic::HandPath world = haptic::hand_path(motion_of(settings_.hand), {"", scene_.start}, scene_.brush);
        path = [world, space = workspace_](double time) {
            haptic::HandTarget target = world(time);
            target.position = space.place_in_device(target.position);
            target.velocity = space.to_device(target.velocity) / space.scale;
            target.rotation = glm::conjugate(space.rotation) * target.rotation * space.grip;
            return target;
        };
    }
    device_ = std::make_unique<haptic::SimulatedDevice>(
        haptic::SimulatedArm(haptic::device_preset(settings_.preset), std::move(path)));
}

// Where the arm's space lies: so that the brush begins above the start, or its tip where it was.
void Arm::place(const ArmScene& scene) {
    if (scene.surface == scene_.surface && status_.counts.periods > 0) {
        const double longer = scene.brush.length - scene_.brush.length;
        const Vec3 root = status_.arm + longer * (status_.rotation * Vec3{0, 0, 1});
        workspace_ = workspace_.regripped(status_.device, root);
        scene_.brush = scene.brush;
        return;
    }
    scene_ = scene;
    const haptic::DeviceState from = settings_.source == ArmSource::simulated ? haptic::DeviceState{} : first_;
    const bool recorded_here =
        settings_.source == ArmSource::recording && lies_within(scene.surface->mesh().bounds, from.position, kOnModel);
    workspace_ = {};
    if (!recorded_here) {
        const Vec3 above = scene.start.origin + (scene.brush.length + kAbove) * scene.start.n;
        workspace_.rotation = scene.axes;
        workspace_.scale = settings_.scale;
        workspace_.grip = glm::normalize(glm::conjugate(upright(scene.start.n)) * scene.axes * from.rotation);
        workspace_ = workspace_.regripped(from.position, above);
    }
    if (follows_pointer()) open_simulated();
}

void Arm::feel(const ArmScene& scene) {
    leave();
    place(scene);
    if (settings_.source == ArmSource::simulated && !follows_pointer()) open_simulated();
    haptic::LoopOptions options;
    options.law = law();
    loop_ = std::make_unique<haptic::Loop>(
        *device_, haptic::HairSolver(brush::make_tuft(scene_.brush), *scene_.surface), options);
    loop_->set_control({.workspace = workspace_});
    cutter_ = {};
    dropped_ = hold_.carried = hold_.known = false;
    silent_ = 0;
    loop_->start();
}

void Arm::leave() {
    if (!loop_) return;
    loop_->stop();
    for (haptic::StrokeCutter::Cut& cut : take_strokes(paints_)) left_.push_back(std::move(cut));
    if (cutter_.in_stroke()) left_.push_back({.ends = true});
    cutter_ = {};
    status_ = loop_->status();
    loop_.reset();
    if (settings_.source == ArmSource::service) known_ = false;
}

void Arm::leave_surface() {
    leave();
    scene_ = {};
    status_ = {};
}

haptic::LawOptions Arm::law() const {
    return {.limits = device_->limits(),
            .gain = settings_.gain > 0 ? settings_.gain : scene_.brush.force_gain,
            .scale = workspace_.scale,
            .restore = settings_.restore,
            .most_force = settings_.most_force};
}

void Arm::apply(const ArmSettings& settings) {
    settings_.gain = settings.gain;
    settings_.most_force = settings.most_force;
    settings_.restore = settings.restore;
    settings_.proximity = settings.proximity;
    settings_.scale = workspace_.scale = settings.scale;
    settings_.centre = settings.centre;
    if (loop_) loop_->set_law(law());
}

void Arm::set_upright() {
    const auto below = scene_.surface ? scene_.surface->closest_point(status_.root) : std::nullopt;
    if (!below || !loop_) return;
    workspace_.grip = glm::normalize(glm::conjugate(upright(below->normal)) * workspace_.rotation * status_.grip);
}

void Arm::drop_stroke() {
    cutter_.end();
    dropped_ = true;
}

void Arm::set_workspace(const Vec3& about, const Quat& axes, bool moves) {
    if (!moves) {
        hold_.known = hold_.carried = false;
        workspace_.rotation = axes;
        return;
    }
    // From the first frame on the space keeps its place in the view.
    if (!hold_.known) {
        workspace_.rotation = axes;
        hold_.offset = glm::conjugate(axes) * (workspace_.offset - about);
        hold_.known = true;
    }
    workspace_.rotation = axes;
    workspace_.offset = about + axes * hold_.offset;
    hold_.carried = true;
}

void Arm::set_control(haptic::ServoControl control) {
    control.workspace = workspace_;
    control.carried = hold_.carried;
    if (loop_) loop_->set_control(control);
}

void Arm::release() {
    if (loop_) loop_->release();
}

// A brush that runs dry has less paste under it.
void Arm::set_ink(double wetness, double ink_left, double yield_stress) {
    if (!loop_) return;
    loop_->set_ink(wetness, ink_left);
    const double gain = law().gain;
    loop_->set_added({.proximity = gain > 0 ? settings_.proximity / gain : 0,
                      .yield_stress = yield_stress * std::clamp(ink_left, 0.0, 1.0)});
}

// The space may be shifted by the clutch: the place is found from where the arm is in both frames.
void Arm::point_to(const Vec3& root, const Quat& rotation) {
    if (!hand_) return;
    const Quat back = glm::conjugate(workspace_.rotation);
    hand_->wanted.write({.position = status_.device + back * (root - status_.arm) / workspace_.scale,
                         .rotation = glm::normalize(back * rotation * workspace_.grip)});
}

const haptic::LoopStatus& Arm::poll() {
    if (loop_) status_ = loop_->status();
    return status_;
}

ArmStrokes Arm::take_strokes(bool paints) {
    constexpr int kSilent = 2;  // a solve that was late may still come after the first look
    paints_ = paints;
    ArmStrokes strokes = std::exchange(left_, {});
    haptic::SolvedPose pose;
    while (loop_ && loop_->pop(pose)) {
        if (!pose.touching) dropped_ = false;
        if (!cutter_.in_stroke() && (!paints || dropped_)) pose.touching = false;
        haptic::StrokeCutter::Cut cut = cutter_.add(pose);
        if (cut.begins || cut.ends || strokes.empty() || strokes.back().ends) {
            if (cut.begins || cut.ends || !cut.poses.empty()) strokes.push_back(std::move(cut));
        } else {
            std::ranges::move(cut.poses, std::back_inserter(strokes.back().poses));
        }
    }
    // No force, no pose: a pause ends the stroke where it is.
    silent_ = loop_ && !loop_->status().engaged ? silent_ + 1 : 0;
    if (cutter_.in_stroke() && silent_ >= kSilent) {
        cutter_.end();
        strokes.push_back({.ends = true});
    }
    return strokes;
}

std::vector<float> Arm::recent_forces() const {
    return loop_ ? loop_->recent_forces() : std::vector<float>{};
}

bool Arm::at_limit() const {
    constexpr double kNear = 5e-3;  // m
    return glm::any(glm::greaterThan(glm::abs(status_.device - settings_.centre), 0.5 * limits().workspace - kNear));
}

std::array<Vec3, 8> Arm::reach() const {
    std::array<Vec3, 8> corners;
    const Vec3 half = 0.5 * limits().workspace;
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const Vec3 side{i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1};
        const Vec3 from = settings_.centre + half * side - status_.device;
        corners[i] = status_.arm + workspace_.rotation * (workspace_.scale * from);
    }
    return corners;
}

}  // namespace tuft::app
