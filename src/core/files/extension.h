#pragma once

#include <filesystem>
#include <string>

#include "core/text/lower_case.h"

/// \file
/// Endings of file names, by which formats are told apart.
namespace tuft {

/// Returns the extension of a path with its dot, ASCII letters in lower case: ".obj"; "" for none.
inline std::string lower_extension(const std::filesystem::path& path) {
    return lower_case(path.extension().string());
}

}  // namespace tuft
