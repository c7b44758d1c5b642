#include <algorithm>

#include "core/manual/manual.h"

namespace tuft {
namespace {

std::string joined(const std::vector<std::string>& words, const char* with) {
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : with) + word;
    return line;
}

// Folder under models/ with the presets that a value names; empty: none.
std::string presets_of(const ManualOption& option) {
    if (option.value == "BRUSH") return "brushes";
    if (option.value == "INK") return "inks";
    return option.value == "SUBSTRATE" ? "substrates" : "";
}

bool takes_file(const ManualOption& option) {
    return option.value == "FILE" || !file_extensions(option).empty();
}

// What completes a value, as `_PROGRAM_fill` of the bash script takes it.
std::string bash_value(const ManualOption& option) {
    if (!option.choices.empty()) return joined(option.choices, " ");
    if (const std::string presets = presets_of(option); !presets.empty()) return "@presets " + presets;
    return takes_file(option) ? "@files " + joined(file_extensions(option), " ") : "@none";
}

// Entries of the script's two tables for one command; `key` is the words that call it.
void add_bash(std::string& words, std::string& values, const std::string& key, const ManualCommand& command) {
    std::vector<std::string> all;
    int place = 0;
    for (const ManualOption& option : command.options) {
        all.insert(all.end(), option.names.begin(), option.names.end());
        const std::string value = "='" + bash_value(option) + "'\n";
        if (option.names.empty())
            values += "    ['" + key + " " + std::to_string(++place) + (option.repeats ? "+" : "") + "']" + value;
        for (const std::string& name : option.names)
            if (!option.value.empty()) values += "    ['" + key + " " + name + "']" + value;
    }
    words += "    ['" + key + "']='" + joined(all, " ") + "'\n";
    for (const ManualCommand& part : command.commands) add_bash(words, values, key + " " + part.name, part);
}

// What follows does not depend on the program; PROGRAM stands for its name, as a shell function's.
constexpr const char* kBash = R"bash(
# Fills COMPREPLY: _PROGRAM_fill WHAT CURRENT
_PROGRAM_fill() {
    local what=$1 cur=$2 extension data
    case $what in
    @none) return ;;
    @presets\ *)
        data=${TUFT_DATA:-$(dirname "$(readlink -f "$(type -P tuft)")" 2>/dev/null)/../share/tuft}
        mapfile -t COMPREPLY < <(
            for extension in "$data/models/${what#@presets }"/*.toml; do
                extension=${extension##*/}
                [[ ${extension%.toml} == "$cur"* && $extension != '*.toml' ]] && printf '%s\n' "${extension%.toml}"
            done
            compgen -f -X '!*.toml' -- "$cur") ;;
    @files*)
        compopt -o filenames 2>/dev/null
        mapfile -t COMPREPLY < <(
            if [[ $what == '@files ' ]]; then compgen -f -- "$cur"
            else
                compgen -d -- "$cur"
                for extension in ${what#@files}; do compgen -f -X "!*.$extension" -- "$cur"; done
            fi) ;;
    *) mapfile -t COMPREPLY < <(compgen -W "$what" -- "$cur") ;;
    esac
}

_PROGRAM() {
    local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]} key=KEY word before='' place=0 i
    COMPREPLY=()
    if [[ $cur == = ]]; then cur=''
    elif [[ $prev == = ]]; then prev=${COMP_WORDS[COMP_CWORD - 2]}
    fi
    for ((i = 1; i < COMP_CWORD; i++)); do
        word=${COMP_WORDS[i]}
        if [[ $word != -* && $word != = && $before != = && -z ${_PROGRAM_values["$key $before"]+x} ]]; then
            if [[ -n ${_PROGRAM_words["$key $word"]+x} ]]; then key+=" $word"
            else ((++place))
            fi
        fi
        before=$word
    done
    if [[ -n ${_PROGRAM_values["$key $prev"]+x} ]]; then
        _PROGRAM_fill "${_PROGRAM_values["$key $prev"]}" "$cur"
    elif [[ $cur == -* ]]; then
        mapfile -t COMPREPLY < <(compgen -W "${_PROGRAM_words["$key"]}" -- "$cur")
    else
        ((++place))
        while ((place > 1)) && [[ -z ${_PROGRAM_values["$key $place"]+x} && -n ${_PROGRAM_values["$key $((place - 1))+"]+x} ]]; do ((--place)); done
        word="$key $place"
        [[ -n ${_PROGRAM_values["$word"]+x} ]] || word+=+
        if [[ -n ${_PROGRAM_values["$word"]+x} ]]; then _PROGRAM_fill "${_PROGRAM_values["$word"]}" "$cur"; fi
        for word in "${!_PROGRAM_words[@]}"; do  # commands
            word=${word#"$key "}
            if [[ $word != *' '* && $word != "$key" && $word == "$cur"* && -n ${_PROGRAM_words["$key $word"]+x} ]]; then COMPREPLY+=("$word"); fi
        done
    fi
}
complete -F _PROGRAM KEY
)bash";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
        text.replace(at, from.size(), to);
    return text;
}

