#include "brush/papers/spine_model.h"

#include "brush/papers/chain.h"

namespace tuft::brush {

std::unique_ptr<SpineModel> make_spine_model(const Preset& preset) {
    switch (preset.spine) {
        case SpineMethod::rod:
        case SpineMethod::table:
            break;
        case SpineMethod::chain:
            return make_chain_model(preset);
        case SpineMethod::macro:
        case SpineMethod::truss:
            break;
    }
    return nullptr;
}

}  // namespace tuft::brush
