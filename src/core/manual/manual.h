#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// \file
/// The options of a program as data, and the manual pages and shell completions that are made from
/// them when the program is built. The programs fill it from the tables that they parse by.
namespace tuft {

/// An option, or an argument that has a place instead of a name.
struct ManualOption {
    std::vector<std::string> names;    ///< "-o", "--output"; empty: an argument with a place
    std::string value;                 ///< placeholder of what follows: "FILE", "X,Y,Z"; empty: a flag
    std::vector<std::string> choices;  ///< all that the value may be; empty: no list
    std::string text;                  ///< what it does, one phrase
    bool required = false;
    bool repeats = false;  ///< takes any number of values
};

struct ManualCommand {
    std::string name;  ///< "tuft", "paint"
    std::string text;  ///< one phrase
    std::vector<ManualOption> options;
    std::vector<ManualCommand> commands;
};

/// A section of a manual page that is written by hand; paragraphs are parted by empty lines, lines
/// that begin with two spaces stay as they are.
struct ManualSection {
    std::string title, text;
};

struct Manual {
    ManualCommand program;
    std::string version, date;            ///< of the program, "0.1.0", "2026-11-25"
    std::vector<ManualSection> sections;  ///< of the program's own page
};

/// A page in the roff language of man(7): of the program, or of one of its commands.
std::string man_page(const Manual& manual);
std::string man_page(const Manual& manual, const ManualCommand& command);

/// Extensions ("ply", "toml") of the files that an option takes, by the formats that its text
/// names; empty: any.
std::vector<std::string> file_extensions(const ManualOption& option);

/// Completion of the program's words for bash, to be sourced, and for zsh, as a file `_PROGRAM` of
/// its `fpath`. Values named BRUSH, INK and SUBSTRATE are completed by the presets of `TUFT_DATA`,
/// or of the installed program.
std::string bash_completion(const ManualCommand& program);
std::string zsh_completion(const ManualCommand& program);

/// Writes `man1/PROGRAM.1` and `man1/PROGRAM-COMMAND.1`, `bash/PROGRAM` and `zsh/_PROGRAM` into a
/// folder that is there. Throws `Error` where it cannot.
void write_manual(const Manual& manual, const std::filesystem::path& folder);

}  // namespace tuft
