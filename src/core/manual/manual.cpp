#include "core/manual/manual.h"

#include <algorithm>
#include <sstream>

#include "core/error.h"
#include "core/files/files.h"

namespace fs = std::filesystem;

namespace tuft {
namespace {

// Text as roff takes it: a backslash and what would be a request at a line's start are escaped.
std::string roff(const std::string& text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const bool starts = i == 0 || text[i - 1] == '\n';
        if (starts && (text[i] == '.' || text[i] == '\'')) out += "\\&";
        if (text[i] == '\\')
            out += "\\e";
        else if (text[i] == '-')
            out += "\\-";
        else
            out += text[i];
    }
    return out;
}

std::string bold(const std::string& text) {
    return "\\fB" + roff(text) + "\\fR";
}
std::string italic(const std::string& text) {
    return "\\fI" + roff(text) + "\\fR";
}

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(),
                   [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
    return text;
}

std::string capital(std::string text) {
    if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
    return text;
}

// "-o, --output FILE"
std::string headline(const ManualOption& option) {
    std::string line;
    for (const std::string& name : option.names) line += (line.empty() ? "" : ", ") + bold(name);
    if (option.value.empty()) return line;
    return line + (line.empty() ? "" : " ") + italic(option.value) + (option.repeats ? " ..." : "");
}

void add_options(std::string& page, const ManualCommand& command, bool with_place) {
    for (const ManualOption& option : command.options) {
        if (option.names.empty() != with_place) continue;
        page += ".TP\n" + headline(option) + "\n" + roff(capital(option.text));
        std::string choices;
        for (const std::string& choice : option.choices) choices += (choices.empty() ? "" : ", ") + bold(choice);
        if (!choices.empty()) page += (option.text.empty() ? "One of " : ". One of ") + choices;
        page += ".\n";
    }
}

// `name` is the words that call it: "tuft paint".
std::string synopsis(const std::string& name, const ManualCommand& command) {
    std::string line = bold(name);
    for (const ManualOption& option : command.options)
        if (option.names.empty()) line += option.required ? " " + headline(option) : " [" + headline(option) + "]";
    for (const ManualOption& option : command.options)
        if (option.required && !option.names.empty())
            line += " " + bold(option.names.back()) + " " + italic(option.value);
    return line + " [" + italic("OPTION") + "]...";
}

std::string heading(const Manual& manual, const std::string& name, const std::string& text) {
    return ".\\\" Made from the program's option tables.\n.TH " + roff(upper(name)) + " 1 " + manual.date + " \"" +
           roff(manual.program.name + " " + manual.version) + "\" \"" + manual.program.name + " manual\"\n.SH NAME\n" +
           roff(name) + " \\- " + roff(text) + "\n";
}

// Paragraphs; indented lines as they are.
std::string body(const std::string& text) {
    std::string out;
    std::istringstream lines(text);
    bool verbatim = false, paragraph_ended = false;
    for (std::string line; std::getline(lines, line);) {
        if (line.empty()) {
            paragraph_ended = true;
            continue;
        }
        const bool indented = line.starts_with("  ");
        if (verbatim && !indented) out += ".RE\n.fi\n";
        if (paragraph_ended || indented != verbatim) out += ".PP\n";
        if (indented && !verbatim) out += ".nf\n.RS\n";
        verbatim = indented;
        paragraph_ended = false;
        out += roff(indented ? line.substr(2) : line) + "\n";
    }
    return out + (verbatim ? ".RE\n.fi\n" : "");
}

}  // namespace

std::string man_page(const Manual& manual) {
    const ManualCommand& program = manual.program;
    std::string page = heading(manual, program.name, program.text) + ".SH SYNOPSIS\n";
    if (program.commands.empty())
        page += synopsis(program.name, program) + "\n";
    else
        page += bold(program.name) + " " + italic("COMMAND") + " [" + italic("ARGUMENT") + "]...\n";
    for (const ManualSection& section : manual.sections)
        if (section.title == "DESCRIPTION") page += ".SH DESCRIPTION\n" + body(section.text);
    if (!program.commands.empty()) page += ".SH COMMANDS\n";
    for (const ManualCommand& command : program.commands)
        page += ".TP\n" + bold(program.name + "-" + command.name) + "(1)\n" + roff(capital(command.text)) + ".\n";
    page += ".SH OPTIONS\n";
    add_options(page, program, true);
    add_options(page, program, false);
    for (const ManualSection& section : manual.sections)
        if (section.title != "DESCRIPTION") page += ".SH " + section.title + "\n" + body(section.text);
    return page;
}

