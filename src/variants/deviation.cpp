#include "variants/deviation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/random.h"
#include "core/text/units.h"
#include "stroke/drawing/drawing.h"

namespace tuft::variants {
namespace {

using std::numbers::pi;

constexpr std::size_t kWaves = 48;
constexpr double kLeastScale = 0.1;

/// Counters of the numbers of a deviation.
enum Number : std::uint64_t { kShift = 0, kTurn = 3, kScale = 6, kStrokes = 100 };

/// What all strokes have in common.
struct Rigid {
    Vec3 shift{0}, turn{0};  // metres; radians
    double scale = 1;
};

Rigid draw_rigid(const Tolerance& t, std::uint64_t seed) {
    Rigid r;
    for (std::uint64_t i = 0; i < 3; ++i) {
        r.shift[static_cast<int>(i)] = t.shift_mm * kMillimetre * normal_number(seed, kShift + i);
        r.turn[static_cast<int>(i)] = t.turn_deg * kDegree * normal_number(seed, kTurn + i);
    }
    r.scale = std::max(kLeastScale, 1 + t.scale * normal_number(seed, kScale));
    return r;
}

Quat rotation_of(const Vec3& vector) {
    const double angle = glm::length(vector);
    return angle > 0 ? glm::angleAxis(angle, vector / angle) : Quat(1, 0, 0, 0);
}

void turn_placement(stroke::Placement& p, double angle) {
    const Vec3 normal = glm::cross(p.right, p.down);
    if (!(glm::length(normal) > 0)) return;
    const Quat turn = glm::angleAxis(angle, glm::normalize(normal));
    p.right = turn * p.right;
    p.down = turn * p.down;
}

void move_flat(stroke::StrokeSamples& trace, const Rigid& r) {
    turn_placement(trace.placement, r.turn.z);
    const double width = trace.line_width;
    std::vector<double> times;
    for (const stroke::StrokeSample& s : trace.samples) times.push_back(s.time);
    stroke::transform_samples(trace, -Vec2(r.shift) / r.scale, r.scale);
    for (std::size_t i = 0; i < times.size(); ++i) trace.samples[i].time = times[i];
    trace.line_width = width;
}

void move_in_space(stroke::StrokeSamples& trace, const Rigid& r, const Vec3& centre) {
    const Quat turn = rotation_of(r.turn);
    for (stroke::StrokeSample& s : trace.samples) {
        s.position = centre + turn * (s.position - centre) + r.shift;
        s.rotation = turn * s.rotation;
    }
}

void shake_hand(stroke::StrokeSamples& trace, const Tolerance& t, std::uint64_t seed) {
    const int axes = trace.flat ? 2 : 3;
    std::vector<RandomDeviation> wander;
    wander.reserve(static_cast<std::size_t>(axes));
    for (int i = 0; i < axes; ++i)
        wander.emplace_back(t.hand_mm * kMillimetre, t.hand_length_mm * kMillimetre,
                            hash_bits(seed, static_cast<std::uint64_t>(i)));
    const double press = std::max(0.0, 1 + t.pressure * normal_number(seed, 3));
    double path = 0;
    Vec3 before = trace.samples.empty() ? Vec3(0) : trace.samples.front().position;
    for (stroke::StrokeSample& s : trace.samples) {
        path += glm::length(s.position - before);
        before = s.position;
        for (int i = 0; i < axes; ++i) s.position[i] += wander[static_cast<std::size_t>(i)].at(path);
        s.pressure = std::min(1.0, press * s.pressure);
    }
}

/// The middle of the box of all strokes in space.
Vec3 middle_in_space(const std::vector<stroke::JournalEntry>& entries) {
    Box box;
    for (const stroke::JournalEntry& e : entries)
        if (const auto* s = e.as<stroke::PaintStroke>(); s && !s->trace.flat && !stroke::on_palette(e))
            for (const stroke::StrokeSample& sample : s->trace.samples) box.add(sample.position);
    return box.empty() ? Vec3(0) : box.centre();
}

}  // namespace

double normal_number(std::uint64_t seed, std::uint64_t counter) {
    const double u = 1 - uniform(seed, 2 * counter), v = uniform(seed, 2 * counter + 1);
    return std::sqrt(-2 * std::log(u)) * std::cos(2 * pi * v);
}

RandomDeviation::RandomDeviation(double spread, double length, std::uint64_t seed)
    : waves_(kWaves), amplitude_(spread * std::sqrt(2.0 / kWaves)) {
    for (std::size_t i = 0; i < kWaves; ++i)
        waves_[i] = {normal_number(seed, i) / length, 2 * pi * uniform(hash_bits(seed, 1), i)};
}

double RandomDeviation::at(double s) const {
    double sum = 0;
    for (const Wave& w : waves_) sum += std::cos(w.number * s + w.phase);
    return amplitude_ * sum;
}

void deviate(std::vector<stroke::JournalEntry>& entries, const Tolerance& tolerance, std::uint64_t seed) {
    const Rigid rigid = draw_rigid(tolerance, seed);
    const Vec3 middle = middle_in_space(entries);
    std::uint64_t number = kStrokes;
    for (stroke::JournalEntry& entry : entries) {
        stroke::PaintStroke* s = entry.as<stroke::PaintStroke>();
        if (!s || stroke::on_palette(entry)) continue;
        if (s->trace.flat)
            move_flat(s->trace, rigid);
        else
            move_in_space(s->trace, rigid, middle);
        shake_hand(s->trace, tolerance, hash_bits(seed, number++));
    }
    for (stroke::FlatArea* area : stroke::areas_in(entries, true)) {
        turn_placement(area->placement, rigid.turn.z);
        stroke::transform_area(*area, -Vec2(rigid.shift) / rigid.scale, rigid.scale);
    }
}

}  // namespace tuft::variants
