#pragma once

#include <string>

#include "core/files/files.h"

/// \file
/// Whole files of text, by `read_file` and `write_file`.
namespace tuft {

/// Reads a file of at most `most` bytes. Throws `Error` as `read_file`.
inline std::string read_text(const std::filesystem::path& path, std::size_t most) {
    const std::vector<char> bytes = read_file(path, most);
    return {bytes.begin(), bytes.end()};
}

/// Writes a file; it replaces what was there in one step. Throws `Error` as `write_file`.
inline void write_text(const std::filesystem::path& path, const std::string& text) {
    write_file(path, text.data(), text.size());
}

}  // namespace tuft
