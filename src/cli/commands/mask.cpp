#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/geometry/bounds.h"
#include "core/text/text.h"
#include "core/text/units.h"
#include "stroke/journal/tables.h"
#include "stroke/surface/mask_texels.h"

/// `tuft mask`: masks of a project, made and ended by entries of its journal.
namespace tuft::cli {
namespace {

std::vector<Vec2> polygon_of(const std::string& text) {
    std::vector<Vec2> polygon;
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        Vec2 p;
        const char* end = word.data() + word.size();
        const auto [comma, error] = std::from_chars(word.data(), end, p.x);
        const bool good = error == std::errc{} && comma != end && *comma == ',';
        const auto [last, fault] = std::from_chars(good ? comma + 1 : end, end, p.y);
        if (!good || fault != std::errc{} || last != end || !within(p, kFarthest / kMillimetre))
            throw UsageError("'" + excerpt(word) + "' of --lasso is not X,Y in millimetres");
        polygon.push_back(kMillimetre * p);
    }
    return polygon;
}

// As `tuft render` looks at the middle of the model, without perspective.
stroke::LassoView view_of(const View& v, const Vec3& middle) {
    const double a = v.azimuth * kDegree, e = v.elevation * kDegree;
    const Vec3 right{std::cos(a), std::sin(a), 0};
    const Vec3 forward{-std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), -std::sin(e)};
    return {.origin = middle, .right = right, .up = glm::cross(right, forward)};
}

stroke::Mask mask_of(const MaskWork& a, const stroke::MaskTable& table, const io::Project& project) {
    stroke::Mask mask;
    mask.name = a.name;
    int kinds = 0;
    const auto is = [&](bool given, stroke::MaskKind kind) {
        if (given) mask.kind = kind, ++kinds;
    };
    is(!a.groups.empty(), stroke::MaskKind::group);
    is(!a.direction.empty(), stroke::MaskKind::angle);
    is(!a.chart_mm.empty(), stroke::MaskKind::chart);
    is(!a.lasso.points.empty(), stroke::MaskKind::lasso);
    is(a.clear_mm > 0, stroke::MaskKind::clear);
    is(!a.invert.empty(), stroke::MaskKind::invert);
    is(!a.intersect.empty(), stroke::MaskKind::intersect);
    is(!a.unite.empty(), stroke::MaskKind::unite);
    if (kinds != 1)
        throw UsageError(
            "a mask is one of --group, --facing, --chart, --lasso, --clear-of-edges, --invert, --intersect and "
            "--unite");
    mask.groups = a.groups;
    if (!a.direction.empty()) mask.direction = vector_of(a.direction);
    mask.within = a.within * kDegree;
    mask.soft = a.soft * kDegree;
    if (a.clear_mm > 0) mask.distance = a.clear_mm * kMillimetre;
    if (!a.chart_mm.empty()) mask.points = {kMillimetre * vector_of(a.chart_mm)};
    if (!a.lasso.points.empty()) {
        mask.polygon = polygon_of(a.lasso.points);
        mask.view = view_of(a.lasso.view, project.model().mesh.bounds.centre());
        mask.view.through = a.lasso.through;
    }
    std::vector<std::string> of = a.intersect.empty() ? a.unite : a.intersect;
    if (!a.invert.empty()) of = {a.invert};
    for (const std::string& name : of) {
        const stroke::Mask* part = table.find(name);
        if (!part) throw Error(a.project.string(), Message("has no mask '{}'", name));
        mask.of.push_back(part->id);
    }
    return mask;
}

}  // namespace

int run(const MaskWork& a) {
    Console console(a.common.quiet);
    io::Project project = io::Project::open(a.project, open_options(io::Access::write, console));
    const std::vector<stroke::JournalEntry> entries = project.strokes();
    stroke::MaskTable table = stroke::masks_after(entries);
    stroke::MaskEdit edit;
    edit.remove = a.remove;
    if (a.remove) {
        const stroke::Mask* mask = table.find(a.name);
        if (!mask) throw Error(a.project.string(), Message("has no mask '{}'", a.name));
        edit.mask.id = mask->id;
    } else {
        edit.mask = mask_of(a, table, project);
        edit.mask.id = table.next_id;
    }
    stroke::apply(table, edit);
    double covered = 0;
    if (!a.remove) {
        // Looked at before it is kept: groups that are not there, a lasso beside the model.
        const auto opened = open_project(a.project, io::Access::read, console);
        if (!a.chart_mm.empty()) check_on_surface(opened->model, kMillimetre * vector_of(a.chart_mm), "--chart");
        stroke::check_groups(edit.mask, *opened->model.mesh);
        const stroke::MaskTexels texels = stroke::evaluate(edit.mask, table, opened->model);
        for (std::uint32_t slot = 0; slot < opened->model.texels.n_slots(); ++slot)
            for (int t = 0; t < atlas::kTileTexels; ++t)
                covered +=
                    static_cast<double>(opened->model.texels.tiles[slot].area[t]) * texels.coverage(slot, t) / 255;
        console.clear();
        if (covered == 0) console.note("warning: the mask covers nothing of the model");
    }
    project.append(stroke::entry_after(entries, edit));
    if (a.common.json)
        print_json(
            nlohmann::json{{"project", a.project.string()}, {"id", edit.mask.id}, {"covered_cm2", covered * 1e4}});
    else if (a.remove)
        fmt::print("ended mask {}\n", a.name);
    else
        fmt::print("mask {} covers {:.2f} cm2\n", a.name, covered * 1e4);
    return 0;
}

}  // namespace tuft::cli
