#include "pictures/picture_look.h"

#include "ink/composite/composite.h"

namespace tuft::pictures {

PictureLook make_look(const stroke::Model& model, const stroke::Document* painting, const std::string& material,
                      bool raking) {
    PictureLook look;
    render::Appearance& appearance = look.appearance;
    const ink::Substrate substrate = material.empty() && painting
                                         ? painting->appearance().substrate()
                                         : ink::load_substrate(material.empty() ? "porcelain" : material);
    appearance.finish = substrate.roughness > 0.45f ? render::Finish::clay : render::Finish::porcelain;
    appearance.body_colour = Vec3f(substrate.reflectance[0], substrate.reflectance[1], substrate.reflectance[2]);
    ink::Stack bare{std::vector<ink::LayerView>{}};
    if (material.empty()) bare.base_colour = &model.base_colour;
    ink::Stack stack = painting ? painting->appearance().stack() : bare;
    if (!material.empty()) stack.substrates = nullptr;
    appearance.vertex_colours = false;
    if (!stack.layers.empty() || stack.has_base_colour() || stack.substrates || substrate.transmission > 0) {
        const ink::ComposeOptions compose = painting ? painting->appearance().compose_options() : ink::ComposeOptions{};
        look.colour = ink::compose_linear(stack, model.texels, substrate, compose);
        if (raking) {
            look.height = ink::compose_height(stack, model.texels, compose);
            for (float& h : look.height.texels) h *= 1e-6f;
        }
        if (stack.substrates) {
            appearance.finish = render::Finish::porcelain;
            look.roughness = ink::compose_roughness(stack, model.texels, substrate, compose);
        }
        look.transmission = ink::compose_transmission8(stack, model.texels, substrate, compose);
        look.point_to_maps(model);
    }
    return look;
}

render::Glass glass_of(const PictureLook& look, const stroke::Document& painting) {
    render::Glass glass{.triangles = {},
                        .hidden = painting.parts().hidden_triangles(),
                        .size = look.transmission.size,
                        .transmission = look.transmission.texels};
    if (!glass.transmission.empty())
        for (const float part : painting.parts().transmission(painting.appearance().substrate()))
            glass.triangles.push_back(part > 0);
    return glass;
}

void PictureLook::point_to_maps(const stroke::Model& model) {
    const auto* first = reinterpret_cast<const Vec3f*>(colour.texels.data());
    appearance.maps.size = colour.size;
    appearance.maps.corner_uvs = model.atlas.corner_uvs;
    appearance.maps.base_colour = std::span(first, std::size_t{colour.size} * colour.size);
    appearance.maps.height = height.texels;
    appearance.maps.roughness = roughness.texels;
}

}  // namespace tuft::pictures
