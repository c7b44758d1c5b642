#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "app/script/script.h"
#include "core/error.h"
#include "core/files/files.h"

/// Script format: one command a line, words separated by blanks, "quoted" where they hold
/// blanks; # begins a comment. Places are X,Y in pixels of the window, or in per cent of the
/// model's view (40%,55%); a third number is a pen's pressure.
///
///   open FILE               as if it was dropped on the window
///   revise FILE             as if it was chosen as the revised model
///   wait-ready [SECONDS]    until nothing runs in the background, that long at most (120)
///   wait SECONDS
///   move PLACE | LABEL      the cursor; a word with a comma is a place
///   press [left|right|middle]     release [left|right|middle]
///   stroke PLACE PLACE ...  pen down at the first, along straight lines, up at the last
///   rate HERTZ              samples a second of strokes (250)
///   key CHORD               such as ctrl+shift+z, f1, home, [
///   hold CHORD              ctrl, shift, alt or some of them (ctrl+alt) stay pressed from here on; hold none: let go
///   type TEXT
///   scroll STEPS
///   click LABEL             the button, entry or menu of that English name
///   right-click LABEL       the same with the right button, for its menu
///   set NAME VALUE          texels (of the model asked about), brush, brush-size, ink, colour (#rrggbb), clean-ends,
///   shading, light, parallel, azimuth, elevation, zoom,
///                           layer, export-size, export-pictures,
///                           export-picture-width, film-width (pixels), film-seconds, pressure, writing-width (mm),
///                           writing-turn (degrees, anticlockwise), writing-mirror, writing-mapping, writing-along
///                           (none, edge, rim, curve), writing-repeat (0: as many as fit), roll (degrees,
///                           anticlockwise), roll-follow, string, radial, mirror, persistent, tool, language, theme,
///                           text, text-style, text-glyphs (file or folder; "" for the shipped characters),
///                           text-direction (horizontal, vertical, rim, curve), text-size (mm), text-spacing,
///                           text-line-spacing, text-turn (degrees, anticlockwise), text-brush (chosen, style),
///                           text-fit, text-like (picture of a character), copy-threshold, copy-cut, copy-order (of
///                           its strokes, as the options of tuft write say them),
///                           arm (on, off), arm-source (simulated, service, recording), arm-preset, arm-hand,
///                           arm-recording, arm-port, arm-gain, arm-limit (N), arm-scale, arm-view (on, off),
///                           arm-pause, arm-clutch, arm-palette, arm-panel, arm-emergency (on, off), scale,
///                           left-handed, keymap, section, section-axis, see-through, atlas, draw-every (frames of
///                           which one is drawn without a window, for tests; all screenshots are)
///   undo  redo  save FILE  export FILE  close
///   screenshot FILE.png
///   expect strokes N | expect model | expect no-model | expect kept | expect message TEXT | expect label LABEL
///   expect arm off|waiting|free|engaged|painting|stopping|stopped | expect force N (newtons, at least)
///   await ...               until that holds
///   focus  unfocus          the window gets or loses the keyboard
///   pace on|off             events at the speed of the clock, or at once
///   resize WIDTH HEIGHT     the window, pixels
///   random COUNT SEED       that many events of any kind, also resizing and lost graphics; what would end the
///                           program is only counted
///   report                  frames drawn, seconds, delays from each sample to its ink on the screen and processor
///                           time since the last one, the time of the last undo, the peak of memory and where the view
///                           is, on standard output. Without a window, frames in which the script only waits and those
///                           that draw-every leaves out are not drawn
///   lose-graphics           as if the graphics driver had been reset
///   names                   labels that can be clicked, on standard output
///   places                  the same after the pixels where each lies
///   quit
namespace tuft::app {
namespace {

// Least and most words after the command.
const std::map<std::string, std::pair<int, int>> kCommands{
    {"open", {1, 1}},   {"revise", {1, 1}},     {"wait-ready", {0, 1}},    {"wait", {1, 1}},
    {"move", {1, 1}},   {"press", {0, 1}},      {"release", {0, 1}},       {"stroke", {2, 10000}},
    {"rate", {1, 1}},   {"key", {1, 1}},        {"hold", {1, 1}},          {"type", {1, 1}},
    {"scroll", {1, 1}}, {"click", {1, 1}},      {"right-click", {1, 1}},   {"set", {2, 2}},
    {"undo", {0, 0}},   {"redo", {0, 0}},       {"save", {1, 1}},          {"export", {1, 1}},
    {"close", {0, 0}},  {"screenshot", {1, 1}}, {"expect", {1, 2}},        {"await", {1, 2}},
    {"focus", {0, 0}},  {"unfocus", {0, 0}},    {"pace", {1, 1}},          {"random", {2, 2}},
    {"resize", {2, 2}}, {"report", {0, 0}},     {"lose-graphics", {0, 0}}, {"names", {0, 0}},
    {"places", {0, 0}}, {"quit", {0, 0}}};

constexpr std::size_t kMostBytes = std::size_t{64} << 20;
constexpr double kMostNumber = 1e6;  // of a place, in pixels or per cent
constexpr double kMostCount = 1e18;  // of anything, such as a seed

std::vector<std::string> split(const std::string& line, const std::string& file, int number) {
    std::vector<std::string> words;
    std::size_t i = 0;
    while (i < line.size()) {
        if (std::isspace(static_cast<unsigned char>(line[i]))) {
            ++i;
        } else if (line[i] == '#') {
            break;
        } else if (line[i] == '"') {
            const std::size_t end = line.find('"', i + 1);
            if (end == std::string::npos) throw Error(file, number, "a quote is not closed");
            words.push_back(line.substr(i + 1, end - i - 1));
            i = end + 1;
        } else {
            const std::size_t end = std::min(line.find_first_of(" \t\r", i), line.size());
            words.push_back(line.substr(i, end - i));
            i = end;
        }
    }
    return words;
}

double number(std::string& text, bool& relative, double most = kMostNumber) {
    relative = !text.empty() && text.back() == '%';
    if (relative) text.pop_back();
    std::size_t used = 0;
    const double value = std::stod(text, &used);
    if (used != text.size() || !(std::abs(value) <= most)) throw std::invalid_argument("");
    return relative ? value / 100 : value;
}

ScriptPoint parse_point(const std::string& word, const std::string& file, int line) {
    std::istringstream in(word);
    std::string x, y, p;
    std::getline(in, x, ',');
    std::getline(in, y, ',');
    ScriptPoint point;
    try {
        point.x = number(x, point.relative_x);
        point.y = number(y, point.relative_y);
        bool unused = false;
        if (std::getline(in, p)) point.pressure = number(p, unused);
    } catch (const std::exception&) {
        throw Error(file, line, Message("'{}' is not a place; write X,Y or X%,Y%", word));
    }
    return point;
}

/// Words of commands that are numbers: `wait nan` would wait for ever.
void check_numbers(const ScriptCommand& c, const std::string& file) {
    static constexpr const char* kNumeric[] = {"wait", "wait-ready", "rate", "scroll", "resize", "random"};
    if (std::find(std::begin(kNumeric), std::end(kNumeric), c.name) == std::end(kNumeric)) return;
    for (const std::string& word : c.words) {
        std::string text = word;
        bool relative = false;
        try {
            if (number(text, relative, kMostCount); !relative) continue;
        } catch (const std::exception&) {
        }
        throw Error(file, c.line, Message("'{}' is not a number for '{}'", word, c.name));
    }
}

}  // namespace

std::vector<ScriptCommand> parse_script(const std::filesystem::path& path) {
    const std::vector<char> bytes = read_file(path, kMostBytes);
    std::istringstream in(std::string(bytes.begin(), bytes.end()));
    std::vector<ScriptCommand> commands;
    int number = 0;
    for (std::string line; std::getline(in, line);) {
        ++number;
        std::vector<std::string> words = split(line, path.string(), number);
        if (words.empty()) continue;
        ScriptCommand c{.line = number, .name = words.front()};
        c.words.assign(words.begin() + 1, words.end());
        const auto known = kCommands.find(c.name);
        if (known == kCommands.end()) {
            std::vector<std::string> names;
            names.reserve(kCommands.size());
            for (const auto& [name, counts] : kCommands) names.push_back(name);
            const std::string near = nearest_name(c.name, names);
            throw Error(path.string(), number, Message("unknown command '{}'{}", c.name, did_you_mean(near)));
        }
        const int n = static_cast<int>(c.words.size());
        if (n < known->second.first || n > known->second.second)
            throw Error(path.string(), number, Message("'{}' needs {} word(s) after it", c.name, known->second.first));
        const bool to_label = c.name == "move" && c.words[0].find(',') == std::string::npos;
        if ((c.name == "move" && !to_label) || c.name == "stroke")
            for (const std::string& word : c.words) c.points.push_back(parse_point(word, path.string(), number));
        check_numbers(c, path.string());
        commands.push_back(std::move(c));
    }
    return commands;
}

}  // namespace tuft::app
