#include "stroke/document/fit.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/system/interrupt.h"
#include "core/system/parallel.h"
#include "stroke/drawing/follow_model.h"
#include "stroke/gesture/hand.h"
#include "stroke/placement/placement.h"
#include "stroke/placement/projection.h"

namespace tuft::stroke {
namespace {

constexpr double kPart = 0.1;          // of the path, that may be lost, buried or stretched
constexpr double kMost = 0.5;          // of the path: then no depth is worth telling
constexpr double kDepthPart = 0.5;     // of the depth, that it may change by
constexpr double kLeastChange = 2e-4;  // metres of depth that nobody sees
constexpr double kLeastMove = 1e-3,
                 kMovePart = 0.01;         // metres, and part of the path, that a place may move by
constexpr double kStretch = 1.25;          // times as long, or short
constexpr double kPiece = 5e-3;            // metres of path that are measured together
constexpr double kTooSmall = 0.25;         // times as large as the former model: a unit that was mistaken is less
constexpr double kTooLarge = 3;            // times as large as the model: a drawing
constexpr double kTouch = 1e-4;            // metres that a single touch counts as
constexpr double kRingStep = 2e-3;         // metres between points of a ring
constexpr double kAllRingPoints = 20'000;  // of all areas; where there are more, they are farther apart
constexpr double kLeastPoints = 16;        // of an area

bool is_painted(const JournalEntry& entry) {
    return entry.as<PaintStroke>() && !entry.hidden && !on_palette(entry);
}

const FlatArea* area_of(const JournalEntry& entry) {
    const Fill* fill = entry.as<Fill>();
    return fill && fill->area && !entry.hidden && !on_palette(entry) ? &*fill->area : nullptr;
}

std::string tenths(double value) {
    return fmt::format("{:.1f}", value);
}

std::string millimetres(double metres) {
    return fmt::format("{:.3g}", 1e3 * metres);
}

double median(std::vector<double> values) {
    if (values.empty()) return 0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

/// Where the ink of a sample lies on a model; nothing where it leaves none.
struct Place {
    std::optional<Vec3> was, is;
    bool buried = false;
    Vec3 hand{0};  ///< metres, of the sample: its steps are the path
    Vec3 gone{0};  ///< where it would lie now, on the surface or not
};

void add_places(StrokeFit& fit, const std::vector<Place>& places, const std::optional<ModelMotion>& motion) {
    std::vector<double> moved, slid;
    double piece = 0, now = 0;
    const double scale = motion ? motion->scale : 1;
    const auto end_piece = [&] {
        fit.common.former += piece;
        fit.common.revised += now;
        if (now > kStretch * piece || kStretch * now < piece) fit.common.stretched += piece;
        piece = now = 0;
    };
    for (std::size_t i = 0; i < places.size(); ++i) {
        const Place& p = places[i];
        if (!p.was) continue;
        const double step = std::max(kTouch / static_cast<double>(places.size()),
                                     i > 0 ? glm::distance(p.hand, places[i - 1].hand) : 0.0);
        fit.length += step;
        if (p.buried)
            fit.buried += step;
        else if (!p.is)
            fit.lost += step;
        if (p.is || fit.flat) {
            moved.push_back(glm::distance(p.gone, *p.was));
            if (motion) slid.push_back(glm::distance(p.gone, (*motion)(*p.was)));
        }
        if (i == 0 || !p.is || !places[i - 1].was || !places[i - 1].is) continue;
        piece += glm::distance(*p.was, *places[i - 1].was);
        now += glm::distance(*p.is, *places[i - 1].is) / scale;
        if (piece > kPiece) end_piece();
    }
    // What is left over is short: it says nothing of its own, but for a stroke that is all as
    // short.
    if (fit.common.former == 0 && piece > kTouch) end_piece();
    if (!moved.empty()) fit.moved.most = *std::ranges::max_element(moved);
    fit.moved.median = median(std::move(moved));
    if (!slid.empty()) fit.moved.on_model = median(std::move(slid));
}

/// One stroke on both models.
struct ComparedStroke {
    const JournalEntry &entry, &followed;
    double length = 0;                  // of the tuft on the former model, metres
    double points = 0;                  // of the rings of an area, about
    std::optional<ModelMotion> motion;  // of the model under it
    double scale() const { return motion ? motion->scale : 1; }
};

StrokeFit fit_in_space(const ComparedStroke& stroke, const Revision& r) {
    StrokeFit fit{.stroke = stroke.entry.id};
    std::vector<double> depths, changes;
    std::vector<Place> places;
    const std::vector<brush::Pose> before = spatial_poses(samples_of(stroke.entry)),
                                   after = spatial_poses(samples_of(stroke.followed));
    const double length = stroke.length, now_length = length * stroke.scale();
    for (std::size_t i = 0; i < before.size(); ++i) {
        const Vec3 mouth = before[i].position, axis = after[i].axis();
        Place& place = places.emplace_back();
        place.hand = mouth;
        const auto was = r.former.ray(mouth, before[i].axis(), 0, length);
        fit.reached = fit.reached || was || r.former.closest_point(mouth, length);
        if (!was) continue;
        place.was = was->position;
        const auto now = r.revised.ray(after[i].position - now_length * axis, axis, 0, 2 * now_length);
        if (!now) continue;
        place.buried = now->distance < now_length;
        if (place.buried) continue;
        place.is = place.gone = now->position;
        depths.push_back(length - was->distance);
        changes.push_back(was->distance - (now->distance - now_length) / stroke.scale());
    }
    add_places(fit, places, stroke.motion);
    fit.depth = median(std::move(depths));
    fit.deeper = median(std::move(changes));
    return fit;
}

/// A point of an area's rings.
struct RingPoint {
    std::size_t ring = 0, edge = 0;
    double part = 0;  // of the edge
};

/// Points so many metres apart, or farther where that would be more than about `most`.
std::vector<RingPoint> ring_points(const FlatArea& area, double most) {
    const auto length_of = [](const std::vector<Vec2>& ring, std::size_t i) {
        return glm::distance(ring[i], ring[(i + 1) % ring.size()]);
    };
    double whole = 0;
    for (const std::vector<Vec2>& ring : area.rings)
        for (std::size_t i = 0; i < ring.size(); ++i) whole += length_of(ring, i);
    const double step = std::max(kRingStep, whole / most);
    std::vector<RingPoint> points;
    for (std::size_t r = 0; r < area.rings.size(); ++r) {
        const std::vector<Vec2>& ring = area.rings[r];
        double left = 0;  // to the next point
        for (std::size_t i = 0; i < ring.size(); ++i) {
            const double length = length_of(ring, i);
            double at = left;
            for (; at < length; at += step) points.push_back({r, i, at / length});
            left = at - length;
        }
        if (!ring.empty()) points.push_back({r, ring.size() - 1, 1});
    }
    return points;
}

StrokeSamples trace_through(const FlatArea& area, const std::vector<RingPoint>& points) {
    StrokeSamples trace{.flat = true, .placement = area.placement};
    for (std::size_t k = 0; k < points.size(); ++k) {
        const std::vector<Vec2>& ring = area.rings[points[k].ring];
        const Vec2 p = glm::mix(ring[points[k].edge], ring[(points[k].edge + 1) % ring.size()], points[k].part);
        const bool is_first = k == 0 || points[k - 1].ring != points[k].ring;
        trace.samples.push_back(
            {.time = static_cast<double>(k), .position = Vec3(p, 0), .pressure = is_first ? 0.0 : 1.0});
    }
    return trace;
}

StrokeFit fit_flat(const ComparedStroke& stroke, const Revision& r) {
    const FlatArea* area = area_of(stroke.entry);
    StrokeFit fit{.stroke = stroke.entry.id, .area = area != nullptr, .flat = true};
    StrokeSamples trace, followed;
    if (area) {
        const std::vector<RingPoint> points = ring_points(*area, stroke.points);
        trace = trace_through(*area, points);
        followed = trace_through(*area_of(stroke.followed), points);
    } else {
        const auto steadied = [](const JournalEntry& entry) {
            const PaintStroke& s = *entry.as<PaintStroke>();
            return steady(s.trace, s.settings);
        };
        trace = steadied(stroke.entry);
        followed = steadied(stroke.followed);
    }
    SurfaceTrace was = map_to_surface(r.former, trace), now = map_to_surface(r.revised, followed);
    leave_other_sheets(r.former, trace, was);
    leave_other_sheets(r.revised, followed, now);
    std::vector<Place> places(std::min(was.samples.size(), now.samples.size()));
    for (std::size_t i = 0; i < places.size(); ++i) {
        Place& place = places[i];
        place.hand = Vec3(trace.samples[i].position.x, trace.samples[i].position.y, 0);
        place.gone = now.samples[i].position;
        if (!(trace.samples[i].pressure > 0) || !was.samples[i].on_surface) continue;
        fit.reached = true;
        place.was = was.samples[i].position;
        if (now.samples[i].on_surface) place.is = place.gone;
    }
    add_places(fit, places, stroke.motion);
    return fit;
}

/// Whether a stroke or an area lies elsewhere than before, or is larger.
bool is_followed(const JournalEntry& entry, const JournalEntry& followed) {
    if (const FlatArea* area = area_of(entry)) {
        const FlatArea& now = *area_of(followed);
        return !(area->placement == now.placement) || area->rings != now.rings;
    }
    const StrokeSamples &a = samples_of(entry), &b = samples_of(followed);
    if (a.flat && !(a.placement == b.placement)) return true;
    return !std::ranges::equal(a.samples, b.samples, {}, &StrokeSample::position, &StrokeSample::position);
}

/// The brush of one of these whose tuft is longer than `most`, and that length.
std::optional<std::pair<std::string, double>> longer_than(double most, const std::vector<JournalEntry>& entries,
                                                          const std::function<double(const std::string&)>& length_of) {
    for (const JournalEntry& entry : entries) {
        if (!is_painted(entry)) continue;
        if (const double length = length_of(brush_of(entry)); length > most) return {{brush_of(entry), length}};
    }
    return {};
}

/// Bounds of the flat strokes where they are placed, before they are mapped to the surface.
Box placed_bounds(const std::vector<JournalEntry>& entries) {
    Box bounds;
    for (const JournalEntry& entry : entries) {
        if (!is_painted(entry) || !samples_of(entry).flat) continue;
        const Placement& p = samples_of(entry).placement;
        for (const StrokeSample& s : samples_of(entry).samples)
            bounds.add(p.origin + s.position.x * p.right + s.position.y * p.down);
    }
    return bounds;
}

/// The same of areas.
Box bounds_of_areas(const std::vector<JournalEntry>& entries) {
    Box bounds;
    for (const JournalEntry& entry : entries) {
        const FlatArea* area = area_of(entry);
        if (!area) continue;
        const Placement& p = area->placement;
        for (const std::vector<Vec2>& ring : area->rings)
            for (const Vec2& at : ring) bounds.add(p.origin + at.x * p.right + at.y * p.down);
    }
    return bounds;
}

}  // namespace

Message size_fault(const std::vector<JournalEntry>& entries, const std::function<double(const std::string&)>& length_of,
                   const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised) {
    const double before = former.mesh().bounds.diagonal(), now = revised.mesh().bounds.diagonal();
    if (now >= kTooSmall * before) return {};
    const auto longer = longer_than(now, entries, length_of);
    if (!longer) return {};
    return Message(
        "it is {} mm across, the former model {} mm; the tuft of {} is {} mm long, and no stroke fits; is its unit "
        "another one?",
        millimetres(now), millimetres(before), longer->first, millimetres(longer->second));
}

Message size_fault(const std::vector<JournalEntry>& entries, const std::function<double(const std::string&)>& length_of,
                   const mesh::SurfaceQuery& model) {
    const Box drawing = placed_bounds(entries);
    const double across = model.mesh().bounds.diagonal();
    if (drawing.empty() || across >= kTooSmall * drawing.diagonal()) return {};
    const auto longer = longer_than(across, entries, length_of);
    if (!longer) return {};
    return Message(
        "it is {} mm across, the strokes {} mm; the tuft of {} is {} mm long, and most of them meet no surface; is its "
        "unit another one?",
        millimetres(across), millimetres(drawing.diagonal()), longer->first, millimetres(longer->second));
}

Message size_doubt(const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised) {
    const double before = former.mesh().bounds.diagonal(), now = revised.mesh().bounds.diagonal();
    if (now >= kTooSmall * before && kTooSmall * now <= before) return {};
    return Message("the revised model is {} mm across, the former one {} mm; is its unit another one?",
                   millimetres(now), millimetres(before));
}

Message size_doubt(const std::vector<JournalEntry>& entries, const mesh::SurfaceQuery& model) {
    Box drawing = placed_bounds(entries);
    const Box areas = bounds_of_areas(entries);
    if (!areas.empty()) drawing.add(areas.lo), drawing.add(areas.hi);
    const double across = model.mesh().bounds.diagonal();
    if (drawing.empty() || kTooLarge * across >= drawing.diagonal()) return {};
    return Message(
        "the model is {} mm across, the drawing {} mm, and most of it meets no surface; is its unit another one?",
        millimetres(across), millimetres(drawing.diagonal()));
}

StrokeSamples ring_samples(const FlatArea& area, double most) {
    return trace_through(area, ring_points(area, most));
}

std::vector<StrokeFit> compare_fit(const std::vector<JournalEntry>& entries, const std::vector<JournalEntry>& followed,
                                   const std::function<double(const std::string&)>& length_of,
                                   const Revision& revision) {
    const auto n_areas = std::ranges::count_if(entries, [](const JournalEntry& e) { return area_of(e) != nullptr; });
    const double points = std::clamp(kAllRingPoints / std::max(1.0, double(n_areas)), kLeastPoints, kMostRingPoints);
    std::vector<ComparedStroke> compared;
    for (std::size_t i = 0; i < entries.size(); ++i)  // here: presets are loaded one at a time
        if (is_painted(entries[i]))
            compared.push_back({entries[i], followed[i], length_of(brush_of(entries[i])), 0, {}});
        else if (area_of(entries[i]))
            compared.push_back({entries[i], followed[i], 0, points, {}});
    std::vector<StrokeFit> fits(compared.size());
    parallel_for(compared.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            check_interrupt();
            ComparedStroke& stroke = compared[i];
            const FlatArea* area = area_of(stroke.entry);
            const bool flat = area || samples_of(stroke.entry).flat;
            if (!revision.change.none())
                stroke.motion = motion_of(area ? ring_samples(*area, points) : samples_of(stroke.entry),
                                          revision.change, revision.former);
            fits[i] = flat ? fit_flat(stroke, revision) : fit_in_space(stroke, revision);
            fits[i].followed = is_followed(stroke.entry, stroke.followed);
        }
    });
    return fits;
}

