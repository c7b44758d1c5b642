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

/// \file
/// Scripts that drive the studio, for tests and documentation. Window thread.
namespace tuft::app {

class Studio;

/// A point of the window: pixels, or fractions of the model's view.
struct ScriptPoint {
    double x = 0, y = 0;
    bool relative_x = false, relative_y = false;  ///< the coordinate is a fraction of the view, 0–1
    double pressure = -1;                         ///< 0–1 of a pen; negative: a mouse
};

/// One line of a script.
struct ScriptCommand {
    int line = 0;
    std::string name;
    std::vector<std::string> words;   ///< arguments without quotes
    std::vector<ScriptPoint> points;  ///< of `move` to a place, `stroke`
};

/// Reads a script; script_parse.cpp describes the format. Throws `Error` with file and line for an unknown command or
/// an invalid argument.
std::vector<ScriptCommand> parse_script(const std::filesystem::path& path);

/// Plays a script as input events.
class Script {
  public:
    explicit Script(const std::filesystem::path& path);

    /// Adds the events before a frame. `now`: seconds on the window's clock. Throws `Error` where an expectation fails.
    void before_frame(Studio& studio, EventQueue& events, double now);
    /// Returns whether the next frame is drawn where no window shows it; call it once a frame. It is for a screenshot,
    /// and one of `draw-every` in which the script does not only wait. The frame that ends a wait is one of these: with
    /// `draw-every` 1 each command begins on what is drawn.
    bool looks();
    /// Writes pictures after a frame of that size in pixels. `drawn`: not only its events were handled.
    void after_frame(Studio& studio, int width, int height, bool drawn);
    /// Returns the seconds that the next frame may wait: 0 while there are events to play.
    double patience(const Studio& studio) const;
    /// Returns true once when the script asks for a loss of the graphics.
    bool take_loss() { return std::exchange(wanted_.loss, false); }
    /// Returns the window size in pixels that the script asks for, once.
    std::optional<std::pair<int, int>> take_size() { return std::exchange(wanted_.size, std::nullopt); }
    bool finished() const { return next_ >= commands_.size() && pending_.empty() && wanted_.picture.empty(); }

  private:
    /// Plays events at their times instead of as fast as possible.
    struct Pace {
        bool on = false;
        double start = 0, from = 0;  ///< seconds, on the window's and on the script's clock
    };
    /// Waiting for the condition of the last command.
    struct Wait {
        bool on = false;
        double since = -1;
        ScriptPoint place;  ///< of the label to click or to move to
    };
    /// Requests to the player of the script.
    struct PlayerRequests {
        std::string picture;
        bool loss = false;
        std::optional<std::pair<int, int>> size;
    };
    struct Frames {
        std::size_t count = 0, looked = 0;  ///< all; in which it does not only wait
        std::size_t draw_every = 1;         ///< of the latter
    };
    /// State at the last report.
    struct ReportStart {
        std::size_t frames = 0;
        double start = 0, cpu = 0;
    };

    bool perform(Studio& studio, const ScriptCommand& command, double now);
    bool play(Studio& studio, const ScriptCommand& command);
    std::optional<bool> wait_for(Studio& studio, const ScriptCommand& command, double waited);
    void act(Studio& studio, const ScriptCommand& command, double now);
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
    std::deque<Event> pending_;  ///< to be played, times on the script's clock
    double sample_ = 0.004;      ///< seconds between two samples of a stroke
    double clock_ = 0;           ///< seconds, of the last event generated
    Pace pace_;
    Wait wait_;
    PlayerRequests wanted_;
    Event cursor_;
    unsigned held_ = 0;               ///< modifiers that are pressed
    std::optional<UiFuzzer> fuzzer_;  ///< while `random` plays
    std::size_t quits_ = 0;           ///< times that the fuzzer quit the program
    Frames frames_;
    ReportStart report_;
};

}  // namespace tuft::app
