#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <algorithm>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <string>

#include "app/input/imgui_feed.h"
#include "app/script/script.h"
#include "app/session/open_close.h"
#include "app/studio/studio.h"
#include "app/view/display.h"
#include "core/manual/manual.h"
#include "core/system/build_facts.h"
#include "io/model/read_model.h"

namespace {

using namespace tuft;

// The options: for --help, the manual page and the completions of shells.
const Manual& manual() {
    static const Manual manual{
        .program =
            {.name = "tuft-studio",
             .text = "decorate a 3D model with ink and a bending brush, in a window",
             .options = {{.value = "MODEL|PROJECT",
                          .text = std::string("mesh (") + io::kModelFormats + ") or project to open"},
                         {.names = {"--script"}, .value = "FILE", .text = "play the commands of a file, then end"},
                         {.names = {"--headless"}, .text = "show no window (for scripts)"},
                         {.names = {"--size"}, .value = "WxH", .text = "size of the window in pixels (1280x720)"},
                         {.names = {"--help", "-h"}, .text = "print this help message and exit"},
                         {.names = {"--version"}, .text = "print the program's version and exit"}}},
        .version = build_facts().version,
        .date = build_facts().released,
        .sections = {{"DESCRIPTION",
                      "tuft-studio opens a mesh, makes a texture atlas for it, and paints on its surface with a "
                      "physically bending "
                      "brush, by mouse, pen tablet or SpaceMouse. Help in its menu lists the keys."},
                     {"FILES",
                      "$XDG_STATE_HOME/tuft (~/.local/state/tuft) keeps settings and unfinished work. /usr/share/tuft "
                      "has brushes, "
                      "inks, substrates, models and samples; TUFT_DATA names another folder for them."},
                     {"SEE ALSO", "tuft(1)"}}};
    return manual;
}

std::string help() {
    std::string text =
        "Usage: tuft-studio [OPTIONS] [MODEL|PROJECT]\nDecorate a 3D model with ink and a bending brush, in a "
        "window.\n\n";
    for (const ManualOption& option : manual().program.options) {
        std::string line = "  ";
        for (const std::string& name : option.names) line += (line.size() > 2 ? ", " : "") + name;
        line += (line.size() > 2 && !option.value.empty() ? " " : "") + option.value;
        line.resize(std::max<std::size_t>(line.size() + 2, 20), ' ');
        text += line + option.text + "\n";
    }
    return text;
}

bool is_option(const std::string& word) {
    const auto& options = manual().program.options;
    return std::any_of(options.begin(), options.end(),
                       [&](const ManualOption& o) { return std::count(o.names.begin(), o.names.end(), word) > 0; });
}

struct Options {
    std::string file, script;
    bool headless = false;
    int width = 1280, height = 720;
};

Options parse(int argc, char** argv) {
    Options o;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        const auto value = [&] {
            if (++i >= argc) throw UsageError("'" + word + "' needs a value after it (see --help)");
            return std::string(argv[i]);
        };
        if (word.starts_with("-") && !is_option(word)) throw UsageError("unknown option '" + word + "' (see --help)");
        if (word == "--script")
            o.script = value();
        else if (word == "--headless")
            o.headless = true;
        else if (word == "--size") {
            const std::string size = value();
            const char* end = size.data() + size.size();
            const auto [x, e1] = std::from_chars(size.data(), end, o.width);
            const bool good =
                e1 == std::errc() && x < end && *x == 'x' && std::from_chars(x + 1, end, o.height).ptr == end;
            if (!good || o.width < 320 || o.height < 240 || o.width > 8192 || o.height > 8192)
                throw UsageError("'" + size + "' is not a size; write 1280x720");
        } else if (o.file.empty())
            o.file = word;
        else
            throw UsageError("one model or project at a time, '" + word + "' is too much");
    }
    if (o.headless && o.script.empty()) throw UsageError("--headless needs a --script to play");
    return o;
}

void loop(app::Display& display, const Options& options) {
    std::optional<app::Script> script;
    if (!options.script.empty()) script.emplace(options.script);
    app::Studio studio;
    app::Session& session = studio.session();
    session.panels.help.by_itself = !script;
    if (!options.file.empty()) app::open_path(session, options.file);
    app::EventQueue events;
    std::string title;
    while (!session.project.closing.quit && !(script && script->finished())) {
        display.poll(events, !events.empty() ? 0 : script ? script->patience(studio) : studio.patience());
        if (display.closed()) {
            display.cancel_close();
            app::request_close(session, {});
        }
        if (display.lost() || (script && script->take_loss())) {
            studio.drop_graphics();
            ImGui_ImplOpenGL3_Shutdown();
            display.renew();
            ImGui_ImplOpenGL3_Init("#version 330");
            studio.make_graphics();
        }
        if (const auto size = script ? script->take_size() : std::nullopt) display.resize(size->first, size->second);
        if (Message trouble = display.take_fault(); !trouble.empty())
            app::show_message(session.status, std::move(trouble));
        studio.set_content_scale(display.scale());  // another one on another monitor
        const double now = display.now();
        if (script) script->before_frame(studio, events, now);
        const bool seen = display.seen() || !script || script->looks();
        studio.frame(events, {display.width(), display.height(), display.framebuffer(), seen}, now);
        if (script) script->after_frame(studio, display.width(), display.height(), seen);
        if (seen) {
            display.present();
            studio.shown(display.now());
        }
        const std::string name = app::project_name(session.paint_thread.get(), session.reported.file.project) +
                                 (session.reported.file.viewing ? " (a view)" : "");
        if (const std::string wanted = name.empty() ? "tuft studio" : name + " \xe2\x80\x93 tuft studio";
            wanted != title)
            display.set_title(title = wanted);
    }
    studio.finish();
    if (!session.project.closing.failure.empty()) throw Error(session.project.closing.failure);
}

int run(const Options& options) {
    const std::unique_ptr<app::Display> display = options.headless ? app::open_offscreen(options.width, options.height)
                                                                   : app::open_window(options.width, options.height);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    app::start_imgui_feed();
    ImGui_ImplOpenGL3_Init("#version 330");
    int status = 0;
    try {
        loop(*display, options);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tuft-studio: %s\n", error.what());
        status = 1;
    }
    ImGui_ImplOpenGL3_Shutdown();
    ImGui::DestroyContext();
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    for (int i = 1; i < argc; ++i) {
        if (!std::strcmp(argv[i], "--help") || !std::strcmp(argv[i], "-h"))
            return std::fputs(help().c_str(), stdout), 0;
        if (!std::strcmp(argv[i], "--version"))
            return std::printf("tuft-studio %s\n", build_facts().version.c_str()), 0;
    }
    // A limit on the size of files is a write that fails, with a message, not the end of the program.
    std::signal(SIGXFSZ, SIG_IGN);
    std::signal(SIGPIPE, SIG_IGN);  // so is a driver that goes away
    try {
        if (argc == 3 && !std::strcmp(argv[1], "--reference"))
            return write_manual(manual(), argv[2]), 0;  // when it is built
        return run(parse(argc, argv));
    } catch (const UsageError& error) {
        std::fprintf(stderr, "tuft-studio: %s\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        std::fprintf(stderr, "tuft-studio: %s\n", error.what());
        return 1;
    }
}
