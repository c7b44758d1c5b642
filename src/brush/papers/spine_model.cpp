#include "brush/papers/spine_model.h"

#include "brush/papers/chain.h"
#include "brush/papers/macro_model.h"
#include "brush/papers/truss_model.h"
#include "brush/preset/rest_shape.h"

namespace tuft::brush {

std::unique_ptr<SpineModel> make_spine_model(const Preset& preset) {
    switch (preset.spine) {
        case SpineMethod::rod:
        case SpineMethod::table:
            break;
        case SpineMethod::chain:
            return make_chain_model(preset, {.spines = has_broad_side(preset) ? 2 : 1});
        case SpineMethod::macro:
            return make_macro_model(preset);
        case SpineMethod::truss:
            if (has_broad_side(preset)) {
                const truss::Kind kind = preset.toe > 0 ? truss::Kind::filbert : truss::Kind::flat;
                return make_truss_model(preset, kind, preset.width, 2 * rest_radius(preset, 0));
            }
            return make_truss_model(preset);
    }
    return nullptr;
}

}  // namespace tuft::brush
