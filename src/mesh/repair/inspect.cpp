#include "mesh/repair/inspect.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "core/text/units.h"

namespace tuft::mesh {
namespace {

/// Three significant digits, e.g. "0.12", "15.3", "1230".
std::string short_number(double x) {
    const double size = std::abs(x);
    int digits = 0;
    if (size < 100 && size > 0) digits = std::min(9, 2 - static_cast<int>(std::floor(std::log10(size))));
    char text[32];
    if (size >= 1e7 || (size > 0 && size < 1e-6))
        std::snprintf(text, sizeof text, "%.2e", x);
    else
        std::snprintf(text, sizeof text, "%.*f", digits, x);
    return text;
}

std::string size_text(const Vec3& size_metres) {
    return short_number(size_metres.x / kMillimetre) + " x " + short_number(size_metres.y / kMillimetre) + " x " +
           short_number(size_metres.z / kMillimetre) + " mm";
}

std::string count_text(std::size_t n, const char* one, const char* many) {
    return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// How likely a product is to measure `diagonal` metres: see guess_unit.
double plausibility(double diagonal) {
    constexpr double kSmall = 0.06, kLarge = 6, kSpread = 0.5;  // metres; natural logarithm
    const double beyond = diagonal < kSmall   ? std::log(kSmall / diagonal)
                          : diagonal > kLarge ? std::log(diagonal / kLarge)
                                              : 0;
    return std::exp(-0.5 * (beyond / kSpread) * (beyond / kSpread));
}

struct Unit {
    const char* name;
    const char* plural;
    double weight;
};
constexpr std::array<Unit, 4> kUnits{
    {{"mm", "millimetres", 0.5}, {"m", "metres", 0.25}, {"cm", "centimetres", 0.15}, {"in", "inches", 0.1}}};

/// Units that a model of `diagonal` units across may be in: their places in kUnits, the likeliest first. Beside
/// millimetres that make a usual product nothing else is possible; beside metres centimetres and inches are.
std::vector<std::size_t> possible_units(double diagonal) {
    constexpr double kPossible = 0.35;  // of the best score
    std::array<double, 4> score{};
    for (std::size_t i = 0; i < kUnits.size(); ++i)
        score[i] = kUnits[i].weight * plausibility(diagonal * *metres_per(kUnits[i].name));
    const double best = *std::max_element(score.begin(), score.end());
    if (!(best > 1e-12)) return {};
    std::vector<std::size_t> possible;
    for (std::size_t i = 0; i < kUnits.size(); ++i)
        if (score[i] >= kPossible * best) possible.push_back(i);
    std::stable_sort(possible.begin(), possible.end(),
                     [&](std::size_t a, std::size_t b) { return score[a] > score[b]; });
    return possible;
}

/// Whether a surface may be in the unit that it was loaded in.
bool is_loaded_in_possible_unit(const MeshSummary& s) {
    const auto is_loaded = [&](double metres) { return std::abs(metres / s.metres_per_unit - 1) < 1e-9; };
    if (is_loaded(s.unit.metres_per_unit)) return true;
    const std::vector<std::size_t> possible = possible_units(s.bounds.diagonal() / s.metres_per_unit);
    return std::ranges::any_of(possible, [&](std::size_t i) { return is_loaded(*metres_per(kUnits[i].name)); });
}

}  // namespace

UnitGuess guess_unit(const Box& bounds) {
    const double diagonal = bounds.diagonal();
    UnitGuess guess;
    if (!(diagonal > 0) || !std::isfinite(diagonal)) {
        guess.unit = "mm";
        guess.sentence = "the model has no size to guess its unit from; mm is taken";
        return guess;
    }
    const std::vector<std::size_t> possible = possible_units(diagonal);
    if (possible.empty()) {  // no unit makes it a product: nothing to tell them apart
        guess.unit = "mm";
        guess.sentence =
            "no usual unit makes this a thing one can hold (" + short_number(diagonal) + " units across); mm is taken";
        return guess;
    }
    const std::size_t best = possible.front();
    guess.unit = kUnits[best].name;
    guess.metres_per_unit = *metres_per(guess.unit);
    guess.sentence = "numbers look like " + std::string(kUnits[best].plural) + ": the model would be " +
                     size_text(bounds.size() * guess.metres_per_unit);
    const char* join = "; possible too: as ";
    for (const std::size_t i : possible) {
        if (i == best) continue;
        if (guess.second.empty()) guess.second = kUnits[i].name;
        guess.sentence += join + std::string(kUnits[i].plural) + " " +
                          size_text(bounds.size() * *metres_per(kUnits[i].name)) + " (" + kUnits[i].name + ")";
        join = ", as ";
    }
    return guess;
}

MeshSummary summarise(const Surface& surface, double metres_per_unit) {
    const TriangleMesh& mesh = surface.mesh;
    MeshSummary s;
    s.n_vertices = mesh.n_vertices();
    s.n_triangles = mesh.n_triangles();
    s.bounds = mesh.bounds;
    s.area = surface_area(mesh);
    s.has_uvs = !mesh.corner_uvs.empty();
    s.has_colours = has_colours(mesh);
    std::set<const Picture*> pictures;
    const auto add = [&](const Picture* picture) {
        if (picture && pictures.insert(picture).second)
            s.pictures.push_back(picture->name + " (" + std::to_string(picture->width) + " x " +
                                 std::to_string(picture->height) + ")");
    };
    for (const Material& m : mesh.materials) {
        add(m.picture.get());
        for (const PictureTile& tile : m.tiles) add(tile.picture.get());
    }
    s.vertex_colours = !mesh.vertex_colours.empty();
    s.group_names = mesh.group_names;
    s.metres_per_unit = metres_per_unit;
    s.report = surface.report;
    std::vector<float> edges;
    edges.reserve(3 * mesh.n_triangles() / 2 + surface.report.border_edges);
    const Vec3 centre = mesh.bounds.centre();
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec3 p[3] = {mesh.position(t, 0), mesh.position(t, 1), mesh.position(t, 2)};
        if (s.report.closed) s.volume += glm::dot(p[0] - centre, glm::cross(p[1] - centre, p[2] - centre)) / 6;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::uint32_t over = mesh.neighbours[3 * t + k];
            if (over == kNone || over > t) edges.push_back(static_cast<float>(glm::distance(p[k], p[(k + 1) % 3])));
        }
    }
    if (!edges.empty()) {
        const auto middle = edges.begin() + static_cast<std::ptrdiff_t>(edges.size() / 2);
        std::nth_element(edges.begin(), middle, edges.end());
        s.median_edge = *middle;
        s.longest_edge = *std::max_element(middle, edges.end());
    }
    Box in_file_units;
    in_file_units.add(mesh.bounds.lo / metres_per_unit);
    in_file_units.add(mesh.bounds.hi / metres_per_unit);
    s.unit = guess_unit(in_file_units);
    return s;
}

