#include "core/files/shipped_file.h"

#include <system_error>

#include "core/files/files.h"

namespace fs = std::filesystem;

namespace tuft {

fs::path or_shipped(const fs::path& path) {
    std::error_code failed;
    if (path.empty() || path.is_absolute() || fs::exists(path, failed)) return path;
    const fs::path inside = path.lexically_normal();
    if (*inside.begin() == "..") return path;
    const fs::path shipped = data_folder() / inside;
    return fs::is_regular_file(shipped, failed) ? shipped : path;
}

}  // namespace tuft
