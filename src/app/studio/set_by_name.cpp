#include "app/studio/set_by_name.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <span>
#include <string_view>

#include "app/panels/panels.h"
#include "core/text/units.h"
#include "writer/layout/band.h"

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

/// A setting as a script writes it.
struct SettingValue {
    const std::string& name;
    const std::string& text;
    double number = 0;  ///< at the start of the text; 0 for a word
    bool on = false;    ///< the text is "on"

    /// Returns the place of the text among `names`. Throws `Error`, with the nearest name, for none of them.
    int one_of(const std::vector<std::string>& names) const {
        const auto at = std::find(names.begin(), names.end(), text);
        if (at != names.end()) return static_cast<int>(at - names.begin());
        throw Error(Message("unknown {} '{}'{}", name, text, did_you_mean(nearest_name(text, names))));
    }
    template <class T>
    T choice(const std::vector<std::string>& names) const {
        return static_cast<T>(one_of(names));
    }
    double within(double lo, double hi) const { return std::clamp(number, lo, hi); }
    int whole(int lo, int hi) const { return std::clamp(static_cast<int>(number), lo, hi); }
};

struct Setting {
    std::string_view name;
    void (*set)(Session& s, const SettingValue& v);
};

/// Returns the name of a shipped ink or of an own one.
std::string ink_named(const Session& s, const SettingValue& v) {
    std::vector<std::string> names = s.colours.shipped;
    for (const ink::Ink& ink : s.colours.own) names.push_back(ink.name);
    return names[static_cast<std::size_t>(v.one_of(names))];
}

constexpr Setting kBrushSettings[] = {
    {"brush",
     [](Session& s, const SettingValue& v) {
         take_brush(s.brush, s.brush.presets[static_cast<std::size_t>(v.one_of(s.brush.presets))]);
     }},
    {"brush-size", [](Session& s, const SettingValue& v) { size_brush(s.brush, s.status, v.number); }},
    {"ink", [](Session& s, const SettingValue& v) { s.brush.ink = ink_named(s, v); }},
    {"tip-ink", [](Session& s, const SettingValue& v) { s.brush.tip_ink = ink_named(s, v); }},
    {"colour", [](Session& s, const SettingValue& v) { set_colour(s, v.text); }},
    {"persistent", [](Session& s, const SettingValue& v) { s.brush.persistent = v.on; }},
    {"carry", [](Session& s, const SettingValue& v) { s.brush.persistent = v.on; }},  // its name before
    {"wet", [](Session& s, const SettingValue& v) { s.brush.wet = v.on; }},
    {"two-inks", [](Session& s, const SettingValue& v) { s.brush.two_inks = v.on; }},
    {"tip", [](Session& s, const SettingValue& v) { s.brush.tip_depth = v.within(0.05, 0.9); }},
    {"dip-depth", [](Session& s, const SettingValue& v) { s.brush.dip_depth = v.within(0.05, 1); }},
    {"dip-side", [](Session& s, const SettingValue& v) { s.brush.dip_side = v.within(-1, 1); }},
    {"palette", [](Session& s, const SettingValue& v) { show_palette(s.colours.palette, s.brush, s.status, v.on); }},
    {"palette-tool",
     [](Session& s, const SettingValue& v) {
         s.colours.palette.tool = v.choice<PaletteTool>({"brush", "pour", "pick"});
     }},
};

