#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// \file
/// Reading and writing whole files, and the folder of shipped data. Used by every module that opens a file.
namespace tuft {

/// Returns all bytes of a file. Throws `Error` when the file is missing, a folder, unreadable, empty or larger than
/// `max_bytes`. The size is checked before memory is allocated.
std::vector<char> read_file(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{8} << 30);

/// Calls `write(temporary)` with a path beside `path`, then renames that file to `path`. On any error it removes
/// the temporary file, leaves `path` unchanged and throws `Error`.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Writes bytes to `path` with `write_atomically`.
void write_file(const std::filesystem::path& path, const void* data, std::size_t size);

/// Returns the folder of the shipped files (`models`, `brushes`, `inks`): $TUFT_DATA when it is not empty. Otherwise
/// the first that exists: the installed share/tuft beside the program; the source tree of the build; `tuft` in one of
/// $XDG_DATA_DIRS (/usr/local/share and /usr/share).
std::filesystem::path data_folder();

}  // namespace tuft