std::string function_name(const std::string& program) {
    return replaced(program, "-", "_");
}

// Text within single quotes of a zsh specification.
std::string zsh_text(const std::string& text) {
    std::string out;
    for (const char c : text) {
        if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
        if (c == '\'') out += "'\\'";
        out += c;
    }
    return out;
}

std::string zsh_value(const ManualOption& option, const std::string& function) {
    std::string action = " ";
    if (!option.choices.empty())
        action = "(" + joined(option.choices, " ") + ")";
    else if (const std::string presets = presets_of(option); !presets.empty())
        action = " " + function + "_presets " + presets;  // the space: no words of _arguments before it
    else if (takes_file(option)) {
        const std::vector<std::string> extensions = file_extensions(option);
        action = extensions.empty() ? "_files" : "_files -g \"*.(" + joined(extensions, "|") + ")\"";
    }
    return ":" + zsh_text(option.value) + ":" + action;
}

// Arguments of _arguments for one command, one a line.
std::string zsh_arguments(const ManualCommand& command, const std::string& function) {
    std::string lines;
    for (const ManualOption& option : command.options) {
        if (option.names.empty()) {
            lines += std::string(" \\\n      '") + (option.repeats ? "*" : "") +
                     (option.required || option.repeats ? "" : ":") + zsh_value(option, function) + "'";
            continue;
        }
        for (const std::string& name : option.names) {
            const bool whole = option.value.empty() || !name.starts_with("--");  // "--name=value" else
            lines += std::string(" \\\n      '") + (option.repeats ? "*" : "") + name + (whole ? "" : "=") + "[" +
                     zsh_text(option.text) + "]" + (option.value.empty() ? "" : zsh_value(option, function)) + "'";
        }
    }
    return lines;
}

std::string zsh_commands(const ManualCommand& command) {
    std::string lines;
    for (const ManualCommand& part : command.commands)
        lines += "      '" + part.name + ":" + zsh_text(part.text) + "'\n";
    return lines;
}

}  // namespace

std::string bash_completion(const ManualCommand& program) {
    const std::string function = "_" + function_name(program.name);
    std::string words, values;
    add_bash(words, values, program.name, program);
    return "# Completion of " + program.name + " for bash; made from the program's option tables.\n" + "declare -gA " +
           function + "_words=(\n" + words + ")\ndeclare -gA " + function + "_values=(\n" + values + ")\n" +
           replaced(replaced(kBash, "_PROGRAM", function), "KEY", program.name);
}

std::string zsh_completion(const ManualCommand& program) {
    const std::string function = "_" + function_name(program.name);
    std::string text = "#compdef " + program.name + "\n# Made from the program's option tables.\n\n" + function +
                       "_presets() {\n"
                       "  local data=${TUFT_DATA:-${commands[tuft]:A:h:h}/share/tuft}\n"
                       "  local -a names=($data/models/$1/*.toml(N:t:r))\n"
                       "  _alternative \"presets:$1:($names)\" 'files:file:_files -g \"*.toml\"'\n"
                       "}\n\n" +
                       function + "() {\n";
    if (program.commands.empty())
        return text + "  _arguments" + zsh_arguments(program, function) + "\n}\n\n" + function + " \"$@\"\n";
    text +=
        "  local context state state_descr line\n  typeset -A opt_args\n  local -a commands_\n  "
        "_arguments -C" +
        zsh_arguments(program, function) + " \\\n      '1: :->command' \\\n      '*:: :->words'\n" +
        "  case $state in\n  command)\n    commands_=(\n" + zsh_commands(program) +
        "    )\n    _describe command commands_ ;;\n  words)\n    case $words[1] in\n";
    for (const ManualCommand& command : program.commands) {
        text += "    " + command.name + ") ";
        const char* test = "if";
        for (const ManualCommand& part : command.commands) {
            text += std::string(test) + " (( ${words[(I)" + part.name + "]} && ${words[(I)" + part.name +
                    "]} < CURRENT )); then\n      _arguments" + zsh_arguments(part, function) +
                    " \\\n      '*: :'\n      ";
            test = "elif";
        }
        if (!command.commands.empty()) text += "else ";
        text += "_arguments" + zsh_arguments(command, function);
        text += command.commands.empty() ? "" : "; fi";
        text += " ;;\n";
    }
    return text + "    esac ;;\n  esac\n}\n\n" + function + " \"$@\"\n";
}

}  // namespace tuft