std::string man_page(const Manual& manual, const ManualCommand& command) {
    const std::string& program = manual.program.name;
    std::string page = heading(manual, program + "-" + command.name, command.text) + ".SH SYNOPSIS\n" +
                       synopsis(program + " " + command.name, command) + "\n";
    for (const ManualCommand& part : command.commands)
        page += ".br\n" + synopsis(program + " " + command.name + " " + part.name, part) + "\n";
    page += ".SH DESCRIPTION\n" + roff(capital(command.text)) + ".\n";
    if (std::any_of(command.options.begin(), command.options.end(), [](const auto& o) { return o.names.empty(); })) {
        page += ".SH ARGUMENTS\n";
        add_options(page, command, true);
    }
    page += ".SH OPTIONS\n";
    add_options(page, command, false);
    for (const ManualCommand& part : command.commands) {
        page += ".SH " + roff(upper(part.name)) + "\n" + roff(capital(part.text)) + ".\n";
        add_options(page, part, true);
        add_options(page, part, false);
    }
    return page + ".SH SEE ALSO\n" + bold(program) + "(1)\n";
}

std::vector<std::string> file_extensions(const ManualOption& option) {
    // All that `io::read_model` reads.
    const std::vector<std::string> models{"ply", "obj",  "stl",  "off", "glb",  "gltf", "fbx",  "dae", "3mf",
                                          "x3d", "x3dv", "vrml", "wrl", "step", "stp",  "iges", "igs"};
    const std::vector<std::pair<std::string, std::vector<std::string>>> formats{
        {"mesh", models}, {"project", {"tuft"}}, {"inkml", {"inkml"}}, {"svg", {"svg"}},
        {"glb", {"glb"}}, {"gltf", {"gltf"}},    {"obj", {"obj"}},     {"ply", {"ply"}},
        {"stl", {"stl"}}, {"off", {"off"}},      {"toml", {"toml"}},   {"csv", {"csv"}},
        {"png", {"png"}}, {"exr", {"exr"}},      {"tuft", {"tuft"}},   {"model", models}};
    std::vector<std::string> found;
    if (option.value != "FILE" && !(option.names.empty() && option.choices.empty())) return found;
    std::string word;
    const std::string text = option.value + " " + option.text + " ";
    const bool dotted = text.find(" .") != std::string::npos || text.find("(.") != std::string::npos;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (std::isalnum(static_cast<unsigned char>(text[i]))) {
            word += static_cast<char>(std::tolower(static_cast<unsigned char>(text[i])));
            continue;
        }
        // Where extensions are written out they count alone: ".glb, .gltf or .obj" of a model.
        const bool with_dot = i > word.size() && text[i - word.size() - 1] == '.';
        for (const auto& [name, extensions] : formats)
            if (word == name && with_dot == dotted)
                for (const std::string& extension : extensions)
                    if (std::find(found.begin(), found.end(), extension) == found.end()) found.push_back(extension);
        word.clear();
    }
    return found;
}

void write_manual(const Manual& manual, const fs::path& folder) {
    const auto write = [&](const fs::path& name, const std::string& text) {
        fs::create_directories((folder / name).parent_path());
        write_file(folder / name, text.data(), text.size());
    };
    const std::string& program = manual.program.name;
    try {
        write(fs::path("man1") / (program + ".1"), man_page(manual));
        for (const ManualCommand& command : manual.program.commands)
            write(fs::path("man1") / (program + "-" + command.name + ".1"), man_page(manual, command));
        write(fs::path("bash") / program, bash_completion(manual.program));
        write(fs::path("zsh") / ("_" + program), zsh_completion(manual.program));
    } catch (const fs::filesystem_error& error) {
        throw Error(folder.string(), Message("the manual cannot be written there: {}", error.code().message()));
    }
}

}  // namespace tuft
