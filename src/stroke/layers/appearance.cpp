#include "stroke/layers/appearance.h"

#include <algorithm>
#include <utility>

namespace tuft::stroke {

std::vector<LayerTexels> Appearance::shown_layers() const {
    std::vector<LayerTexels> shown;
    for (const LayerTexels& texels : layers_.canvases()) {
        const Layer& layer = layers_.layer(texels.layer);
        const bool is = shown_.empty() ? layer.visible : std::ranges::find(shown_, layer.id) != shown_.end();
        if (is && layer.opacity > 0) shown.push_back(texels);
    }
    return shown;
}

ink::Stack Appearance::stack() const {
    ink::Stack stack{std::vector<ink::LayerView>{}};
    if (!previewed_) {  // another substrate is seen whole
        stack.base_colour = &model_.base_colour;
        stack.substrates = parts_.substrates();
    }
    for (const LayerTexels& texels : shown_layers()) {
        const Layer& layer = layers_.layer(texels.layer);
        stack.layers.push_back({texels.canvas, static_cast<float>(layer.opacity), layer.blend});
    }
    return stack;
}

ink::ComposeOptions Appearance::compose_options() const {
    if (!gutter_)
        gutter_ = std::make_unique<ink::GutterPlan>(ink::plan_gutter(*model_.mesh, model_.atlas, model_.texels));
    return {.gutter = model_.atlas.gutter, .seams = gutter_.get()};
}

void Appearance::show_only(std::vector<std::uint32_t> layers) {
    for (const std::uint32_t id : layers) layers_.layer(id);  // an unknown one throws before anything changes
    shown_ = std::move(layers);
    layers_.mark_changed();
}

void Appearance::preview_substrate(std::optional<ink::Substrate> substrate) {
    previewed_ = std::move(substrate);
    layers_.mark_changed();
}

void Appearance::recolour(const std::string& name, const ink::Ink& wanted) {
    materials_.ink(name);  // an unknown name throws before anything changes
    recolours_.insert_or_assign(name, wanted);
    apply_recolours();
}

void Appearance::apply_recolours() {
    for (const auto& [name, wanted] : recolours_) layers_.recolour(materials_.ink(name), wanted);
}

}  // namespace tuft::stroke