constexpr Setting kToolSettings[] = {
    {"tool",
     [](Session& s, const SettingValue& v) {
         s.tools.active =
             v.choice<Tool>({"brush", "line", "curve", "writing", "text", "eraser", "fill", "pick", "mask"});
     }},
    {"clean-ends", [](Session& s, const SettingValue& v) { s.tools.pointer.clean_ends = v.on; }},
    {"pressure", [](Session& s, const SettingValue& v) { s.tools.pointer.pressure = v.within(0.02, 1); }},
    {"roll", [](Session& s, const SettingValue& v) { s.tools.pointer.roll = v.within(-180, 180) * kDegree; }},
    {"roll-follow", [](Session& s, const SettingValue& v) { s.tools.pointer.roll_follow = v.on; }},
    {"string",
     [](Session& s, const SettingValue& v) { s.tools.pointer.string = std::max(0.0, v.number) * kMillimetre; }},
    {"radial", [](Session& s, const SettingValue& v) { s.tools.symmetry.radial = v.whole(1, 32); }},
    {"mirror",
     [](Session& s, const SettingValue& v) {
         s.tools.symmetry.mirror_x = v.text.find('x') != std::string::npos;
         s.tools.symmetry.mirror_y = v.text.find('y') != std::string::npos;
         s.tools.symmetry.mirror_z = v.text.find('z') != std::string::npos;
     }},
    {"writing-width",
     [](Session& s, const SettingValue& v) {
         s.tools.writing.scale = v.number * kMillimetre / std::max(1e-6, s.tools.writing.form().width);
     }},
    {"writing-turn", [](Session& s, const SettingValue& v) { s.tools.writing.turn = -v.number * kDegree; }},
    {"writing-mirror", [](Session& s, const SettingValue& v) { s.tools.writing.mirrored = v.on; }},
    {"writing-mapping",
     [](Session& s, const SettingValue& v) {
         s.tools.writing.mapping = v.choice<stroke::SurfaceMapping>({"wrap", "drape", "project"});
     }},
    {"writing-along",
     [](Session& s, const SettingValue& v) {
         s.tools.writing.along = v.choice<BandLine>({"none", "edge", "rim", "curve"});
     }},
    {"writing-repeat",
     [](Session& s, const SettingValue& v) { s.tools.writing.repeats = v.whole(0, writer::kMostCopies); }},
    {"text", [](Session& s, const SettingValue& v) { set_text(s.tools.lettering, v.text); }},
    {"text-style", [](Session& s, const SettingValue& v) { s.tools.lettering.wanted.style = v.text; }},
    {"text-glyphs", [](Session& s, const SettingValue& v) { s.tools.lettering.wanted.glyphs = v.text; }},
    {"text-direction",
     [](Session& s, const SettingValue& v) {
         s.tools.lettering.direction =
             v.choice<writer::Direction>({writer::kDirectionNames.begin(), writer::kDirectionNames.end()});
     }},
    {"text-size", [](Session& s, const SettingValue& v) { s.tools.lettering.side = v.within(1, 2000) * kMillimetre; }},
    {"text-spacing", [](Session& s, const SettingValue& v) { s.tools.lettering.spacing.characters = v.within(0, 10); }},
    {"text-line-spacing", [](Session& s, const SettingValue& v) { s.tools.lettering.spacing.lines = v.within(0, 10); }},
    {"text-turn", [](Session& s, const SettingValue& v) { s.tools.lettering.turn = -v.number * kDegree; }},
    {"text-brush",
     [](Session& s, const SettingValue& v) {
         s.tools.lettering.style_brush = v.one_of({"chosen", "style"}) == 1;
     }},
    {"text-like", [](Session& s, const SettingValue& v) { copy_picture(s.tools.lettering, v.text); }},
    {"copy-threshold",
     [](Session& s, const SettingValue& v) {
         slide_threshold(copy_to_edit(s.tools.lettering), v.within(-writer::kMostThreshold, writer::kMostThreshold));
     }},
    {"copy-cut",
     [](Session& s, const SettingValue& v) {
         writer::CopyCorrection next = s.tools.lettering.wanted.correction;
         next.cuts = writer::parse_cuts(v.text);
         correct(copy_to_edit(s.tools.lettering), std::move(next));
     }},
    {"copy-order",
     [](Session& s, const SettingValue& v) {
         writer::CopyCorrection next = s.tools.lettering.wanted.correction;
         next.order = v.text;
         correct(copy_to_edit(s.tools.lettering), std::move(next));
     }},
    {"text-fit", [](Session& s, const SettingValue& v) { s.tools.lettering.wanted.fit = v.on; }},
    {"mask-kind", [](Session& s, const SettingValue& v) { s.masks.choice.kind = stroke::mask_kind_of(v.text); }},
    {"mask-within", [](Session& s, const SettingValue& v) { s.masks.choice.within = v.within(0, 180) * kDegree; }},
    {"layer",
     [](Session& s, const SettingValue& v) {
         const stroke::Layer* layer = s.reported.document.layers.find(std::string_view(v.text));
         if (!layer) throw Error(Message("there is no layer '{}'", v.text));
         s.layers.active = layer->id;
     }},
};