Message mismatch_reason(const StrokeFit& fit) {
    if (fit.length <= 0) return {};
    const auto percent = [&](double part) { return static_cast<int>(std::lround(100 * part / fit.length)); };
    const double far = std::max(kLeastMove, kMovePart * fit.length);
    std::vector<Message> reasons;
    // A place in space is the hand's: it moves along the hair only, which the depth shows.
    if (fit.flat && !fit.followed && fit.moved.median > far)
        reasons.push_back(Message("lies {} mm from where it lay", tenths(1e3 * fit.moved.median)));
    if (fit.moved.on_model && *fit.moved.on_model > far)
        reasons.push_back(Message("lies {} mm from its place on the model", tenths(1e3 * *fit.moved.on_model)));
    const bool sank = std::abs(fit.deeper) > std::max(kLeastChange, kDepthPart * fit.depth);
    // A surface that sank loses the light ends of a stroke too: that it sank says more.
    const double least = (sank ? kMost : kPart) * fit.length;
    if (fit.lost > least && fit.lost >= fit.buried)
        reasons.push_back(Message("{} % of it touches nothing", percent(fit.lost)));
    else if (fit.buried > least)
        reasons.push_back(Message("{} % of it lies inside the model", percent(fit.buried)));
    else if (sank)
        reasons.push_back(Message(fit.deeper > 0 ? "pressed {} mm deeper" : "pressed {} mm less deep",
                                  tenths(1e3 * std::abs(fit.deeper))));
    if (fit.common.stretched > kPart * fit.length)
        reasons.push_back(
            Message("{} % of it is stretched or squeezed by more than a quarter", percent(fit.common.stretched)));
    return join(reasons);
}

