#include "stroke/document/palette.h"

#include "atlas/texels/seam_links.h"

namespace tuft::stroke {
namespace {

constexpr double kPaletteCell = 0.01;  // metres, of its mesh
constexpr int kColumns = 12, kRows = 9;
constexpr double kPoolEdge = 25;  // film units that stand at the rim of a pool on glaze
constexpr Vec2 kCorner{kPaletteTexels / 2 * kPaletteTexel, 0.049};  // uv (0, 0) lies at − this

}  // namespace

Model make_palette() {
    mesh::PolygonSoup soup;
    for (int y = 0; y <= kRows; ++y)
        for (int x = 0; x <= kColumns; ++x)
            soup.points.emplace_back(kPaletteCell * x - 0.5 * kPaletteWidth, kPaletteCell * y - 0.5 * kPaletteHeight,
                                     0.0);
    soup.polygon_start.push_back(0);
    const auto add = [&](std::initializer_list<int> corners) {
        for (const int c : corners) {
            soup.corners.push_back(static_cast<std::uint32_t>(c));
            const Vec2 uv =
                (Vec2(soup.points[static_cast<std::size_t>(c)]) + kCorner) / (kPaletteTexels * kPaletteTexel);
            soup.corner_uvs.emplace_back(uv);
        }
        soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    };
    for (int y = 0; y < kRows; ++y)
        for (int x = 0; x < kColumns; ++x) {
            const int a = y * (kColumns + 1) + x, b = a + kColumns + 1;
            add({a, a + 1, b + 1});
            add({a, b + 1, b});
        }
    ModelOptions options;
    options.repair.metres_per_unit = 1;
    options.unwrap.size = kPaletteTexels;
    options.unwrap.uvs = atlas::UvPolicy::keep;
    options.texels = atlas::TexelStore::floats;
    return prepare_model(std::move(soup), options);
}

ink::Substrate palette_substrate() {
    return {.name = "palette",
            .title = "Palette of glazed porcelain",
            .reflectance = {0.86f, 0.86f, 0.85f},
            .roughness = 0.1f,
            .capacity = 200,
            .interface = 1,
            .relief = 1e-6f,
            .relief_length = 40e-6f,
            .absorbency = 0,
            .pores = 0,
            .diffusion = 1e-10f,
            .threshold = 0.1f,
            .edge = 0,
            .evaporation = 0};
}

ink::FilmParams palette_film() {
    ink::FilmParams params = ink::film_params(palette_substrate(), Vec3{0});
    params.pin = kPoolEdge;
    params.evaporation = 0;
    params.rim_evaporation = 0;
    params.stain = 0;
    return params;
}

Palette::Palette()
    : model(make_palette()),
      substrate(palette_substrate()),
      params(palette_film()),
      canvas(model.texels.n_slots()),
      seams(atlas::build_seam_links(*model.mesh, model.atlas, model.texels)),
      film(std::make_unique<ink::WetFilm>(model.texels, seams)) {}

}  // namespace tuft::stroke
