#pragma once

#include <filesystem>
#include <optional>
#include <system_error>

namespace tuft {

/// Returns when a file was last written; nothing where there is none or its time cannot be read.
inline std::optional<std::filesystem::file_time_type> modified_time(const std::filesystem::path& path) {
    std::error_code ec;
    const std::filesystem::file_time_type time = std::filesystem::last_write_time(path, ec);
    return ec ? std::nullopt : std::optional(time);
}

}  // namespace tuft
