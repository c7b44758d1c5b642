#pragma once

#include <filesystem>
#include <string>
#include <vector>

/// \file
/// A program's options as data. The build makes manual pages and shell completions from them. The programs fill the
/// data from the same tables that they parse with.
namespace tuft {

/// An option, or a positional argument.
struct ManualOption {
    std::vector<std::string> names;    ///< "-o", "--output"; empty: a positional argument
    std::string value;                 ///< placeholder of what follows: "FILE", "X,Y,Z"; empty: a flag
    std::vector<std::string> choices;  ///< allowed values; empty: any value
    std::string text;                  ///< what it does, one phrase
    bool required = false;
    bool repeats = false;  ///< takes any number of values
};

/// A command with its options and subcommands.
struct ManualCommand {
    std::string name;  ///< "tuft", "paint"
    std::string text;  ///< one phrase
    std::vector<ManualOption> options;
    std::vector<ManualCommand> commands;
};

/// A section of a manual page, written by hand. Empty lines separate paragraphs. Lines that begin with two spaces
/// are copied verbatim.
struct ManualSection {
    std::string title, text;
};

/// All that manual pages and completions are made of.
struct Manual {
    ManualCommand program;
    std::string version, date;            ///< of the program, "0.1.0", "2026-11-25"
    std::vector<ManualSection> sections;  ///< of the program's own page
};

/// Returns a page in the roff language of man(7), for the program or for one of its commands.
std::string man_page(const Manual& manual);
std::string man_page(const Manual& manual, const ManualCommand& command);

/// Returns the file extensions ("ply", "toml") that an option accepts. They follow from the formats that the
/// option's text names. Empty: any extension.
std::vector<std::string> file_extensions(const ManualOption& option);

/// Returns the completion script of a program. The bash script is to be sourced; the zsh script is a file
/// `_PROGRAM` on `fpath`. Values named BRUSH, INK and SUBSTRATE complete to the presets of `TUFT_DATA`, or to those
/// of the installed program.
std::string bash_completion(const ManualCommand& program);
std::string zsh_completion(const ManualCommand& program);

/// Writes `man1/PROGRAM.1`, `man1/PROGRAM-COMMAND.1`, `bash/PROGRAM` and `zsh/_PROGRAM` into an existing folder.
/// Throws `Error` when a file cannot be written.
void write_manual(const Manual& manual, const std::filesystem::path& folder);

}  // namespace tuft
