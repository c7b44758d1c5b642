#pragma once

#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "app/input/events.h"
#include "app/script/ui_fuzzer.h"
#include "core/message.h"

namespace tuft::app {

class Studio;

/// A place in the window: pixels, or parts of the model's view.
struct ScriptPoint {
    double x = 0, y = 0;
    bool relative_x = false, relative_y = false;  ///< in [0, 1] of the view
    double pressure = -1;                         ///< of a pen; below 0: a mouse
};

/// One line of a script.
struct ScriptCommand {
    int line = 0;
    std::string name;
    std::vector<std::string> words;   ///< arguments, quotes taken off
    std::vector<ScriptPoint> points;  ///< of `move`, `stroke`
};

/// Reads a script; the format is described in script_parse.cpp. Throws `Error` with file
/// and line for an unknown command or a wrong argument.
std::vector<ScriptCommand> parse_script(const std::filesystem::path& path);

/// Plays a script as if a person did it.
class Script {
  public:
    explicit Script(const std::filesystem::path& path);

    /// Before a frame: adds events. Throws `Error` where the script does not hold.
    void before_frame(Studio& studio, EventQueue& events, double now);
    /// After a frame: pictures.
    void after_frame(Studio& studio, int width, int height);
    /// Seconds that the next frame may wait: none while there is something to play.
    double patience(const Studio& studio) const;
    /// Whether the script wants the graphics to be lost now.
    bool take_loss() { return std::exchange(wanted_.loss, false); }
    /// The size in pixels that the script wants the window to have now.
    std::optional<std::pair<int, int>> take_size() { return std::exchange(wanted_.size, std::nullopt); }
    bool finished() const { return next_ >= commands_.size() && pending_.empty() && wanted_.picture.empty(); }

  private:
    /// Events come when their time has come.
    struct Pace {
        bool on = false;
        double start = 0, from = 0;  ///< seconds, on the window's and on the script's clock
    };
    /// For what the last command needs.
    struct Wait {
        bool on = false;
        double since = -1;
        ScriptPoint place;  ///< of the label that a click needs
    };
    /// From who plays the script.
    struct Wanted {
        std::string picture;
        bool loss = false;
        std::optional<std::pair<int, int>> size;
    };
    /// As things were at the last report.
    struct ReportStart {
        std::size_t frames = 0;
        double start = 0, cpu = 0;
    };

    bool perform(Studio& studio, const ScriptCommand& command, double now);
    void expect(Studio& studio, const ScriptCommand& command) const;
    void stroke(Studio& studio, const ScriptCommand& command);
    void press_key(const std::string& chord, int line);
    void hold(const std::string& chord, int line);
    void click(double x, double y, int button = 0);
    void add(Event event, double after);
    void report(Studio& studio, double now);
    [[noreturn]] void fail(const ScriptCommand& command, const Message& why) const;

    std::filesystem::path path_;
    std::vector<ScriptCommand> commands_;
    std::size_t next_ = 0;
    std::deque<Event> pending_;  ///< to be played, by time on the script's clock
    double sample_ = 0.004;      ///< seconds between two samples of a stroke
    double clock_ = 0;           ///< seconds, of the last event made
    Pace pace_;
    Wait wait_;
    Wanted wanted_;
    Event cursor_;
    unsigned held_ = 0;               ///< modifiers
    std::optional<UiFuzzer> fuzzer_;  ///< while `random` plays
    std::size_t quits_ = 0;           ///< times that it would have ended the program
    std::size_t frames_ = 0;
    ReportStart report_;
};

}  // namespace tuft::app
