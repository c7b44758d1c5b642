#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include "cli/arguments.h"

/// \file
/// Options and checks that several commands share. Called while the table of options is made.
// What help and manual call the value of an option that is a path.
template <>
constexpr const char* CLI::detail::type_name<std::filesystem::path>() {
    return "FILE";
}

namespace tuft::cli {

/// Returns the whole of `text` as a finite number; nothing for anything else.
std::optional<double> number_of(const std::string& text);

/// Checks a number of the command line: finite, and from `lo` to `hi`, which the help calls `name`.
CLI::Validator number_in(double lo, double hi, const std::string& name = {});

/// Adds the options of all commands.
void add_common(CLI::App* app, Common& common);

/// Adds `tuft device` with its commands.
void add_device(CLI::App& app, DeviceWork& device);

}  // namespace tuft::cli
