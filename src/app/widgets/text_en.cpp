#include <cstring>
#include <utility>

#include "app/widgets/ui.h"

/// What shipped brushes, inks, pigments and materials are called in English; their names in files are for files.
namespace tuft::app {
namespace {

constexpr std::pair<const char*, const char*> kNames[] = {
    {"goat", "Goat"},
    {"mixed", "Mixed"},
    {"wolf", "Wolf"},
    {"other", "Other"},
    {"goat-small", "Goat, small"},
    {"goat-medium", "Goat, medium"},
    {"goat-large", "Goat, large"},
    {"mixed-small", "Mixed, small"},
    {"mixed-medium", "Mixed, medium"},
    {"mixed-large", "Mixed, large"},
    {"wolf-small", "Wolf, small"},
    {"wolf-medium", "Wolf, medium"},
    {"wolf-large", "Wolf, large"},
    {"robot-2020", "Robot 2020"},
    {"carbon", "Carbon"},
    {"carbon-black", "Carbon black"},
    {"bone-black", "Bone black"},
    {"cinnabar", "Cinnabar"},
    {"cobalt", "Cobalt"},
    {"cobalt-underglaze", "Cobalt underglaze"},
    {"gamboge", "Gamboge"},
    {"indigo", "Indigo"},
    {"iron-red", "Iron red"},
    {"shell-white", "Shell white"},
    {"titanium-white", "Titanium white"},
    {"titanium-white-paste", "Titanium white paste"},
    {"water", "Water"},
    {"mixture", "Mixture"},
    {"porcelain", "Porcelain"},
    {"bisque", "Bisque"},
    {"clay", "Clay"},
    {"primed-metal", "Primed metal"},
    {"rice-paper", "Rice paper"},
};

}  // namespace

const char* english_name(const char* name) {
    for (const auto& [from, to] : kNames)
        if (std::strcmp(from, name) == 0) return to;
    return nullptr;
}

}  // namespace tuft::app
