#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "app/studio.h"
#include "core/text/units.h"

/// Settings by name, for scripts.
namespace tuft::app {

namespace {

/// The number that a value begins with, 0 where it is a word.
double number_of(const std::string& value) {
    constexpr double kMost = 1e6;
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    const bool whole = !value.empty() && end == value.c_str() + value.size();
    if (whole && !(std::abs(number) <= kMost)) throw Error("'" + value + "' is not a number within a million");
    return std::isfinite(number) ? number : 0;
}

}  // namespace

void Studio::set(const std::string& name, const std::string& value) {
    Session& s = session_;
    const double number = number_of(value);
    const bool on = value == "on";
    const auto one_of = [&](const std::vector<std::string>& names) {
        const auto at = std::find(names.begin(), names.end(), value);
        if (at != names.end()) return static_cast<int>(at - names.begin());
        const std::string near = nearest_name(value, names);
        throw Error("unknown " + name + " '" + value + "'" + (near.empty() ? "" : ", did you mean '" + near + "'?"));
    };
    if (name == "brush")
        s.brush = s.brushes[static_cast<std::size_t>(one_of(s.brushes))];
    else if (name == "brush-size")
        size_brush(s, number);
    else if (name == "colour")
        set_colour(s, value);
    else if (name == "clean-ends")
        s.hand.clean_ends = on;
    else if (name == "ink" || name == "tip-ink") {
        std::vector<std::string> names = s.inks;
        for (const ink::Ink& ink : s.own_inks) names.push_back(ink.name);
        const std::string& ink = names[static_cast<std::size_t>(one_of(names))];
        name == "ink" ? s.ink = ink : s.tip_ink = ink;
    } else if (name == "shading")
        s.view.shown = static_cast<ModelView>(
            one_of({"glaze", "clay", "flat", "height", "wetness", "texels", "charts", "stretch"}));
    else if (name == "light")
        s.view.rig = static_cast<render::LightRig>(one_of({"studio", "window", "raking"}));
    else if (name == "keymap")
        s.keymap = one_of({"blender", "maya"}) ? Keymap::maya : Keymap::blender;
    else if (name == "left-handed")
        s.wanted.left_handed = on, s.restyle = true;
    else if (name == "section-axis")
        s.view.section_axis = one_of({"x", "y", "z"});
    else if (name == "parallel")
        s.view.orbit.set_parallel(on);
    else if (name == "azimuth")
        s.view.orbit.azimuth = number * kDegree;
    else if (name == "elevation")
        s.view.orbit.elevation = number * kDegree;
    else if (name == "zoom")
        s.view.orbit.zoom(number, s.view.orbit.target);
    else if (name == "writing-width")
        s.writing.scale = number * kMillimetre / std::max(1e-6, s.writing.width);
    else if (name == "writing-turn")
        s.writing.turn = -number * kDegree;
    else if (name == "writing-mirror")
        s.writing.mirrored = on;
    else if (name == "writing-mapping")
        s.writing.mapping = static_cast<stroke::SurfaceMapping>(one_of({"wrap", "drape", "project"}));
    else if (name == "export-size")
        s.export_choice.size = static_cast<std::uint32_t>(std::clamp(number, 0.0, 16384.0));
    else if (name == "export-picture-width")
        s.export_choice.picture_width = std::clamp(static_cast<int>(number), 16, 8192);
    else if (name == "export-pictures")
        s.export_choice.picture = std::clamp(static_cast<int>(number), 0, 360);
    else if (name == "layer") {
        const stroke::Layer* layer = s.last.layers.find(std::string_view(value));
        if (!layer) throw Error("there is no layer '" + value + "'");
        s.layer = layer->id;
    } else if (name == "texels")
        s.open_options.atlas_size = static_cast<std::uint32_t>(std::clamp(number, 64.0, 16384.0));
    else if (name == "pressure")
        s.hand.pressure = std::clamp(number, 0.02, 1.0);
    else if (name == "carry")
        s.carry = on;
    else if (name == "wet")
        s.wet = on;
    else if (name == "palette")
        show_palette(s, on);
    else if (name == "palette-tool")
        s.palette.tool = static_cast<PaletteTool>(one_of({"brush", "pour", "pick"}));
    else if (name == "two-inks")
        s.two_inks = on;
    else if (name == "tip")
        s.tip_depth = std::clamp(number, 0.05, 0.9);
    else if (name == "dip-depth")
        s.dip_depth = std::clamp(number, 0.05, 1.0);
    else if (name == "dip-side")
        s.dip_side = std::clamp(number, -1.0, 1.0);
    else if (name == "mask-kind")
        s.mask_choice.kind = stroke::mask_kind_of(value);
    else if (name == "mask-within")
        s.mask_choice.within = std::clamp(number, 0.0, 180.0) * kDegree;
    else if (name == "string")
        s.hand.string = std::max(0.0, number) * kMillimetre;
    else if (name == "radial")
        s.symmetry.radial = std::clamp(static_cast<int>(number), 1, 32);
    else if (name == "mirror") {
        s.symmetry.mirror_x = value.find('x') != std::string::npos;
        s.symmetry.mirror_y = value.find('y') != std::string::npos;
        s.symmetry.mirror_z = value.find('z') != std::string::npos;
    } else if (name == "tool")
        s.tool = static_cast<Tool>(one_of({"brush", "line", "curve", "writing", "eraser", "fill", "pick", "mask"}));
    else if (name == "section") {
        s.view.section = number > 0;
        s.view.section_at = std::clamp(number, 0.02, 1.0);
    } else if (name == "atlas")
        s.view.atlas = on;
    else if (name == "draw-every")
        draw_every_ = static_cast<std::size_t>(std::clamp(number, 1.0, 1000.0));
    else if (name == "guide")
        on ? start_guide(s) : void(s.help.step = -1);
    else if (name == "swipe")
        s.snapshots.swipe = number > 0, s.snapshots.line_at = std::clamp(number, 0.02, 0.98);
    else if (name == "see-through")
        s.view.see_through = on;
    else if (name == "language")
        s.wanted.language = one_of({"english", "chinese"}) ? Language::chinese : Language::english, s.restyle = true;
    else if (name == "theme")
        s.wanted.theme = one_of({"dark", "light"}) ? Theme::light : Theme::dark, s.restyle = true;
    else if (name == "scale")
        s.wanted.scale = static_cast<float>(std::clamp(number, 0.75, 3.0)), s.wanted.own_scale = true, s.restyle = true;
    else if (name == "panels")
        s.tools_shown = s.journal_shown = on;
    else
        throw Error("unknown setting '" + name + "'");
}

}  // namespace tuft::app
