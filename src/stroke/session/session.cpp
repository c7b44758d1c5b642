#include "stroke/session/session.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/ease.h"
#include "ink/film/tile/paste.h"
#include "stroke/deposit/stamp_batch.h"
#include "stroke/placement/placement.h"

namespace tuft::stroke {
namespace {

constexpr double kLeap = 0.5;          // of a patch's size: beyond, single marks would part
constexpr double kStampsAcross = 128;  // on a path as long as the tuft is wide
constexpr double kPrintTravel = 1e-4;  // metres that dry hair slides after it came to touch until it prints
// Of the ink that a face of foam gives where it is pressed on, what it gives where it slides by as far: its ridges ride
// on a thin film, and its pores wipe behind them.
constexpr double kSlidingFoam = 0.005;
constexpr double kSlidesOn = 0.5;  // part of the way on which a face slides, from which on nothing is pressed out

// Metres: furrows and edges of paste are rounded over more than a tenth of a millimetre.
constexpr double kPasteSpacing = 1e-4, kPasteCell = 4e-5;

bool is_paste(const ink::Ink& ink) {
    return ink.yield > 0;
}

HairContactOptions hair_options(const SessionInput& in, bool mixed) {
    const double cell = 0.5 * in.model.texels.texel_size;
    const bool levels = in.wet.film || is_paste(in.ink) || in.stroke.layer == kPaletteLayer;
    const footprint::EdgeGrain grain{static_cast<double>(in.substrate.relief),
                                     static_cast<double>(in.substrate.relief_length)};
    return {.closed = {is_paste(in.ink) ? std::max(cell, kPasteCell) : cell, !levels, grain},
            .always_closed = in.stroke.layer == kPaletteLayer,
            .places_nodes = in.wet.film || mixed || is_paste(in.ink),
            .tones = !levels && !mixed && !in.stroke.erases()};
}

}  // namespace

double pose_spacing(const PaintStroke& stroke, const brush::Preset& preset, const ink::Ink& ink, double texel) {
    const double unit = std::max(texel, brush::tuft_width(preset) / kStampsAcross);
    return std::max(stroke.settings.spacing * unit, is_paste(ink) ? kPasteSpacing : 0.0);
}

StrokeSession::StrokeSession(SessionInput input)
    : input_(std::move(input)),
      tuft_{.brush = std::move(input_.brush), .ink = input_.ink, .state = {}},
      path_(path_options()),
      hair_(hair_options(input_, holds_mixed_ink())),
      stencil_(input_.surface, input_.stroke.trace),
      target_(input_.model, input_.canvas, input_.substrate,
              {.mask = input_.mask,
               .plan = input_.plan,
               .substrates = input_.substrates,
               .standing = static_cast<float>(ink::standing_film(input_.ink.yield))},
              input_.scratch),
      deposit_(make_deposit()) {
    contact_.options.method = input_.stroke.settings.contact;
    report_.nearest = std::numeric_limits<double>::infinity();
    report_.dryness.full_at_start = tuft_.brush.reservoir.fullness();
    ink_at_start_ = tuft_.brush.reservoir;
    if (input_.stroke.settings.endless && !input_.stroke.erases()) refill_ = tuft_.brush.reservoir;
}

ResampleOptions StrokeSession::path_options() const {
    return {.step = pose_spacing(input_.stroke, tuft_.preset(), input_.ink, input_.model.texels.texel_size),
            .lever = tuft_.preset().length};
}

void StrokeSession::check_length(std::span<const brush::Pose> poses) const {
    if (input_.stroke.trace.flat) return check_path_length(poses, path_options());
    GestureFilter state;
    std::vector<brush::Pose> steadied;
    steadied.reserve(poses.size());
    for (const brush::Pose& pose : poses) steadied.push_back(steady(state, pose, input_.stroke.settings));
    check_path_length(steadied, path_options());
}

bool StrokeSession::holds_mixed_ink() const {
    return !input_.stroke.erases() && ink::is_mixed(tuft_.brush.reservoir);
}

std::unique_ptr<DepositModel> StrokeSession::make_deposit() {
    const bool mixed = holds_mixed_ink();
    DepositOptions options{.wet = input_.wet};
    options.stamp.mapping = input_.stroke.settings.footprint;
    options.progress = [this](std::string_view, double) { return progress_.go_on(); };
    if (input_.stroke.erases()) return make_eraser(target_, options);
    if (is_paste(input_.ink)) return make_paste_deposit(target_, options);
    if (input_.wet.film) return make_wet_deposit(target_, options, mixed);
    return mixed ? make_mixed_deposit(target_, options) : make_still_deposit(target_, options);
}

void StrokeSession::forecast_hand() {
    contact_.forecast = forecast({});
    contact_.follows = true;
}

void StrokeSession::extend(std::span<const brush::Pose> poses, const std::function<void()>& painted) {
    StrokeSamples cluster{.flat = false};
    for (const brush::Pose& pose : poses)
        cluster.samples.push_back({.time = pose.time, .position = pose.position, .rotation = pose.rotation});
    std::vector<StrokeSample>& samples = input_.stroke.trace.samples;
    samples.insert(samples.end(), cluster.samples.begin(), cluster.samples.end());
    resample(spatial_poses(cluster));  // as a replay will see them, to the bit
    paint_poses(painted);
}

void StrokeSession::advance(std::span<const brush::Pose> poses, double done) {
    resample(poses);
    paint_poses();
    progress_.done = done;
}

void StrokeSession::resample(std::span<const brush::Pose> poses) {
    for (const brush::Pose& pose : poses) {
        ++report_.samples;
        const brush::Pose steadied = next_pose(path_, pose);
        if (input_.record_forces) forces_.samples.push_back(steadied);
        path_.resampler.push(steadied, path_.poses);
    }
}

// A flat stroke is steadied before its path is prepared.
brush::Pose StrokeSession::next_pose(Path& path, const brush::Pose& pose) const {
    return input_.stroke.trace.flat ? pose : steady(path.steady, pose, input_.stroke.settings);
}

void StrokeSession::paint_poses(const std::function<void()>& painted) {
    if (contact_.forecast && contact_.follows) contact_.forecast->follow(path_.poses);
    for (std::size_t i = 0; i < path_.poses.size(); ++i) {
        step(path_.poses[i]);
        if (painted && (i + 1) % StampBatch::kStamps == 0) painted();
    }
    path_.poses.clear();
}

contact::Result StrokeSession::next_contact(const brush::Pose& pose, double dt) {
    if (contact_.forecast) {
        if (PoseForecast* ready = contact_.forecast->next(pose, tuft_.brush.tuft, !hair_.by_hair())) {
            contact_.hair = std::move(ready->hair);
            contact_.last.store(tuft_.brush.tuft, pose, contact_.hair, ready->contact);
            return std::move(ready->contact);
        }
        leave_forecast();
    }
    // Hair that painted before comes through the air, as it sprang back.
    if (!path_.started && tuft_.brush.tuft.posed) brush::step(tuft_.brush.tuft, pose, {}, 0);
    contact::Result contact =
        contact::step(tuft_.brush.tuft, pose, input_.surface, contact_.memory, dt, contact_.options);
    contact_.hair = touches(contact) ? find_hair(tuft_.brush.tuft, contact, contact_.last) : HairShape{};
    contact_.last.store(tuft_.brush.tuft, pose, contact_.hair, contact);
    return contact;
}

void StrokeSession::leave_forecast() {
    if (contact_.forecast) contact_.forecast->catch_up(tuft_.brush.tuft, contact_.memory);
    contact_.forecast.reset();
}

// Bends the tuft on the surface at the next pose; ink spreads within the hair meanwhile.
contact::Result StrokeSession::bend_on_surface(const brush::Pose& pose, double dt) {
    if (refill_) tuft_.brush.reservoir = *refill_;
    tuft_.update_wetness();
    ink::flow(tuft_.brush.reservoir, dt, hair_.by_hair() ? ink::FlowTo::now : ink::FlowTo::whole_step);
    contact::Result contact = next_contact(pose, dt);
    contact_.device_force = contact.device_force;
    path_.time = pose.time;
    path_.started = true;
    deposit_->pass_time(dt);
    tuft_.bend(contact.tuft, pose);
    report_.nearest = std::min(report_.nearest, contact.distance);
    report_.inside.poses += contact.inside > 0;
    report_.inside.deepest = std::max(report_.inside.deepest, contact.inside);
    if (input_.record_forces)
        forces_.poses.push_back(
            {pose, contact.tuft.force, contact.device_force, contact.tuft.moment, contact.tuft.root_moment});
    return contact;
}

namespace {

// Size of a contact patch along its motion, metres: the edge of a wide tuft is far shorter than it is wide.
double patch_size(const brush::Preset& preset, double area) {
    return brush::has_broad_side(preset) ? area / preset.width : std::sqrt(std::max(area, 1e-30));
}

}  // namespace

// The hand's displacement, not the frame's: the patch also grows and shrinks. Hair that lies by itself may swing round.
// And a patch that leaps by more than it is long, as a tip does that springs back while it is lifted, leaves its line
// along its own path.
void StrokeSession::set_motion(Stamp& stamp, const ContactMotion& moved, double area) const {
    const brush::Preset& preset = tuft_.brush.tuft.preset;
    const double size = std::max(patch_size(preset, area), 1e-15);
    const double leap = smooth_step(glm::length(moved.hair - moved.hand) / size / kLeap);
    // Spines that leapt went each along its own path: none goes with their mean.
    const double with_hair = stamp.leapt ? 0 : std::max(leap, static_cast<double>(stamp.separation));
    stamp.motion.shift = glm::mix(moved.hand, moved.hair, with_hair);
    // Dry hair leaves ink by how it is drawn: where it only comes to touch, a tip that leans would print a speck that
    // its stroke, which begins where it has been pressed aside, does not reach.
    const bool prints = motion_.contact_travel >= kPrintTravel;
    stamp.ds = prints ? path_.spacing : (1 - static_cast<double>(stamp.separation)) * path_.spacing;
    if (brush::is_foam(preset)) {
        const double slides = std::min(stamp.ds, glm::length(moved.hair));
        stamp.slides = stamp.ds > 0 ? slides / stamp.ds : 0;
        stamp.ds += (kSlidingFoam - 1) * slides;
    }
    // An edge that slips away under a press draws by its own path, which is longer than the hand's.
    if (brush::has_broad_side(preset)) stamp.ds = std::max(stamp.ds, with_hair * glm::length(stamp.motion.shift));
    if (stamp.leapt && !stamp.by_hair) stamp.ds = std::max(stamp.ds, glm::length(moved.hair));
}

namespace {

// Part of the grain that texels show: cells, half a texel, from 0.5 to 1.25 of its length, as at the edge.
float grain_seen(const ClosedHairOptions& options) {
    return static_cast<float>(smooth_step((1.25 - options.cell / options.grain.length) / 0.75));
}

}  // namespace

ink::DepositParams StrokeSession::deposit_from(const ink::Reservoir& tuft, const Stamp& stamp, double area) const {
    const ink::StampContact contact{
        .moment_factor = tuft_.stress(),
        .width = hair_.closed_area() > 0 ? area / std::sqrt(hair_.closed_area()) : std::sqrt(area),
        .area = area * static_cast<double>(deposit_->stamps_per_batch()),
        .pending = deposit_->pending(),
        .by_hair = static_cast<double>(stamp.separation),
        .cells = hair_.cells()};
    return ink::stamp_deposit(tuft, tuft_.ink, contact, input_.substrate);
}

void StrokeSession::set_ink(Stamp& stamp, double area) const {
    stamp.ink = deposit_from(tuft_.brush.reservoir, stamp, area);
    // What a pressed sponge does not hold comes out with its film, unless it slides on.
    if (brush::is_foam(tuft_.preset()) && area > 0)
        stamp.ink.target +=
            static_cast<float>(std::max(0.0, 1 - stamp.slides / kSlidesOn) *
                               std::max(0.0, ink::excess(tuft_.brush.reservoir) - deposit_->pending()) / area);
    // Ink stands in the grain, where hair that lies apart does not keep to its hills.
    if (hair_.options().tones)
        stamp.grain_share =
            (1 - stamp.separation) * grain_seen(hair_.options().closed) *
            ink::grain_share(hair_.options().closed.grain.relief, static_cast<double>(stamp.ink.target));
    stamp.ink.capacity = std::max(input_.substrate.capacity, static_cast<float>(ink::standing_film(tuft_.ink.yield)));
}

void StrokeSession::note_dryness(const Stamp& stamp, double area, double closed, double displacement) {
    constexpr double kDry = 0.6;        // of a full film: what is paler looks torn
    constexpr double kSpent = 0.9;      // of what the brush gave at first: a light or a small one is pale when full
    constexpr double kWetAgain = 5e-3;  // metres of full film after which a stroke is no longer dry
    Dryness& dryness = report_.dryness;
    report_.path += displacement;
    const auto film = static_cast<double>(stamp.ink.target);
    const auto is_spent = [&] {
        return film < kSpent * static_cast<double>(deposit_from(ink_at_start_, stamp, area).target);
    };
    if (film * closed < kDry * tuft_.ink.film && is_spent()) {
        if (dryness.from < 0) dryness.from = report_.path;
        dryness.path += displacement;
        wet_from_ = report_.path;
    } else if (report_.path - wet_from_ > kWetAgain) {
        dryness.from = -1;
        dryness.path = 0;
    }
}

void StrokeSession::step(const brush::Pose& pose) {
    report(progress_.ask, "painting", progress_.done);
    const double dt = path_.started ? pose.time - path_.time : 0.0;
    const contact::Result contact = bend_on_surface(pose, dt);
    if (!touches(contact)) return motion_.lose_contact();
    if (!contact.tuft.converged) ++report_.unconverged;

    const ContactMotion moved = motion_.advance(pose, contact, dt);
    deposit_->settle(tuft_, hair_.by_hair());
    Stamp stamp = hair_.make_stamp(tuft_, contact, std::move(contact_.hair), motion_, dt);
    const double hair_area = covered_area(stamp.footprint);
    stencil_.cut_off(stamp.footprint);
    if (stamp.footprint.empty()) return motion_.lose_contact();
    motion_.keep_contact(pose);
    const double area = stencil_.empty() ? hair_area : covered_area(stamp.footprint);
    if (!stencil_.empty() && !(area > 0)) return;

    ++report_.stamps;
    set_motion(stamp, moved, area);
    set_ink(stamp, area);
    note_dryness(stamp, area, hair_.coverage(hair_area), glm::length(moved.hand));
    report_.ink_given +=
        deposit_->deposit(std::move(stamp), tuft_,
                          {.hair = hair_,
                           .motion = motion_,
                           .stress = tuft_.stress(),
                           .normal_force = std::abs(glm::dot(contact.tuft.force, contact.frame.n)),
                           .drain = tuft_.drain(pose, contact.frame.origin, input_.stroke.settings.down)});
}

// Linear in path between the poses to both sides of each sample.
std::vector<ForceRecord> StrokeSession::forces_at_samples() const {
    const std::vector<double> places = path_.resampler.places();
    const std::vector<ForceRecord>& poses = forces_.poses;
    const std::size_t own = input_.stroke.trace.samples.size();
    std::vector<ForceRecord> records;
    if (poses.empty()) return records;
    const std::size_t last = poses.size() - 1;
    for (std::size_t i = forces_.before_first; i < std::min(forces_.before_first + own, places.size()); ++i) {
        const std::size_t k = std::min(static_cast<std::size_t>(places[i]), last), next = std::min(k + 1, last);
        const double from = static_cast<double>(k), to = next == last ? places.back() : static_cast<double>(next);
        const double part = to > from ? std::clamp((places[i] - from) / (to - from), 0.0, 1.0) : 1;
        const ForceRecord &a = poses[k], &b = poses[next];
        records.push_back({forces_.samples[i], glm::mix(a.force, b.force, part),
                           glm::mix(a.device_force, b.device_force, part), glm::mix(a.torque, b.torque, part),
                           std::lerp(a.moment, b.moment, part)});
    }
    return records;
}

std::unique_ptr<StrokeForecast> StrokeSession::forecast(std::span<const brush::Pose> poses) const {
    if (!StrokeForecast::serves(tuft_.brush.tuft) || wetness_of(tuft_.brush.reservoir) < 1) return nullptr;
    Path path(path_options());
    for (const brush::Pose& pose : poses) path.resampler.push(next_pose(path, pose), path.poses);
    path.resampler.finish(path.poses);
    return std::make_unique<StrokeForecast>(tuft_.brush.tuft, std::move(path.poses), input_.surface,
                                            StrokeForecast::Options{contact_.options, hair_.options().closed});
}

SessionResult StrokeSession::finish() {
    path_.resampler.finish(path_.poses);
    paint_poses();
    leave_forecast();
    report_.ink_given += deposit_->finish(tuft_, hair_, input_.seams);
    report_.ink_left = tuft_.brush.reservoir.remaining();
    report_.removed = deposit_->removed();
    if (report_.touched()) report_.nearest = 0;
    if (input_.record_forces) report_.forces = forces_at_samples();
    ink::compress(tuft_.brush.reservoir, 1);
    tuft_.brush.named = input_.stroke.ink;
    return {std::move(report_), std::move(tuft_.brush), target_.take_snapshots()};
}

}  // namespace tuft::stroke
