#include "app/session/settings_file.h"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "core/files/files.h"

namespace tuft::app {
namespace {

// Settings are pairs of words: blanks in a title become '_'.
std::string as_word(std::string title) {
    std::replace(title.begin(), title.end(), ' ', '_');
    return title;
}

std::string from_word(std::string word) {
    std::replace(word.begin(), word.end(), '_', ' ');
    return word;
}

double number_within(const std::string& text, double lo, double hi) {
    const double number = std::atof(text.c_str());
    return number >= lo ? std::min(number, hi) : lo;  // NaN, too, becomes `lo`
}

void load_arm(ArmState& arm, const std::string& key, const std::string& value) {
    ArmSettings& a = arm.settings;
    if (key == "arm_source")
        a.source = static_cast<ArmSource>(static_cast<int>(number_within(value, 0, 2)));
    else if (key == "arm_preset") {
        for (const haptic::DeviceLimits& preset : haptic::device_presets())
            if (preset.name == value) a.preset = value;
    } else if (key == "arm_host")
        a.host = value;
    else if (key == "arm_port")
        a.port = static_cast<int>(number_within(value, 0, 65535));
    else if (key == "arm_gain")
        a.gain = number_within(value, 0, kMostArmGain);
    else if (key == "arm_limit")
        a.most_force = number_within(value, 0.1, haptic::kForceLimit);
    else if (key == "arm_proximity")
        a.proximity = number_within(value, 0, kMostArmProximity);
    else if (key == "arm_scale")
        a.scale = number_within(value, kLeastArmScale, kMostArmScale);
    else if (key == "arm_view")
        a.with_view = value == "1";
    else if (key == "arm_restore")
        a.restore = value == "1";
    else if (const std::size_t axis = std::string("xyz").find(key.back()); key.starts_with("arm_centre_"))
        if (axis < 3) a.centre[static_cast<int>(axis)] = number_within(value, -1, 1);
}

void store_arm(const ArmState& arm, std::ostream& out) {
    const ArmSettings& a = arm.settings;
    out << "arm_source " << static_cast<int>(a.source) << "\narm_preset " << a.preset << "\narm_host " << a.host
        << "\narm_port " << a.port << "\narm_gain " << a.gain << "\narm_limit " << a.most_force << "\narm_scale "
        << a.scale << "\narm_view " << a.with_view << "\narm_restore " << a.restore << "\narm_proximity " << a.proximity
        << '\n';
    for (int i = 0; i < 3; ++i)
        out << "arm_centre_"
            << "xyz"[i] << ' ' << a.centre[i] << '\n';
}

}  // namespace

void load_settings(Session& s) {
    std::ifstream in(state_folder() / "settings");
    for (std::string key, value; in >> key >> value;) {
        if (key == "language")
            s.preferences.ui.language = value == "chinese" ? Language::chinese : Language::english;
        else if (key == "theme")
            s.preferences.ui.theme = value == "light" ? Theme::light : Theme::dark;
        else if (key == "own_scale") {
            s.preferences.ui.scale = static_cast<float>(number_within(value, 0.75, 3));
            s.preferences.ui.own_scale = true;
        } else if (key == "guide_seen")
            s.panels.help.seen = value == "1";
        else if (key == "panels") {
            s.panels.show_tools = value.find('t') != std::string::npos;
            s.panels.show_journal = value.find('j') != std::string::npos;
        } else if (key.rfind("section:", 0) == 0)
            s.ui.sections[from_word(key.substr(8))] = value == "1";
        else if (key == "left_handed")
            s.preferences.ui.left_handed = value == "1";
        else if (key.rfind("key:", 0) == 0)
            s.preferences.keys.restore(key.substr(4), value);
        else if (key == "pen_least")
            s.tools.pointer.pen_least = number_within(value, 0.0, 0.9);
        else if (key == "pen_full")
            s.tools.pointer.pen_full = number_within(value, s.tools.pointer.pen_least + 0.1, 1.0);
        else if (key == "pen_gamma")
            s.tools.pointer.pen_gamma = number_within(value, 0.25, 4.0);
        else if (key == "cap_speed")
            s.preferences.space_mouse.speed = number_within(value, 0.1, 4.0);
        else if (key == "cap_level")
            s.preferences.space_mouse.level = value == "1";
        else if (key == "cap_eye")
            s.preferences.space_mouse.moves_eye = value == "1";
        else if (key == "clean_ends")
            s.tools.pointer.clean_ends = value == "1";
        else if (key.starts_with("arm_"))
            load_arm(s.arm, key, value);
        else if (key == "keymap")
            s.preferences.keymap = value == "maya" ? Keymap::maya : Keymap::blender;
    }
}

void store_settings(const Session& s) {
    std::ostringstream out;
    out << "language " << (s.preferences.ui.language == Language::chinese ? "chinese" : "english") << "\ntheme "
        << (s.preferences.ui.theme == Theme::light ? "light" : "dark") << "\nleft_handed "
        << s.preferences.ui.left_handed << "\nkeymap " << (s.preferences.keymap == Keymap::maya ? "maya" : "blender")
        << "\npen_least " << s.tools.pointer.pen_least << "\npen_full " << s.tools.pointer.pen_full << "\npen_gamma "
        << s.tools.pointer.pen_gamma << "\ncap_speed " << s.preferences.space_mouse.speed << "\ncap_level "
        << s.preferences.space_mouse.level << "\ncap_eye " << s.preferences.space_mouse.moves_eye << "\nclean_ends "
        << s.tools.pointer.clean_ends << '\n';
    if (s.preferences.ui.own_scale) out << "own_scale " << s.preferences.ui.scale << '\n';
    out << "guide_seen " << s.panels.help.seen << "\n";
    out << "panels -" << (s.panels.show_tools ? "t" : "") << (s.panels.show_journal ? "j" : "") << '\n';
    for (const auto& [title, open] : s.ui.sections) out << "section:" << as_word(title) << ' ' << open << '\n';
    store_arm(s.arm, out);
    for (const auto& [word, chord] : s.preferences.keys.changes()) out << "key:" << word << ' ' << chord << '\n';
    const std::string text = out.str();
    try {
        write_file(state_folder() / "settings", text.data(), text.size());
    } catch (const Error&) {
        // They hold for this run then.
    }
}

void fold_panels(Session& s) {
    s.panels.show_tools = s.panels.show_journal = !(s.panels.show_tools || s.panels.show_journal);
    store_settings(s);
}

}  // namespace tuft::app
