#include "ink/composite/recolour.h"
#include "stroke/painting/painting.h"

/// How a painting is shown, apart from what was painted.
namespace tuft::stroke {

void Document::preview_substrate(std::optional<ink::Substrate> substrate) {
    previewed_substrate_ = std::move(substrate);
    for (const Layer& layer : layers_.layers) touch_look(layer.id);
}

void Document::recolour(const std::string& name, const ink::Ink& wanted) {
    ink(name);  // an unknown name throws before anything changes
    recolours_.insert_or_assign(name, wanted);
    apply_recolours();
}

void Document::apply_recolours() {
    for (const auto& [name, wanted] : recolours_) {
        const ink::Ink& painted = ink(name);
        ink::recolour(canvas_, painted, wanted);
        for (auto& [layer, canvas] : upper_) ink::recolour(canvas, painted, wanted);
    }
}

// A pigment that is new to the canvas comes with the look it was painted with.
ink::Mix Document::mix_of(const std::string& name) {
    const std::size_t before = canvas_.pigments().size();
    const ink::Mix mix = ink::mix_of(canvas_, ink(name));
    if (canvas_.pigments().size() != before) apply_recolours();
    return mix;
}

}  // namespace tuft::stroke
