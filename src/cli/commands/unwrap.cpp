#include <fmt/format.h>

#include <iostream>
#include <nlohmann/json.hpp>

#include "atlas/unwrap/atlas_picture.h"
#include "cli/steps/commands.h"
#include "cli/steps/steps.h"
#include "core/text/counted.h"
#include "core/text/units.h"
#include "io/export/export.h"
#include "io/image/image.h"

namespace tuft::cli {

int run(const Unwrap& a) {
    check_extension(a.output, {".obj", ".glb", ".gltf"});
    check_extension(a.picture, {".png"});
    check_output(a.output);
    check_output(a.picture);
    Console console(a.common.quiet);
    const auto [model, frame, stated] = load_bare(a.model, a.surface, console);
    atlas::UnwrapOptions options = model_options(a.surface, console).unwrap;
    options.progress = console.progress();
    atlas::Unwrapped unwrapped;
    try {
        unwrapped = atlas::unwrap(*model.mesh, options);
    } catch (const Error& error) {
        throw Error(a.model.string(), error.what());
    }
    io::export_model(a.output, *model.mesh, unwrapped.atlas, {}, {.frame = frame});
    if (!a.picture.empty()) {
        const atlas::AtlasPicture picture = atlas::draw_atlas(*model.mesh, unwrapped.atlas);
        io::write_image(a.picture, io::view_of(static_cast<int>(picture.width), static_cast<int>(picture.height), 3,
                                               picture.rgb.data()));
    }
    console.clear();
    const atlas::AtlasReport& r = unwrapped.report;
    if (a.common.json) {
        nlohmann::json j{{"model", a.model.string()},
                         {"wrote", a.output.string()},
                         {"triangles", model.mesh->n_triangles()},
                         {"atlas", to_json(unwrapped.atlas, r)},
                         {"peak_mb", peak_megabytes()}};
        print_json(j);
        return 0;
    }
    const atlas::Atlas& made = unwrapped.atlas;
    const std::string pages = made.pages > 1 ? fmt::format("{} pages of ", made.pages) : "";
    fmt::print("{} at {}{} x {}, texel {:.3f} mm, {:.0f} % used{}\n", counted(r.charts, "chart"), pages,
               made.page_size(), made.page_size(), unwrapped.atlas.texel_size / kMillimetre, 100 * r.utilisation,
               unwrapped.atlas.from_file ? " (the file's own UVs)" : "");
    fmt::print(
        "stretch L2 {:.4f}, Linf {:.2f}; seams {:.1f} x the diagonal; flips {}, overlapping texels {}, triangles "
        "without room {}\n",
        r.l2_stretch, r.linf_stretch, r.seam_length, r.flips, r.overlapping_texels, r.zero_area_triangles);
    fmt::print("wrote {}\n", a.output.string());
    return 0;
}

}  // namespace tuft::cli
