#pragma once

#include <filesystem>

/// \file
/// Why a path cannot be used: not every file that cannot be found is missing. Called where a file or an output folder
/// is named by a person.
namespace tuft {

/// Throws `Error` where `path` leads to nothing: "no such file", or what the system says, such as of a loop of symbolic
/// links, of a name that is too long, or of a folder on its way that may not be entered.
void check_exists(const std::filesystem::path& path);

/// Throws `Error` of `path` where the folder that it is to be written into is missing, is no folder or cannot be
/// reached.
void check_output_folder(const std::filesystem::path& path);

}  // namespace tuft