std::vector<Message> describe_defects(const RepairReport& r) {
    std::vector<Message> lines;
    const auto note = [&](std::size_t n, const char* one, const char* many) {
        if (n) lines.push_back(Message(n == 1 ? one : many, n));
    };
    // Triangles without shared vertices are the way of STL, not a defect.
    if (!r.file.loose_triangles)
        note(r.vertices_welded, "{} vertex lay on another one: welded", "{} vertices lay on others: welded");
    note(r.crack_vertices_welded, "{} vertex lay next to another one across a crack: welded",
         "{} vertices lay next to others across cracks: welded");
    note(r.unused_vertices_dropped, "{} vertex is used by no face: dropped",
         "{} vertices are used by no face: dropped");
    note(r.degenerate_faces_dropped, "{} face without an area: dropped", "{} faces without an area: dropped");
    note(r.degenerate_faces_repaired, "{} face with a corner on its opposite side: mended by a flip",
         "{} faces with a corner on their opposite side: mended by flips");
    note(r.duplicate_faces_dropped, "{} face is there twice: dropped", "{} faces are there twice: dropped");
    note(r.non_manifold.edges_split, "{} edge with more than two faces: split",
         "{} edges with more than two faces: split");
    note(r.non_manifold.vertices_split, "{} vertex where separate surfaces touch: split",
         "{} vertices where separate surfaces touch: split");
    note(r.faces_flipped, "{} face showed its back: turned round", "{} faces showed their backs: turned round");
    note(r.parts_turned, "{} open part was inside out: turned round", "{} open parts were inside out: turned round");
    lines.insert(lines.end(), r.warnings.begin(), r.warnings.end());
    return lines;
}

std::vector<std::string> describe(const MeshSummary& s) {
    constexpr std::size_t kManyTriangles = 3'000'000;  // about a minute to prepare, and 1.5 GB
    const RepairReport& r = s.report;
    std::vector<std::string> lines;
    lines.push_back(count_text(s.n_triangles, "triangle, ", "triangles, ") +
                    count_text(s.n_vertices, "vertex", "vertices") + " (in the file " +
                    count_text(r.file.polygons, "face, ", "faces, ") +
                    count_text(r.file.points, "vertex)", "vertices)"));
    lines.push_back("size " + size_text(s.bounds.size()) + ", area " + short_number(s.area * 1e4) + " cm²" +
                    (r.closed ? ", volume " + short_number(s.volume * 1e6) + " cm³" : ""));
    lines.push_back("edges: half of them below " + short_number(s.median_edge / kMillimetre) + " mm, longest " +
                    short_number(s.longest_edge / kMillimetre) + " mm");
    lines.push_back(count_text(r.components, "part, ", "parts, ") +
                    (r.closed ? "closed"
                              : "open: " + count_text(r.holes, "border loop", "border loops") + " with " +
                                    count_text(r.border_edges, "edge", "edges")));
    std::string extras;
    if (s.has_uvs) extras += "texture coordinates, ";
    if (s.vertex_colours) extras += "vertex colours, ";
    if (s.has_colours && !s.vertex_colours && s.pictures.empty()) extras += "colours of materials, ";
    for (const std::string& picture : s.pictures) extras += "the picture " + picture + ", ";
    if (!s.group_names.empty()) extras += count_text(s.group_names.size(), "group, ", "groups, ");
    if (r.file.loose_triangles) lines.push_back("the triangles came loose and were joined (as in STL)");
    if (!extras.empty()) lines.push_back("has " + extras.substr(0, extras.size() - 2));
    lines.push_back("unit: " + s.unit.sentence);
    if (!is_loaded_in_possible_unit(s)) lines.push_back("warning: it was loaded with another unit; check --unit");
    const std::vector<Message> defects = describe_defects(r);
    if (defects.empty()) lines.push_back("no defects");
    for (const Message& d : defects) lines.push_back("repaired: " + d.text());
    if (s.n_triangles >= kManyTriangles)
        lines.push_back(
            "many triangles: 'tuft decimate' makes a light copy to paint on; its strokes are painted on this model by "
            "'tuft replay --model'");
    return lines;
}

}  // namespace tuft::mesh
