// Reads a mesh, unwraps it, paints one stroke from code and writes a GLB:
//     tuft-hello MODEL OUT.glb
#include <cmath>
#include <cstdio>
#include <exception>

#include "io/export/export.h"
#include "io/model/read_model.h"
#include "stroke/document/document.h"

using namespace tuft;

// A wavy line of 40 mm to the right from where the model's front is nearest to its middle.
static stroke::PaintStroke wavy_line(const stroke::Model& model) {
    const Box& box = model.mesh->bounds;
    const auto front = model.query->ray(box.centre() - Vec3(0, box.diagonal(), 0), Vec3(0, 1, 0));
    stroke::PaintStroke stroke;
    stroke.brush = "wolf-medium";
    stroke.ink = "indigo";
    stroke.trace.placement = {.origin = front ? front->position : box.centre(), .right = {1, 0, 0}, .down = {0, 0, -1}};
    for (int i = 0; i <= 100; ++i) {
        const double u = i / 100.0;
        stroke.trace.samples.push_back({.time = u,                                                   // s
                                        .position = {0.04 * (u - 0.5), 0.003 * std::sin(9 * u), 0},  // m
                                        .pressure = 0.6 * std::sin(3.1416 * u)});  // of the working depth
    }
    return stroke;
}

// Square metres of the texels with any pigment on them.
static double ink_area(const stroke::Document& painting) {
    const ink::Canvas& canvas = painting.layers().canvas();
    double area = 0;
    for (const std::uint32_t slot : canvas.touched_slots())
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            const ink::Plane* film = canvas.plane(slot, 0);
            if (film && (*film)[t] > 0) area += static_cast<double>(painting.model().texels.tiles[slot].area[t]);
        }
    return area;
}

int main(int argc, char** argv) {
    if (argc != 3) return std::fputs("usage: tuft-hello MODEL OUT.glb\n", stderr), 2;
    try {
        stroke::ModelOptions options;
        mesh::PolygonSoup file = io::read_model(argv[1]);
        options.repair.metres_per_unit = io::metres_per_unit(file).value_or(1e-3);
        options.unwrap.size = 512;  // texels along the side of the atlas
        const stroke::Model model = stroke::prepare_model(std::move(file), options);
        stroke::Document painting(model, {.substrate = "porcelain"});
        painting.paint(wavy_line(model));
        const stroke::Appearance& shown = painting.appearance();
        io::export_model(argv[2], *model.mesh, model.atlas,
                         io::make_maps(shown.stack(), model.texels, shown.substrate(), shown.compose_options()));
        std::printf("%u charts, %.1f mm2 of ink\n", model.atlas.n_charts, 1e6 * ink_area(painting));
    } catch (const std::exception& error) {
        return std::fprintf(stderr, "tuft-hello: %s\n", error.what()), 1;
    }
}
