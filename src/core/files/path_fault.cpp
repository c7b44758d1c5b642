#include "core/files/path_fault.h"

#include <cerrno>
#include <system_error>

#include "core/error.h"
#include "core/files/system_message.h"

namespace fs = std::filesystem;

namespace tuft {

void check_exists(const fs::path& path) {
    std::error_code ec;
    if (fs::exists(path, ec)) return;
    if (fs::status(path, ec).type() == fs::file_type::not_found && ec.value() != ENOTDIR)
        throw Error(path.string(), "no such file");
    throw Error(path.string(), Message("cannot be read: {}", system_message(ec)));
}

void check_output_folder(const fs::path& path) {
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code ec;
    const fs::file_status status = fs::status(folder, ec);
    if (fs::is_directory(status)) return;
    if (fs::exists(status)) ec = std::make_error_code(std::errc::not_a_directory);
    if (status.type() == fs::file_type::not_found && ec.value() != ENOTDIR)
        throw Error(path.string(), Message("the output folder '{}' does not exist", folder.string()));
    throw Error(path.string(),
                Message("the output folder '{}' cannot be opened: {}", folder.string(), system_message(ec)));
}

}  // namespace tuft
