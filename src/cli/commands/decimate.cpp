#include "mesh/repair/decimate.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/text/units.h"
#include "io/model/read_model.h"
#include "mesh/query/surface_query.h"
#include "mesh/repair/inspect.h"

namespace tuft::cli {
namespace {

/// Greatest distance of vertices of `full` from `copy`, metres: of each, or of every n-th of a million.
double farthest(const mesh::TriangleMesh& full, const mesh::TriangleMesh& copy) {
    constexpr std::size_t kMost = 1'000'000;
    const mesh::SurfaceQuery query(copy);
    const std::size_t step = full.n_vertices() / kMost + 1;
    double worst = 0;
    for (std::size_t v = 0; v < full.n_vertices(); v += step)
        if (const auto nearest = query.closest_point(Vec3(full.positions[v])))
            worst = std::max(worst, nearest->distance);
    return worst;
}

}  // namespace

int run(const Decimate& a) {
    check_extension(a.output, {".ply"});
    check_output(a.output);
    std::error_code none_yet;
    if (std::filesystem::equivalent(a.output, a.model, none_yet))
        throw UsageError("--output is the model itself: give the working copy another name");
    if (a.triangles == 0 && !(a.error_mm > 0)) throw UsageError("say how far: --triangles N, --error MM or both");
    Console console(a.common.quiet);
    const auto [model, frame, fixed] = load_bare(a.model, a, console);
    const mesh::TriangleMesh& full = *model.mesh;
    mesh::PolygonSoup soup = mesh::decimate(full, {.n_triangles = a.triangles, .error = a.error_mm * kMillimetre});
    const std::size_t n = soup.n_polygons();
    if (!soup.polygon_groups.empty()) console.note("groups and materials are not written to a PLY file");
    // A PLY file says no unit: it is read in millimetres, or in what its size suggests, as the model was.
    const double unit = fixed ? kMillimetre : metres_per(frame.unit).value_or(kMillimetre);
    mesh::PolygonSoup file = soup;
    for (Vec3& p : file.points) p /= unit;
    mesh::write_ply(a.output, file);
    const double distance = farthest(full, mesh::build_surface(std::move(soup), {.metres_per_unit = 1}).mesh);
    console.clear();
    if (a.common.json) {
        print_json({{"model", a.model.string()},
                    {"wrote", a.output.string()},
                    {"triangles_before", full.n_triangles()},
                    {"triangles", n},
                    {"distance_mm", distance / kMillimetre},
                    {"peak_mb", peak_megabytes()}});
        return 0;
    }
    fmt::print("{} of {} triangles; the model's vertices lie within {:.3g} mm of them\n", n, full.n_triangles(),
               distance / kMillimetre);
    Box numbers;
    for (const Vec3& p : file.points) numbers.add(p);
    const std::string written = fixed ? "mm" : frame.unit;
    const bool is_guessed = mesh::guess_unit(numbers).unit == written && (fixed || a.unit.empty());
    const std::string in_unit = is_guessed ? "" : " with --unit " + written;
    fmt::print("wrote {}: paint on it{}, then replay its project on the full model with --model {}\n",
               a.output.string(), in_unit, a.model.string());
    return 0;
}

}  // namespace tuft::cli
