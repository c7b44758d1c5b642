#include "io/project/appearance.h"

namespace tuft::io {

void apply_recolouring(const Project& project, stroke::Document& painting) {
    const std::string file = project.path().string();
    for (const auto& [name, toml] : project.recolours())
        painting.appearance().recolour(name, ink::parse_ink(toml, file + ": ink " + name + " shown"));
    if (const std::string toml = project.shown_substrate(); !toml.empty())
        painting.appearance().preview_substrate(ink::parse_substrate(toml, file + ": substrate shown"));
}

void store_recolouring(Project& project, const stroke::Document& painting) {
    for (const auto& [name, ink] : painting.appearance().recolours()) project.put_recolour({name, ink::ink_toml(ink)});
    const std::string shown =
        painting.appearance().has_preview_substrate() ? ink::substrate_toml(painting.appearance().substrate()) : "";
    if (shown != project.shown_substrate()) project.put_shown_substrate(shown);
}

}  // namespace tuft::io