constexpr Setting kViewSettings[] = {
    {"shading",
     [](Session& s, const SettingValue& v) {
         s.view.shading =
             v.choice<ModelView>({"glaze", "clay", "flat", "height", "wetness", "texels", "charts", "stretch"});
     }},
    {"light",
     [](Session& s, const SettingValue& v) {
         s.view.rig = v.choice<render::LightRig>({"studio", "window", "raking"});
     }},
    {"parallel", [](Session& s, const SettingValue& v) { s.view.orbit.set_parallel(v.on); }},
    {"azimuth", [](Session& s, const SettingValue& v) { s.view.orbit.azimuth = v.number * kDegree; }},
    {"elevation", [](Session& s, const SettingValue& v) { s.view.orbit.elevation = v.number * kDegree; }},
    {"zoom", [](Session& s, const SettingValue& v) { s.view.orbit.zoom(v.number, s.view.orbit.target); }},
    {"section",
     [](Session& s, const SettingValue& v) {
         s.view.section.on = v.number > 0;
         s.view.section.position = v.within(0.02, 1);
     }},
    {"section-axis",
     [](Session& s, const SettingValue& v) {
         s.view.section.axis = v.one_of({"x", "y", "z"});
     }},
    {"see-through", [](Session& s, const SettingValue& v) { s.view.see_through = v.on; }},
    {"atlas", [](Session& s, const SettingValue& v) { s.view.atlas.shown = v.on; }},
    {"swipe",
     [](Session& s, const SettingValue& v) {
         s.journal.snapshots.swipe = v.number > 0;
         s.journal.snapshots.line_at = v.within(0.02, 0.98);
     }},
    {"panels", [](Session& s, const SettingValue& v) { s.panels.show_tools = s.panels.show_journal = v.on; }},
    {"guide",
     [](Session& s, const SettingValue& v) { v.on ? start_guide(s.panels.help) : void(s.panels.help.step = -1); }},
};

constexpr Setting kPreferenceSettings[] = {
    {"keymap",
     [](Session& s, const SettingValue& v) {
         s.preferences.keymap = v.one_of({"blender", "maya"}) ? Keymap::maya : Keymap::blender;
     }},
    {"left-handed",
     [](Session& s, const SettingValue& v) { s.preferences.ui.left_handed = v.on, s.preferences.restyle = true; }},
    {"language",
     [](Session& s, const SettingValue& v) {
         s.preferences.ui.language = v.one_of({"english", "chinese"}) ? Language::chinese : Language::english;
         s.preferences.restyle = true;
     }},
    {"theme",
     [](Session& s, const SettingValue& v) {
         s.preferences.ui.theme = v.one_of({"dark", "light"}) ? Theme::light : Theme::dark;
         s.preferences.restyle = true;
     }},
    {"scale",
     [](Session& s, const SettingValue& v) {
         s.preferences.ui.scale = static_cast<float>(v.within(0.75, 3));
         s.preferences.ui.own_scale = s.preferences.restyle = true;
     }},
    {"texels",
     [](Session& s, const SettingValue& v) {
         s.project.options.atlas_size = static_cast<std::uint32_t>(v.within(64, 16384));
     }},
    {"export-size",
     [](Session& s, const SettingValue& v) {
         s.dialogs.export_settings.size = static_cast<std::uint32_t>(v.within(0, 16384));
     }},
    {"export-pictures", [](Session& s, const SettingValue& v) { s.dialogs.export_settings.picture = v.whole(0, 360); }},
    {"export-picture-width",
     [](Session& s, const SettingValue& v) { s.dialogs.export_settings.picture_width = v.whole(16, 8192); }},
    {"film-width",
     [](Session& s, const SettingValue& v) {
         s.dialogs.film_settings.width = v.whole(32, 3840);
         s.dialogs.film_settings.height = s.dialogs.film_settings.width * 9 / 16;
     }},
    {"film-seconds", [](Session& s, const SettingValue& v) { s.dialogs.film_settings.seconds = v.within(0.1, 3600); }},
};

