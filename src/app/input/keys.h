#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

/// Which key does what; a person can change it.
namespace tuft::app {

enum class Act {
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
    count
};

/// A key with Ctrl, Shift and Alt (`Modifier` bits).
struct Chord {
    int key = 0;  ///< GLFW key code; 0: none
    unsigned modifiers = 0;
    bool operator==(const Chord&) const = default;
};

/// "Ctrl+Shift+Z", "Home", "["; and back, nothing for an unknown key.
std::string name_of(const Chord& chord);
std::optional<Chord> chord_of(const std::string& name);

/// English name for people, and the word in the settings file.
const char* title_of(Act act);
const char* word_of(Act act);

class KeyTable {
  public:
    KeyTable();  ///< as shipped
    std::optional<Act> find(const Chord& chord) const;
    Chord chord(Act act) const { return chords_.at(act); }
    /// Gives an action a key; another one that had it goes without. Returns that other one.
    std::optional<Act> assign(Act act, const Chord& chord);
    bool shipped() const { return chords_ == KeyTable().chords_; }
    /// Lines "word chord" of what differs from the shipped keys; and back, unknown lines skipped.
    std::vector<std::pair<std::string, std::string>> changes() const;
    void restore(const std::string& word, const std::string& chord);

  private:
    std::map<Act, Chord> chords_;
};

}  // namespace tuft::app
