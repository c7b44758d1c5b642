#include "cli/commands/revision.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "cli/steps/picture_overlay.h"
#include "core/system/parallel.h"
#include "core/text/units.h"
#include "stroke/drawing/follow_model.h"
#include "stroke/drawing/follow_names.h"
#include "stroke/gesture/hand.h"
#include "stroke/placement/placement.h"

namespace tuft::cli {
namespace {

constexpr std::size_t kNamedParts = 5;       // in messages
constexpr double kLeastSeen = 0.05e-3;       // metres: less is no change
constexpr double kMostSeen = 10e-3;          // metres: more has the same colour
constexpr double kTint = 0.75;               // part of the colour at a change
constexpr double kSearched = 5 * kMostSeen;  // metres that a changed surface is searched within

stroke::MotionFreedom freedom_of(const Replay& a) {
    return a.follow == "stretch" ? stroke::MotionFreedom::affine : stroke::MotionFreedom::similarity;
}

/// Colours of a distance: yellow, orange, red, violet at 0.05, 0.3, 1.7 and 10 mm; linear between in its logarithm.
Vec3 colour_of(double distance) {
    static const Vec3 kColours[] = {render::linear_colour(255, 236, 140), render::linear_colour(255, 160, 40),
                                    render::linear_colour(220, 40, 40), render::linear_colour(120, 0, 140)};
    const double at = std::clamp(std::log(distance / kLeastSeen) / std::log(kMostSeen / kLeastSeen), 0.0, 1.0) * 3;
    const int i = std::min(2, static_cast<int>(at));
    return glm::mix(kColours[i], kColours[i + 1], at - i);
}

/// Distances of a revised surface from the former one, each part moved as it moved.
class Deviation {
  public:
    Deviation(const stroke::ModelChange& change, const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised)
        : former_(former) {
        const mesh::TriangleMesh& mesh = revised.mesh();
        for (const std::string& name : mesh.group_names) motions_.push_back(change.of(name));
        if (mesh.triangle_groups.empty()) motions_ = {change.of("")};
    }
    double at(const mesh::TriangleMesh& mesh, std::uint32_t triangle, const Vec3& p) const {
        const stroke::ModelMotion& motion = motions_[mesh.triangle_groups.empty() ? 0 : mesh.triangle_groups[triangle]];
        const auto hit = former_.closest_point(motion.back(p), kSearched / motion.scale);
        return hit ? motion.scale * hit->distance : kSearched;
    }

