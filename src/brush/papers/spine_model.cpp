#include "brush/papers/spine_model.h"

#include "brush/papers/chain.h"
#include "brush/papers/macro_model.h"
#include "brush/papers/truss_model.h"

namespace tuft::brush {

std::unique_ptr<SpineModel> make_spine_model(const Preset& preset) {
    switch (preset.spine) {
        case SpineMethod::rod:
        case SpineMethod::table:
            break;
        case SpineMethod::chain:
            return make_chain_model(preset);
        case SpineMethod::macro:
            return make_macro_model(preset);
        case SpineMethod::truss:
            return make_truss_model(preset);
    }
    return nullptr;
}

}  // namespace tuft::brush
