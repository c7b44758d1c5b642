#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

/// \file
/// Key bindings, which the user can change. Window thread.
namespace tuft::app {

/// Actions that a key can have.
enum class Action {
    open,
    save,
    export_to,
    quit,
    keys,
    undo,
    redo,
    delete_stroke,
    brush,
    line,
    curve,
    writing,
    text,
    eraser,
    fill,
    pick,
    mask,
    lighter,
    heavier,
    smaller,
    larger,
    lean_left,
    lean_right,
    lean_away,
    lean_near,
    upright,
    roll_anticlockwise,
    roll_clockwise,
    frame_all,
    frame_cursor,
    front,
    back,
    right,
    left,
    top,
    bottom,
    parallel,
    see_through,
    atlas,
    palette,
    next_shading,
    panels,
    arm,
    stop_arm,
    count
};

/// A key with modifiers (`Modifier` bits).
struct Chord {
    int key = 0;  ///< GLFW key code; 0: none
    unsigned modifiers = 0;
    bool operator==(const Chord&) const = default;
};

/// Converts between a chord and its name: "Ctrl+Shift+Z", "Home", "[". `chord_of` returns nothing for an unknown key.
std::string name_of(const Chord& chord);
std::optional<Chord> chord_of(const std::string& name);

/// English title for the user, and the action's word in the settings file.
const char* title_of(Action action);
const char* word_of(Action action);

/// Chord of each action. It begins with the shipped keys.
class KeyTable {
  public:
    KeyTable();
    /// Returns the action of a chord.
    std::optional<Action> find(const Chord& chord) const;
    Chord chord(Action action) const { return chords_.at(action); }
    /// Gives an action a key. Another action with that key loses it and is returned.
    std::optional<Action> assign(Action action, const Chord& chord);
    bool shipped() const { return chords_ == KeyTable().chords_; }
    /// Returns (word, chord) of the keys that differ from the shipped ones. `restore` reads one; it skips unknown ones.
    std::vector<std::pair<std::string, std::string>> changes() const;
    void restore(const std::string& word, const std::string& chord);

  private:
    std::map<Action, Chord> chords_;
};

}  // namespace tuft::app