std::vector<StrokeMismatch> find_mismatches(const std::vector<StrokeReport>& reports,
                                            const std::vector<StrokeFit>& fits) {
    std::vector<StrokeMismatch> found;
    for (const StrokeReport& report : reports) {
        const auto fit =
            std::find_if(fits.begin(), fits.end(), [&](const StrokeFit& f) { return f.stroke == report.stroke_id; });
        Message reason;
        if (fit != fits.end() && (report.touched() || !fit->reached))
            reason = mismatch_reason(*fit);
        else if (!report.touched())
            reason = Message("touches nothing, {} mm away", tenths(1e3 * report.nearest));
        if (!reason.empty()) found.push_back({report.stroke_id, std::move(reason)});
    }
    for (const StrokeFit& fit : fits) {
        if (!fit.area) continue;
        if (Message reason = mismatch_reason(fit); !reason.empty())
            found.push_back({fit.stroke, std::move(reason), true});
    }
    return found;
}

FitTotal total_of(const std::vector<StrokeFit>& fits, const std::vector<StrokeMismatch>& mismatches) {
    FitTotal total{.strokes = fits.size(), .mismatches = mismatches.size()};
    std::vector<double> moved, slid;
    double length = 0, missing = 0, stretched = 0;
    for (const StrokeFit& fit : fits) {
        total.areas |= fit.area;
        if (!(fit.length > 0)) continue;
        moved.push_back(fit.moved.median);
        if (fit.moved.on_model) slid.push_back(*fit.moved.on_model);
        total.moved.most = std::max(total.moved.most, fit.moved.most);
        length += fit.length;
        missing += fit.lost + fit.buried;
        stretched += fit.common.stretched;
    }
    total.moved.median = median(std::move(moved));
    if (!slid.empty()) total.moved.on_model = median(std::move(slid));
    if (length > 0) total.missing = missing / length, total.stretched = stretched / length;
    return total;
}

Message describe(const FitTotal& t) {
    const Message on_model = t.moved.on_model
                                 ? Message(" and {} mm from their places on the model", tenths(1e3 * *t.moved.on_model))
                                 : Message();
    return Message(
        t.areas
            ? "{} of {} strokes and areas no longer fit: they lie {} mm from where they lay ({} mm at most){}, {} % of "
              "their ink is missing, {} % of it is stretched or squeezed by more than a quarter"
            : "{} of {} strokes no longer fit: they lie {} mm from where they lay ({} mm at most){}, {} % of their ink "
              "is "
              "missing, {} % of it is stretched or squeezed by more than a quarter",
        t.mismatches, t.strokes, tenths(1e3 * t.moved.median), tenths(1e3 * t.moved.most), on_model,
        std::lround(100 * t.missing), std::lround(100 * t.stretched));
}

}  // namespace tuft::stroke
