#include "app/input/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include <algorithm>
#include <array>
#include <cctype>

#include "app/input/events.h"

namespace tuft::app {
namespace {

struct Shipped {
    const char *word, *title;
    Chord chord;
};

constexpr std::array<Shipped, static_cast<std::size_t>(Action::count)> kShipped{{
    {"open", "Open", {GLFW_KEY_O, kControl}},
    {"save", "Save as", {GLFW_KEY_S, kControl}},
    {"export", "Export", {GLFW_KEY_E, kControl}},
    {"quit", "Quit", {GLFW_KEY_Q, kControl}},
    {"keys", "Keys and mouse", {GLFW_KEY_F1, 0}},
    {"undo", "Undo", {GLFW_KEY_Z, kControl}},
    {"redo", "Redo", {GLFW_KEY_Z, kControl | kShift}},
    {"delete", "Delete the chosen stroke", {GLFW_KEY_DELETE, 0}},
    {"brush", "Brush", {GLFW_KEY_B, 0}},
    {"line", "Line", {GLFW_KEY_L, 0}},
    {"curve", "Curve", {GLFW_KEY_C, 0}},
    {"place", "Place writing", {GLFW_KEY_T, 0}},
    {"write", "Write", {GLFW_KEY_W, 0}},
    {"eraser", "Eraser", {GLFW_KEY_E, 0}},
    {"fill", "Fill", {GLFW_KEY_G, 0}},
    {"pick", "Pick", {GLFW_KEY_I, 0}},
    {"mask", "Mask", {GLFW_KEY_M, 0}},
    {"lighter", "Press less", {GLFW_KEY_LEFT_BRACKET, 0}},
    {"heavier", "Press more", {GLFW_KEY_RIGHT_BRACKET, 0}},
    {"smaller", "Smaller brush", {GLFW_KEY_LEFT_BRACKET, kShift}},
    {"larger", "Larger brush", {GLFW_KEY_RIGHT_BRACKET, kShift}},
    {"lean-left", "Lean to the left", {GLFW_KEY_LEFT, 0}},
    {"lean-right", "Lean to the right", {GLFW_KEY_RIGHT, 0}},
    {"lean-away", "Lean away", {GLFW_KEY_UP, 0}},
    {"lean-near", "Lean nearer", {GLFW_KEY_DOWN, 0}},
    {"upright", "Hold it upright", {GLFW_KEY_BACKSLASH, 0}},
    {"roll-anticlockwise", "Roll anticlockwise", {GLFW_KEY_LEFT, kShift}},
    {"roll-clockwise", "Roll clockwise", {GLFW_KEY_RIGHT, kShift}},
    {"frame-all", "Frame all", {GLFW_KEY_HOME, 0}},
    {"frame-cursor", "Frame the cursor", {GLFW_KEY_PERIOD, 0}},
    {"front", "Front", {GLFW_KEY_1, 0}},
    {"back", "Back", {GLFW_KEY_1, kControl}},
    {"right", "Right", {GLFW_KEY_3, 0}},
    {"left", "Left", {GLFW_KEY_3, kControl}},
    {"top", "Top", {GLFW_KEY_7, 0}},
    {"bottom", "Bottom", {GLFW_KEY_7, kControl}},
    {"parallel", "Parallel projection", {GLFW_KEY_5, 0}},
    {"see-through", "See through the brush", {GLFW_KEY_X, 0}},
    {"atlas", "Atlas beside the model", {GLFW_KEY_U, 0}},
    {"palette", "Palette", {GLFW_KEY_P, 0}},
    {"next-shading", "Next shading of the model", {GLFW_KEY_V, 0}},
    {"panels", "Fold the panels", {GLFW_KEY_TAB, 0}},
    {"arm", "Force-feedback arm", {GLFW_KEY_A, 0}},
    {"stop-arm", "Stop the arm's forces", {GLFW_KEY_SPACE, 0}},
}};

constexpr std::pair<int, const char*> kNames[] = {{GLFW_KEY_SPACE, "Space"},
                                                  {GLFW_KEY_ESCAPE, "Esc"},
                                                  {GLFW_KEY_ENTER, "Enter"},
                                                  {GLFW_KEY_TAB, "Tab"},
                                                  {GLFW_KEY_BACKSPACE, "Backspace"},
                                                  {GLFW_KEY_INSERT, "Insert"},
                                                  {GLFW_KEY_DELETE, "Delete"},
                                                  {GLFW_KEY_RIGHT, "Right"},
                                                  {GLFW_KEY_LEFT, "Left"},
                                                  {GLFW_KEY_DOWN, "Down"},
                                                  {GLFW_KEY_UP, "Up"},
                                                  {GLFW_KEY_PAGE_UP, "PageUp"},
                                                  {GLFW_KEY_PAGE_DOWN, "PageDown"},
                                                  {GLFW_KEY_HOME, "Home"},
                                                  {GLFW_KEY_END, "End"}};

// Keys of the number pad do what the same keys above the letters do.
int plain(int key) {
    if (key >= GLFW_KEY_KP_0 && key <= GLFW_KEY_KP_9) return GLFW_KEY_0 + key - GLFW_KEY_KP_0;
    if (key == GLFW_KEY_KP_DECIMAL) return GLFW_KEY_PERIOD;
    if (key == GLFW_KEY_KP_ENTER) return GLFW_KEY_ENTER;
    return key;
}

}  // namespace

const char* title_of(Action action) {
    return kShipped[static_cast<std::size_t>(action)].title;
}
const char* word_of(Action action) {
    return kShipped[static_cast<std::size_t>(action)].word;
}

std::string name_of(const Chord& chord) {
    if (chord.key == 0) return "";
    std::string out;
    if (chord.modifiers & kControl) out += "Ctrl+";
    if (chord.modifiers & kShift) out += "Shift+";
    if (chord.modifiers & kAlt) out += "Alt+";
    for (const auto& [key, name] : kNames)
        if (key == chord.key) return out + name;
    if (chord.key >= GLFW_KEY_F1 && chord.key <= GLFW_KEY_F25)
        return out + "F" + std::to_string(chord.key - GLFW_KEY_F1 + 1);
    if (chord.key > ' ' && chord.key < 127) return out + static_cast<char>(chord.key);
    return "";
}

std::optional<Chord> chord_of(const std::string& name) {
    Chord chord;
    std::string rest = name;
    for (const auto& [word, bit] : {std::pair{"Ctrl+", kControl}, std::pair{"Shift+", kShift}, std::pair{"Alt+", kAlt}})
        if (rest.rfind(word, 0) == 0 && rest.size() > std::string(word).size()) {
            chord.modifiers |= bit;
            rest = rest.substr(std::string(word).size());
        }
    for (const auto& [key, text] : kNames)
        if (rest == text) chord.key = key;
    if (rest.size() == 1 && rest[0] > ' ' && rest[0] < 127)
        chord.key = std::toupper(static_cast<unsigned char>(rest[0]));
    if (rest.size() > 1 && rest[0] == 'F')
        for (int i = 1; i <= 25; ++i)
            if (rest == "F" + std::to_string(i)) chord.key = GLFW_KEY_F1 + i - 1;
    if (chord.key == 0) return std::nullopt;
    return chord;
}

KeyTable::KeyTable() {
    for (std::size_t i = 0; i < kShipped.size(); ++i) chords_[static_cast<Action>(i)] = kShipped[i].chord;
}

std::optional<Action> KeyTable::find(const Chord& chord) const {
    const Chord wanted{plain(chord.key), chord.modifiers};
    for (const auto& [action, own] : chords_)
        if (own.key != 0 && own == wanted) return action;
    // The usual second key for redo, unless somebody gave it away.
    if (wanted == Chord{GLFW_KEY_Y, kControl}) return Action::redo;
    return std::nullopt;
}

std::optional<Action> KeyTable::assign(Action action, const Chord& chord) {
    const Chord wanted{plain(chord.key), chord.modifiers};
    std::optional<Action> other;
    for (auto& [owner, own] : chords_)
        if (owner != action && own == wanted && own.key != 0) {
            own = {};
            other = owner;
        }
    chords_[action] = wanted;
    return other;
}

std::vector<std::pair<std::string, std::string>> KeyTable::changes() const {
    std::vector<std::pair<std::string, std::string>> out;
    for (const auto& [action, chord] : chords_)
        if (chord != kShipped[static_cast<std::size_t>(action)].chord)
            out.emplace_back(word_of(action), chord.key ? name_of(chord) : "none");
    return out;
}

void KeyTable::restore(const std::string& word, const std::string& chord) {
    for (std::size_t i = 0; i < kShipped.size(); ++i)
        if (word == kShipped[i].word) {
            if (chord == "none")
                chords_[static_cast<Action>(i)] = {};
            else if (const auto read = chord_of(chord))
                chords_[static_cast<Action>(i)] = *read;
        }
}

}  // namespace tuft::app