constexpr Setting kArmSettings[] = {
    {"arm",
     [](Session& s, const SettingValue& v) {
         disconnect_arm(s.arm, s.paint_thread.get());
         if (v.on) connect_arm(s.arm, s.status);
     }},
    {"arm-source",
     [](Session& s, const SettingValue& v) {
         s.arm.settings.source = v.choice<ArmSource>({"simulated", "service", "recording"});
     }},
    {"arm-preset",
     [](Session& s, const SettingValue& v) { s.arm.settings.preset = haptic::device_preset(v.text).name; }},
    {"arm-hand",
     [](Session& s, const SettingValue& v) {
         std::vector<std::string> hands{"pointer"};
         for (const haptic::HandMotion motion : haptic::kPaintingMotions) hands.emplace_back(haptic::name_of(motion));
         s.arm.settings.hand = hands[static_cast<std::size_t>(v.one_of(hands))];
     }},
    {"arm-recording", [](Session& s, const SettingValue& v) { s.arm.settings.recording = v.text; }},
    {"arm-port", [](Session& s, const SettingValue& v) { s.arm.settings.port = v.whole(0, 65535); }},
    {"arm-gain", [](Session& s, const SettingValue& v) { s.arm.settings.gain = v.within(0, kMostArmGain); }},
    {"arm-limit",
     [](Session& s, const SettingValue& v) { s.arm.settings.most_force = v.within(0.1, haptic::kForceLimit); }},
    {"arm-proximity",
     [](Session& s, const SettingValue& v) { s.arm.settings.proximity = v.within(0, kMostArmProximity); }},
    {"arm-scale",
     [](Session& s, const SettingValue& v) { s.arm.settings.scale = v.within(kLeastArmScale, kMostArmScale); }},
    {"arm-view", [](Session& s, const SettingValue& v) { s.arm.settings.with_view = v.on; }},
    {"arm-pause", [](Session& s, const SettingValue& v) { s.arm.paused = v.on; }},
    {"arm-clutch", [](Session& s, const SettingValue& v) { s.arm.clutched = v.on; }},
    {"arm-palette", [](Session& s, const SettingValue& v) { s.arm.on_palette = v.on; }},
    {"arm-panel", [](Session& s, const SettingValue& v) { s.arm.shown = v.on; }},
    {"arm-emergency", [](Session& s, const SettingValue& v) { v.on ? stop_forces(s.arm) : release_forces(s.arm); }},
};

}  // namespace

void set_by_name(Session& s, const std::string& name, const std::string& value) {
    const SettingValue v{.name = name, .text = value, .number = number_of(value), .on = value == "on"};
    const std::span<const Setting> groups[] = {kBrushSettings, kToolSettings, kViewSettings, kPreferenceSettings,
                                               kArmSettings};
    for (const std::span<const Setting> group : groups)
        for (const Setting& setting : group)
            if (setting.name == name) return setting.set(s, v);
    throw Error(Message("unknown setting '{}'", name));
}

}  // namespace tuft::app
