#include "brush/papers/spine_model.h"

namespace tuft::brush {

std::unique_ptr<SpineModel> make_spine_model(const Preset& preset) {
    switch (preset.spine) {
        case SpineMethod::rod:
        case SpineMethod::table:
        case SpineMethod::macro:
        case SpineMethod::chain:
        case SpineMethod::truss:
            break;
    }
    return nullptr;
}

}  // namespace tuft::brush
