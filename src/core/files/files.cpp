#include "core/files/files.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/error.h"
#include "core/files/path_fault.h"
#include "core/files/system_message.h"
#include "core/system/interrupt.h"

namespace fs = std::filesystem;

namespace tuft {

std::vector<char> read_file(const fs::path& path, std::size_t max_bytes) {
    std::error_code ec;
    check_exists(path);
    const fs::file_status status = fs::status(path, ec);
    if (fs::is_directory(status)) throw Error(path.string(), "is a folder, not a file");
    if (!fs::is_regular_file(status)) throw Error(path.string(), "is not a regular file");
    const std::uintmax_t size = fs::file_size(path, ec);
    if (ec) throw Error(path.string(), Message("cannot be read: {}", system_message(ec)));
    if (size == 0) throw Error(path.string(), "the file is empty");
    if (size > max_bytes)
        throw Error(path.string(), Message("is too large ({} MiB; the limit is {} MiB)", size >> 20, max_bytes >> 20));
    std::vector<char> bytes(size);
    std::ifstream file(path, std::ios::binary);
    if (!file) throw Error(path.string(), Message("cannot be read: {}", system_message(errno)));
    file.read(bytes.data(), static_cast<std::streamsize>(size));
    if (file.gcount() != static_cast<std::streamsize>(size)) throw Error(path.string(), "could not be read to its end");
    return bytes;
}

void write_atomically(const fs::path& path, const std::function<void(const fs::path&)>& write) {
    const fs::path folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
    std::error_code ec;
    check_output_folder(path);
    // Writers choose their format by the extension, so it stays at the end.
    static std::atomic<unsigned> n_written{0};  // threads of one process may write the same file
    const fs::path temporary = folder / ("." + path.stem().string() + ".part" + std::to_string(::getpid()) + "-" +
                                         std::to_string(n_written++) + path.extension().string());
    if (fs::exists(path, ec) && !fs::is_regular_file(path, ec))
        throw Error(path.string(), "is there already and is not a regular file");
    const Unfinished unfinished(temporary);
    try {
        write(temporary);
        fs::rename(temporary, path);
    } catch (const fs::filesystem_error& e) {
        fs::remove(temporary, ec);
        throw Error(path.string(), Message("cannot be written: {}", system_message(e.code())));
    } catch (...) {
        fs::remove(temporary, ec);
        throw;
    }
}

void write_file(const fs::path& path, const void* data, std::size_t size) {
    write_atomically(path, [&](const fs::path& temporary) {
        std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
        if (!file) throw Error(path.string(), Message("cannot be written: {}", system_message(errno)));
        file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
        file.close();
        if (!file) throw Error(path.string(), "could not be written to its end (disk full?)");
    });
}

fs::path data_folder() {
    if (const char* from_env = std::getenv("TUFT_DATA"); from_env && *from_env) return from_env;
    std::error_code ec;
    const fs::path program = fs::read_symlink("/proc/self/exe", ec);
    if (!ec) {
        const fs::path installed = program.parent_path().parent_path() / "share" / "tuft";
        if (fs::is_directory(installed, ec)) return installed;
    }
    const fs::path source = TUFT_SOURCE_DIR;
    if (fs::is_directory(source / "models", ec)) return source;
    // Another program that uses the installed libraries.
    const char* listed = std::getenv("XDG_DATA_DIRS");
    std::istringstream folders(listed && *listed ? listed : "/usr/local/share:/usr/share");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (fs::is_directory(fs::path(folder) / "tuft", ec)) return fs::path(folder) / "tuft";
    return source;
}

}  // namespace tuft
