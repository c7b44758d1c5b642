#include "ink/colour/pigments.h"
#include "ink/colour/presets.h"

namespace tuft::ink {

using preset::list_text;
using preset::quoted;
using preset::shortest_float;
using preset::shortest_in;

Substrate parse_substrate(std::string_view text, const std::string& source) {
    const toml::table table = parse_toml(text, source);
    const preset::Reader in(table, source);
    in.only({"name",
             "title",
             "reflectance",
             "roughness",
             "metallic",
             "transmission",
             "capacity",
             "interface",
             "relief_um",
             "relief_length_um",
             "absorbency",
             "pores",
             "pore_radius_nm",
             "contact_angle_deg",
             "retention",
             "diffusion",
             "threshold",
             "edge",
             "evaporation",
             "still_air_mm",
             "line_hysteresis",
             "source"});
    Substrate s;
    const auto read = [&](float& field, std::string_view key, double lo, double hi, double unit = 1) {
        const double value = in.number(key, lo, hi, static_cast<double>(field) / unit);
        field = static_cast<float>(value * unit);
    };
    s.name = in.text("name", "");
    s.title = in.text("title", s.name);
    s.reflectance = in.rgb("reflectance", 0, 1);
    s.roughness = static_cast<float>(in.number("roughness", 0, 1, 0.5));
    s.metallic = static_cast<float>(in.number("metallic", 0, 1, 0.0));
    s.transmission = static_cast<float>(in.number("transmission", 0, 1, 0.0));
    s.capacity = static_cast<float>(in.number("capacity", 0.1, 1000, 8.0));
    read(s.interface, "interface", 0, 1);
    read(s.relief, "relief_um", 0, 1000, 1e-6);
    read(s.relief_length, "relief_length_um", 1, 10000, 1e-6);
    Wetting& w = s.wetting;
    read(w.absorbency, "absorbency", 0, 100);
    read(w.pores, "pores", 0, 1000);
    read(w.pore_radius, "pore_radius_nm", 0, 1e6, 1e-9);
    read(w.contact_angle, "contact_angle_deg", 0, 89);
    read(w.retention, "retention", 0, 1);
    read(w.diffusion, "diffusion", 0, 1e-4);
    read(w.threshold, "threshold", 0, 10);
    read(w.edge, "edge", 0, 1);
    read(w.evaporation, "evaporation", 0, 10);
    read(w.still_air, "still_air_mm", 0, 1e5, 1e-3);
    read(w.line_hysteresis, "line_hysteresis", 0, 2);
    return s;
}

std::string substrate_toml(const Substrate& s) {
    const Wetting& w = s.wetting;
    return "name = " + quoted(s.name) + "\ntitle = " + quoted(s.title) + "\nreflectance = " + list_text(s.reflectance) +
           "\nroughness = " + shortest_float(s.roughness) + "\nmetallic = " + shortest_float(s.metallic) +
           (s.transmission > 0 ? "\ntransmission = " + shortest_float(s.transmission) : std::string()) +
           "\ncapacity = " + shortest_float(s.capacity) + "\ninterface = " + shortest_float(s.interface) +
           "\nrelief_um = " + shortest_in(s.relief, 1e-6) +
           "\nrelief_length_um = " + shortest_in(s.relief_length, 1e-6) +
           "\nabsorbency = " + shortest_float(w.absorbency) + "\npores = " + shortest_float(w.pores) +
           "\npore_radius_nm = " + shortest_in(w.pore_radius, 1e-9) +
           "\ncontact_angle_deg = " + shortest_float(w.contact_angle) + "\nretention = " + shortest_float(w.retention) +
           "\ndiffusion = " + shortest_float(w.diffusion) + "\nthreshold = " + shortest_float(w.threshold) +
           "\nedge = " + shortest_float(w.edge) + "\nevaporation = " + shortest_float(w.evaporation) +
           (w.still_air > 0 ? "\nstill_air_mm = " + shortest_in(w.still_air, 1e-3) : std::string()) +
           (w.line_hysteresis > 0 ? "\nline_hysteresis = " + shortest_float(w.line_hysteresis) : std::string()) + "\n";
}

Substrate load_substrate(std::string_view name) {
    const preset::Text text = preset::load(name, "substrates", "substrate");
    Substrate substrate = parse_substrate(text.text, text.source);
    if (substrate.name.empty()) substrate.name = text.name;
    return substrate;
}

std::vector<std::string> list_substrates() {
    return preset::list("substrates");
}

}  // namespace tuft::ink