  private:
    const mesh::SurfaceQuery& former_;
    std::vector<stroke::ModelMotion> motions_;
};

void tint(render::Image& image, const render::Camera& camera, const mesh::SurfaceQuery& revised,
          const Deviation& deviation) {
    parallel_for(static_cast<std::size_t>(image.height), 8, [&](std::size_t begin, std::size_t end) {
        for (std::size_t y = begin; y < end; ++y)
            for (int x = 0; x < image.width; ++x) {
                const Vec3 direction = render::ray_direction(camera, x + 0.5, static_cast<double>(y) + 0.5);
                const auto hit = revised.ray(camera.eye, direction);
                if (!hit) continue;
                const double distance = deviation.at(revised.mesh(), hit->triangle, hit->position);
                if (distance < kLeastSeen) continue;
                const Vec3 colour = colour_of(distance);
                std::uint8_t* pixel = &image.rgb[3 * (y * static_cast<std::size_t>(image.width) + x)];
                // As a transparent ink over the picture: light, shade and strokes stay visible.
                for (int k = 0; k < 3; ++k)
                    pixel[k] = static_cast<std::uint8_t>(
                        std::lround(pixel[k] * std::pow(1 - kTint + kTint * colour[k], 1 / 2.2)));
            }
    });
}

std::vector<SurfacePath> ink_of(const stroke::JournalEntry& entry, const mesh::SurfaceQuery& surface, double length) {
    std::vector<SurfacePath> paths(1);
    const auto add = [&](const Vec3& p, const Vec3& n) {
        paths.back().points.push_back(p);
        paths.back().normals.push_back(n);
    };
    const auto add_flat = [&](const stroke::StrokeSamples& trace) {
        for (const stroke::SurfaceSample& s : stroke::map_to_surface(surface, trace).samples)
            if (s.on_surface && s.pressure > 0)
                add(s.position, s.normal);
            else if (!paths.back().points.empty())
                paths.emplace_back();
        return paths;
    };
    if (const stroke::Fill* fill = entry.as<stroke::Fill>()) return add_flat(stroke::ring_samples(fill->area.value()));
    const stroke::PaintStroke& stroke = entry.get<stroke::PaintStroke>();
    if (stroke.trace.flat) return add_flat(stroke::steady(stroke.trace, stroke.settings));
    for (const brush::Pose& pose : stroke::spatial_poses(stroke.trace))
        if (const auto hit = surface.ray(pose.position, pose.axis(), 0, length))
            add(hit->position, hit->normal);
        else if (!paths.back().points.empty())
            paths.emplace_back();
    return paths;
}

void draw_legend(PictureOverlay& overlay, const render::Image& image) {
    const double height = std::max(10.0, image.height / 48.0), width = 0.25 * image.width;
    const Vec2 corner(height, image.height - 2.6 * height);
    constexpr int kSteps = 60;
    const auto at = [&](double distance) {
        return width * std::log(distance / kLeastSeen) / std::log(kMostSeen / kLeastSeen);
    };
    for (int i = 0; i < kSteps; ++i) {
        const double x = width * i / kSteps;
        const double distance = kLeastSeen * std::pow(kMostSeen / kLeastSeen, (i + 0.5) / kSteps);
        overlay.fill(corner + Vec2(x, 0), corner + Vec2(x + width / kSteps + 0.5, height), colour_of(distance));
    }
    for (const double mm : {0.1, 1.0, 10.0})
        overlay.draw_text(fmt::format("{:g}", mm), corner + Vec2(at(mm * kMillimetre) - 0.4 * height, 2.2 * height),
                          0.8 * height, Vec3(0));
    overlay.draw_text("MM", corner + Vec2(width + 1.4 * height, 2.2 * height), 0.8 * height, Vec3(0));
}

nlohmann::json to_json(const stroke::StrokeFit& f) {
    nlohmann::json j{{"stroke", f.stroke},
                     {"path_mm", f.length / kMillimetre},
                     {"moved_mm", f.moved.median / kMillimetre},
                     {"moved_most_mm", f.moved.most / kMillimetre},
                     {"missing", f.missing()},
                     {"stretched", f.length > 0 ? f.common.stretched / f.length : 0},
                     {"length_factor", f.common.former > 0 ? f.common.revised / f.common.former : 1},
                     {"followed", f.followed}};
    if (f.area) j["area"] = true;
    if (f.moved.on_model) j["moved_on_model_mm"] = *f.moved.on_model / kMillimetre;
    if (!f.flat) j["deeper_mm"] = f.deeper / kMillimetre;
    return j;
}

nlohmann::json to_json(const stroke::ModelMotion& motion) {
    const Vec3 shift = stroke::shift_of(motion) / kMillimetre;
    return {{"shift_mm", {shift.x, shift.y, shift.z}},
            {"turn_deg", stroke::turn_of(motion) / kDegree},
            {"scale", motion.scale}};
}

std::function<double(const std::string&)> lengths_of(stroke::Document& painting) {
    return [&painting](const std::string& brush) { return painting.materials().brush(brush).length; };
}

}  // namespace

const mesh::SurfaceQuery& former_surface(const Replay& a, const OpenProject& project,
                                         const stroke::Document& painting) {
    return a.model.empty() ? *painting.model().query : *project.model.query;
}

RevisedStrokes replay_strokes(const Replay& a, const OpenProject& project, stroke::Document& painting) {
    RevisedStrokes out{.change = {}, .former = project.file.strokes(), .followed = {}, .notes = {}};
    for (stroke::JournalEntry& s : out.former) {
        if (!a.brush.empty()) stroke::set_brush(s, a.brush);
        if (!a.ink.empty()) stroke::set_ink(s, a.ink);
    }
    find_presets(painting, out.former);
    const mesh::SurfaceQuery &former = former_surface(a, project, painting), &revised = *painting.model().query;
    if (!a.model.empty()) {
        auto named = stroke::follow_names(std::move(out.former), *project.model.mesh, revised.mesh());
        out.former = std::move(named.entries);
        out.notes = std::move(named.notes);
        const Message fault = stroke::size_fault(out.former, lengths_of(painting), former, revised);
        if (!fault.empty()) throw Error(a.model.string(), Message("{} (see --unit)", fault));
        if (const Message doubt = stroke::size_doubt(former, revised); !doubt.empty())
            out.notes.push_back(Message("{} (see --unit)", doubt));
        out.change = stroke::find_change(former, revised, freedom_of(a));
    }
    out.followed = out.former;
    if (a.model.empty() || a.follow == "none") return out;
    out.followed = stroke::follow_model(out.former, out.change, former);
    find_presets(painting, out.followed);
    if (!a.pull_back) return out;
    for (std::size_t i = 0; i < out.former.size(); ++i) {
        const stroke::PaintStroke* stroke = out.former[i].as<stroke::PaintStroke>();
        if (!stroke || stroke->trace.flat || stroke::on_palette(out.former[i])) continue;
        out.followed[i] = stroke::pull_onto(out.former[i], out.followed[i],
                                            painting.materials().brush(stroke->brush).length, former, revised);
    }
    return out;
}

Fit find_fit(const Replay& a, const RevisedStrokes& strokes, stroke::Document& painting,
             const mesh::SurfaceQuery& former, const std::vector<stroke::StrokeReport>& reports) {
    Fit fit;
    if (!a.model.empty())
        fit.fits = stroke::compare_fit(strokes.former, strokes.followed, lengths_of(painting),
                                       {former, *painting.model().query, strokes.change});
    fit.mismatches = stroke::find_mismatches(reports, fit.fits);
    fit.total = stroke::total_of(fit.fits, fit.mismatches);
    return fit;
}

void note_fit(const Replay& a, const RevisedStrokes& strokes, const Fit& fit, Console& console) {
    for (const stroke::StrokeMismatch& m : fit.mismatches)
        console.note(
            fmt::format("warning: {} {} no longer fits: {}", m.area ? "area" : "stroke", m.stroke, m.reason.text()));
    for (const Message& note : strokes.notes) console.note("warning: " + note.text());
    const stroke::ModelChange& change = strokes.change;
    if (change.whole)
        console.note("warning: the revised model is the former one " + stroke::describe(*change.whole).text());
    for (std::size_t i = 0; i < std::min(kNamedParts, change.parts.size()); ++i)
        console.note(fmt::format("warning: the part '{}' is {}", change.parts[i].name,
                                 stroke::describe(change.parts[i].motion).text()));
    if (change.parts.size() > kNamedParts)
        console.note(fmt::format("warning: {} more parts moved", change.parts.size() - kNamedParts));
    if (!change.none())
        console.note(a.follow == "none" ? "warning: the strokes stay where they were; --follow parts moves them along"
                                        : "the strokes follow the model; --follow none leaves them where they were");
    if (!fit.mismatches.empty() && !fit.fits.empty()) console.note("warning: " + stroke::describe(fit.total).text());
}

nlohmann::json to_json(const RevisedStrokes& strokes, const Fit& fit) {
    nlohmann::json list = nlohmann::json::array(), parts = nlohmann::json::array();
    for (const stroke::StrokeFit& f : fit.fits) list.push_back(to_json(f));
    nlohmann::json j{{"strokes", std::move(list)},
                     {"mismatches", fit.total.mismatches},
                     {"moved_mm", fit.total.moved.median / kMillimetre},
                     {"moved_most_mm", fit.total.moved.most / kMillimetre},
                     {"missing", fit.total.missing},
                     {"stretched", fit.total.stretched}};
    j["misfits"] = j["mismatches"];  // its name before
    if (fit.total.moved.on_model) j["moved_on_model_mm"] = *fit.total.moved.on_model / kMillimetre;
    if (strokes.change.whole) j["model"] = to_json(*strokes.change.whole);
    for (const stroke::PartMotion& part : strokes.change.parts) {
        parts.push_back(to_json(part.motion));
        parts.back()["name"] = part.name;
    }
    j["parts"] = std::move(parts);
    return j;
}

void write_revision_picture(const Replay& arguments, const RevisedStrokes& strokes, const Fit& fit,
                            const stroke::Document& painting, const mesh::SurfaceQuery& former, Console& console) {
    const stroke::Model& model = painting.model();
    render::Image image = draw_picture({.model = model, .painting = &painting, .view = arguments.view}, console);
    const render::Camera camera = camera_of(arguments.view, *model.mesh);
    tint(image, camera, *model.query, Deviation(strokes.change, former, *model.query));
    PictureOverlay overlay(image, camera, *model.query);
    const Vec3 red = render::linear_colour(220, 0, 30);
    for (const stroke::JournalEntry& entry : strokes.followed) {
        const bool fits =
            std::ranges::none_of(fit.mismatches, [&](const stroke::StrokeMismatch& m) { return m.stroke == entry.id; });
        if (fits) continue;
        const bool is_stroke = entry.as<stroke::PaintStroke>() != nullptr;
        const double length = is_stroke ? painting.materials().brush(stroke::brush_of(entry)).length : 0;
        const std::vector<SurfacePath> paths = ink_of(entry, *model.query, length);
        for (const SurfacePath& line : paths) overlay.draw(line, 2, red);
        if (!paths[0].points.empty())
            overlay.draw_number(static_cast<int>(entry.id), paths[0].points[0], paths[0].normals[0], 14, red);
    }
    draw_legend(overlay, image);
    image.rgb = overlay.rgb();
    write_picture(arguments.moved, image);
}

}  // namespace tuft::cli
