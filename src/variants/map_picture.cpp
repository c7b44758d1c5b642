#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/text/units.h"
#include "ink/composite/composite.h"
#include "ink/spectra/srgb.h"
#include "variants/lettering.h"
#include "variants/tolerance_map.h"

namespace tuft::variants {
namespace {

constexpr int kTicks = 5;
constexpr double kAround = 2.2;  // width of the picture over the diagonal of what is looked at
constexpr double kBarWidth = 18, kBarHeight = 260, kRight = 120, kTop = 90;  // pixels

/// Colours of a scale from its lowest value to its highest (YlOrBr of ColorBrewer, its dark end drawn out to violet),
/// which grow darker evenly: they are read without colours, too.
Vec3 colour_at(double part) {
    static const std::array<Vec3, 6> kColours{render::linear_colour(255, 236, 160), render::linear_colour(254, 196, 79),
                                              render::linear_colour(240, 130, 36),  render::linear_colour(196, 68, 10),
                                              render::linear_colour(122, 32, 32),   render::linear_colour(34, 10, 54)};
    const double x = std::clamp(part, 0.0, 1.0) * (kColours.size() - 1);
    const auto i = std::min(static_cast<std::size_t>(x), kColours.size() - 2);
    return glm::mix(kColours[i], kColours[i + 1], x - static_cast<double>(i));
}

/// Values and weights as amounts of two pigments, so that gutters continue over the seams as those of ink do.
ink::AtlasMap<float> map_of(const stroke::Model& model, const MapPicture& picture) {
    ink::Canvas canvas(model.texels.n_slots());
    ink::Pigment value, weight;
    value.name = "value";
    weight.name = "weight";
    const int v = canvas.add_pigment(value), w = canvas.add_pigment(weight);
    const double span = std::max(picture.highest - picture.lowest, 1e-12);
    for (std::uint32_t slot = 0; slot < model.texels.n_slots(); ++slot)
        for (std::size_t t = 0; t < atlas::kTileTexels; ++t) {
            const float x = picture.values[std::size_t{atlas::kTileTexels} * slot + t];
            if (std::isnan(x)) continue;
            canvas.touch(slot, v)[t] = static_cast<float>(std::clamp((x - picture.lowest) / span, 0.0, 1.0));
            canvas.touch(slot, w)[t] = 1;
        }
    const ink::GutterPlan gutter = ink::plan_gutter(*model.mesh, model.atlas, model.texels);
    return ink::compose_amounts(canvas, model.texels, {.gutter = model.atlas.gutter, .seams = &gutter});
}

void draw_scale(render::BrushCanvas& canvas, const MapPicture& picture) {
    const double x = picture.width - kRight, y = kTop;
    constexpr int kSteps = 130;
    for (int i = 0; i < kSteps; ++i) {
        const double y0 = y + kBarHeight * i / kSteps, y1 = y + kBarHeight * (i + 1) / kSteps;
        const std::array<Vec2, 4> box{Vec2(x, y0), Vec2(x + kBarWidth, y0), Vec2(x + kBarWidth, y1), Vec2(x, y1)};
        render::fill_polygon(canvas, box, colour_at(1 - (i + 0.5) / kSteps));
    }
    for (int i = 0; i < kTicks; ++i) {
        const double part = static_cast<double>(i) / (kTicks - 1);
        const double value = picture.lowest + part * (picture.highest - picture.lowest);
        letter(canvas, fmt::format("{:.3g} {}", value, picture.unit),
               {x + kBarWidth + 8, y + kBarHeight * (1 - part) + 5}, {.size = 11});
    }
}

}  // namespace

render::Image draw_map(const stroke::Model& model, const MapPicture& picture, const ProgressFn& progress) {
    if (picture.values.size() != atlas::kTileTexels * model.texels.n_slots() || picture.view_deg.size() != 2)
        throw Error("a map is of another model than this");
    const ink::AtlasMap<float> map = map_of(model, picture);
    std::vector<Vec3f> colours(std::size_t{map.size} * map.size, picture.body);
    for (std::size_t i = 0; i < colours.size() && map.channels == 2; ++i) {
        const float weight = map.texels[2 * i + 1];
        if (weight < 0.5f) continue;
        colours[i] = Vec3f(colour_at(map.texels[2 * i] / weight));
    }
    render::Appearance appearance;
    appearance.finish = render::Finish::clay;  // no reflections over the colours
    appearance.body_colour = picture.body;
    appearance.vertex_colours = false;
    appearance.maps.size = map.size;
    appearance.maps.corner_uvs = model.atlas.corner_uvs;
    appearance.maps.base_colour = colours;
    render::PictureOptions options;
    options.edge_samples = 8;  // colours say more here than light
    options.light_samples = 12;
    options.width = picture.width;
    options.height = picture.height;
    options.view.azimuth = picture.view_deg[0] * kDegree;
    options.view.elevation = picture.view_deg[1] * kDegree;
    if (!picture.around.empty()) {
        options.view.target = picture.around.centre();
        options.view.width_at_target =
            std::min(kAround * picture.around.diagonal(), 1.3 * model.mesh->bounds.diagonal());
    }
    options.progress = progress;
    render::Image image = render::render_picture(*model.mesh, *model.query, appearance, options);
    render::BrushCanvas canvas(image.width, image.height, Vec3(0));
    for (std::size_t i = 0; i < image.rgb.size(); ++i) canvas.rgb[i] = ink::linear_of_code()[image.rgb[i]];
    letter(canvas, picture.title, {24, 40}, {.size = 16, .width = picture.width - 48.0});
    draw_scale(canvas, picture);
    image.rgb = render::to_srgb(canvas);
    return image;
}

}  // namespace tuft::variants
