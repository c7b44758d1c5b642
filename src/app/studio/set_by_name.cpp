#include "app/studio/set_by_name.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "app/panels/panels.h"
#include "core/text/units.h"

namespace tuft::app {

double number_of(const std::string& value) {
    constexpr double kMost = 1e6;
    char* end = nullptr;
    const double number = std::strtod(value.c_str(), &end);
    const bool whole = !value.empty() && end == value.c_str() + value.size();
    if (whole && !(std::abs(number) <= kMost)) throw Error(Message("'{}' is not a number within a million", value));
    return std::isfinite(number) ? number : 0;
}

namespace {

std::vector<std::string> arm_hands() {
    std::vector<std::string> names{"pointer"};
    for (const haptic::Way way : haptic::kPaintingWays) names.emplace_back(haptic::name_of(way));
    return names;
}

/// Settings of the arm; false for a name that is none of them.
bool set_arm(Session& s, const std::string& name, const std::string& value, double number) {
    ArmState& a = s.arm;
    const bool on = value == "on";
    if (name == "arm") {
        disconnect_arm(a, s.paint_thread.get());
        if (on) connect_arm(a, s.status);
    } else if (name == "arm-source")
        a.settings.source = value == "service"     ? ArmSource::service
                            : value == "recording" ? ArmSource::recording
                                                   : ArmSource::simulated;
    else if (name == "arm-preset")
        a.settings.preset = haptic::device_preset(value).name;
    else if (name == "arm-hand") {
        const std::vector<std::string> hands = arm_hands();
        if (std::find(hands.begin(), hands.end(), value) == hands.end())
            throw Error(Message("unknown hand '{}'{}", value, did_you_mean(nearest_name(value, hands))));
        a.settings.hand = value;
    } else if (name == "arm-recording")
        a.settings.recording = value;
    else if (name == "arm-port")
        a.settings.port = std::clamp(static_cast<int>(number), 0, 65535);
    else if (name == "arm-gain")
        a.settings.gain = std::clamp(number, 0.0, kMostArmGain);
    else if (name == "arm-limit")
        a.settings.most_force = std::clamp(number, 0.1, haptic::kForceLimit);
    else if (name == "arm-scale")
        a.settings.scale = std::clamp(number, kLeastArmScale, kMostArmScale);
    else if (name == "arm-view")
        a.settings.with_view = on;
    else if (name == "arm-pause")
        a.paused = on;
    else if (name == "arm-clutch")
        a.clutched = on;
    else if (name == "arm-palette")
        a.on_palette = on;
    else if (name == "arm-panel")
        a.shown = on;
    else if (name == "arm-emergency")
        on ? stop_forces(a) : release_forces(a);
    else
        return false;
    return true;
}

}  // namespace

void set_by_name(Session& s, const std::string& name, const std::string& value) {
    const double number = number_of(value);
    const bool on = value == "on";
    const auto one_of = [&](const std::vector<std::string>& names) {
        const auto at = std::find(names.begin(), names.end(), value);
        if (at != names.end()) return static_cast<int>(at - names.begin());
        const std::string near = nearest_name(value, names);
        throw Error(Message("unknown {} '{}'{}", name, value, did_you_mean(near)));
    };
    if (name == "brush")
        s.brush.preset = s.brush.presets[static_cast<std::size_t>(one_of(s.brush.presets))];
    else if (name == "brush-size")
        size_brush(s.brush, s.status, number);
    else if (name == "colour")
        set_colour(s, value);
    else if (name == "clean-ends")
        s.tools.pointer.clean_ends = on;
    else if (name == "ink" || name == "tip-ink") {
        std::vector<std::string> names = s.colours.shipped;
        for (const ink::Ink& ink : s.colours.own) names.push_back(ink.name);
        const std::string& ink = names[static_cast<std::size_t>(one_of(names))];
        name == "ink" ? s.brush.ink = ink : s.brush.tip_ink = ink;
    } else if (name == "shading")
        s.view.shading = static_cast<ModelView>(
            one_of({"glaze", "clay", "flat", "height", "wetness", "texels", "charts", "stretch"}));
    else if (name == "light")
        s.view.rig = static_cast<render::LightRig>(one_of({"studio", "window", "raking"}));
    else if (name == "keymap")
        s.preferences.keymap = one_of({"blender", "maya"}) ? Keymap::maya : Keymap::blender;
    else if (name == "left-handed")
        s.preferences.ui.left_handed = on, s.preferences.restyle = true;
    else if (name == "section-axis")
        s.view.section.axis = one_of({"x", "y", "z"});
    else if (name == "parallel")
        s.view.orbit.set_parallel(on);
    else if (name == "azimuth")
        s.view.orbit.azimuth = number * kDegree;
    else if (name == "elevation")
        s.view.orbit.elevation = number * kDegree;
    else if (name == "zoom")
        s.view.orbit.zoom(number, s.view.orbit.target);
    else if (name == "writing-width")
        s.tools.writing.scale = number * kMillimetre / std::max(1e-6, s.tools.writing.width);
    else if (name == "writing-turn")
        s.tools.writing.turn = -number * kDegree;
    else if (name == "writing-mirror")
        s.tools.writing.mirrored = on;
    else if (name == "writing-mapping")
        s.tools.writing.mapping = static_cast<stroke::SurfaceMapping>(one_of({"wrap", "drape", "project"}));
    else if (name == "export-size")
        s.dialogs.export_settings.size = static_cast<std::uint32_t>(std::clamp(number, 0.0, 16384.0));
    else if (name == "export-picture-width")
        s.dialogs.export_settings.picture_width = std::clamp(static_cast<int>(number), 16, 8192);
    else if (name == "export-pictures")
        s.dialogs.export_settings.picture = std::clamp(static_cast<int>(number), 0, 360);
    else if (name == "layer") {
        const stroke::Layer* layer = s.reported.document.layers.find(std::string_view(value));
        if (!layer) throw Error(Message("there is no layer '{}'", value));
        s.layers.active = layer->id;
    } else if (name == "texels")
        s.project.options.atlas_size = static_cast<std::uint32_t>(std::clamp(number, 64.0, 16384.0));
    else if (name == "pressure")
        s.tools.pointer.pressure = std::clamp(number, 0.02, 1.0);
    else if (name == "persistent" || name == "carry")
        s.brush.persistent = on;
    else if (name == "wet")
        s.brush.wet = on;
    else if (name == "palette")
        show_palette(s.colours.palette, s.brush, s.status, on);
    else if (name == "palette-tool")
        s.colours.palette.tool = static_cast<PaletteTool>(one_of({"brush", "pour", "pick"}));
    else if (name == "two-inks")
        s.brush.two_inks = on;
    else if (name == "tip")
        s.brush.tip_depth = std::clamp(number, 0.05, 0.9);
    else if (name == "dip-depth")
        s.brush.dip_depth = std::clamp(number, 0.05, 1.0);
    else if (name == "dip-side")
        s.brush.dip_side = std::clamp(number, -1.0, 1.0);
    else if (name == "mask-kind")
        s.masks.choice.kind = stroke::mask_kind_of(value);
    else if (name == "mask-within")
        s.masks.choice.within = std::clamp(number, 0.0, 180.0) * kDegree;
    else if (name == "roll")
        s.tools.pointer.roll = std::clamp(number, -180.0, 180.0) * kDegree;
    else if (name == "roll-follow")
        s.tools.pointer.roll_follow = on;
    else if (name == "string")
        s.tools.pointer.string = std::max(0.0, number) * kMillimetre;
    else if (name == "radial")
        s.tools.symmetry.radial = std::clamp(static_cast<int>(number), 1, 32);
    else if (name == "mirror") {
        s.tools.symmetry.mirror_x = value.find('x') != std::string::npos;
        s.tools.symmetry.mirror_y = value.find('y') != std::string::npos;
        s.tools.symmetry.mirror_z = value.find('z') != std::string::npos;
    } else if (name == "tool")
        s.tools.active =
            static_cast<Tool>(one_of({"brush", "line", "curve", "writing", "eraser", "fill", "pick", "mask"}));
    else if (name == "section") {
        s.view.section.on = number > 0;
        s.view.section.position = std::clamp(number, 0.02, 1.0);
    } else if (name == "atlas")
        s.view.atlas.shown = on;
    else if (name == "guide")
        on ? start_guide(s.panels.help) : void(s.panels.help.step = -1);
    else if (name == "swipe")
        s.journal.snapshots.swipe = number > 0, s.journal.snapshots.line_at = std::clamp(number, 0.02, 0.98);
    else if (name == "see-through")
        s.view.see_through = on;
    else if (name == "language")
        s.preferences.ui.language = one_of({"english", "chinese"}) ? Language::chinese : Language::english,
        s.preferences.restyle = true;
    else if (name == "theme")
        s.preferences.ui.theme = one_of({"dark", "light"}) ? Theme::light : Theme::dark, s.preferences.restyle = true;
    else if (name == "scale")
        s.preferences.ui.scale = static_cast<float>(std::clamp(number, 0.75, 3.0)), s.preferences.ui.own_scale = true,
        s.preferences.restyle = true;
    else if (name.starts_with("arm") && set_arm(s, name, value, number))
        return;
    else if (name == "panels")
        s.panels.show_tools = s.panels.show_journal = on;
    else
        throw Error(Message("unknown setting '{}'", name));
}

}  // namespace tuft::app
