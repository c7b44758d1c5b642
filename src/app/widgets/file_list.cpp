#include "app/widgets/file_list.h"

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <ctime>
#include <tuple>

#include "core/files/system_message.h"
#include "core/text/lower_case.h"

namespace fs = std::filesystem;

namespace tuft::app {

std::string lower(std::string text) {
    return lower_case(std::move(text));
}

std::vector<FileEntry> list_folder(const fs::path& folder, const std::function<bool(const fs::path&)>& suits,
                                   Message& fault) {
    std::vector<FileEntry> entries;
    std::error_code ec;
    for (fs::directory_iterator it(folder, fs::directory_options::skip_permission_denied, ec), end; !ec && it != end;
         it.increment(ec)) {
        const std::string name = it->path().filename().string();
        struct stat about {};
        if (name.starts_with('.') || ::stat(it->path().c_str(), &about) != 0) continue;
        const bool is_folder = S_ISDIR(about.st_mode);
        if (!is_folder && (!S_ISREG(about.st_mode) || !suits(it->path()))) continue;
        entries.push_back({name, is_folder, is_folder ? 0 : static_cast<std::uintmax_t>(about.st_size),
                           static_cast<std::int64_t>(about.st_mtime)});
    }
    fault = ec ? system_message(ec) : Message();
    return entries;
}

void sort_entries(std::vector<FileEntry>& entries, FileOrder order, bool downward) {
    const auto before = [&](const FileEntry& a, const FileEntry& b) {
        const std::string x = lower(a.name), y = lower(b.name);
        if (a.folder != b.folder) return a.folder;
        const auto by = [&](const auto& p, const auto& q) {
            return downward ? std::tie(q, x, a.name) < std::tie(p, y, b.name)
                            : std::tie(p, x, a.name) < std::tie(q, y, b.name);
        };
        if (a.folder || order == FileOrder::name)
            return downward && !a.folder ? std::tie(y, b.name) < std::tie(x, a.name)
                                         : std::tie(x, a.name) < std::tie(y, b.name);
        return order == FileOrder::size ? by(a.bytes, b.bytes) : by(a.changed, b.changed);
    };
    std::sort(entries.begin(), entries.end(), before);
}

bool matches_filter(const std::string& name, const std::string& filter) {
    return lower(name).find(lower(filter)) != std::string::npos;
}

std::string size_text(std::uintmax_t bytes) {
    char text[32];
    if (bytes < 1024 * 1024)
        std::snprintf(text, sizeof text, "%.0f kB", static_cast<double>((bytes + 1023) / 1024));
    else
        std::snprintf(text, sizeof text, "%.1f MB", static_cast<double>(bytes) / 1048576);
    return text;
}

std::string date_text(std::int64_t seconds) {
    const auto time = static_cast<std::time_t>(seconds);
    std::tm local{};
    char text[32] = "";
    if (::localtime_r(&time, &local)) std::strftime(text, sizeof text, "%Y-%m-%d %H:%M", &local);
    return text;
}

}  // namespace tuft::app
