#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace tuft {

/// The whole file. Throws `Error` when it is missing, a folder, unreadable, empty
/// or larger than `max_bytes`; the size is checked before memory is taken.
std::vector<char> read_file(const std::filesystem::path& path, std::size_t max_bytes = std::size_t{8} << 30);

/// Calls `write(temporary)` with a path beside `path`, then renames it to `path`.
/// On any error the temporary file is removed, `path` is as it was, and `Error` is thrown.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary)>& write);

/// Writes bytes to `path` by way of `write_atomically`.
void write_file(const std::filesystem::path& path, const void* data, std::size_t size);

/// Folder with the files tuft ships (`models`, `brushes`, `inks`): $TUFT_DATA, else the
/// installed share/tuft beside the program, else the source tree it was built from while that
/// is there, else `tuft` in one of $XDG_DATA_DIRS (/usr/local/share and /usr/share).
std::filesystem::path data_folder();

}  // namespace tuft
