#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

/// What the file dialog lists of a folder.
namespace tuft::app {

enum class FileOrder { name, size, date };

struct FileEntry {
    std::string name;
    bool folder = false;
    std::uintmax_t bytes = 0;
    std::int64_t changed = 0;  ///< seconds since 1970
};

/// Folders, and the files that suit; without hidden ones. `fault`: why the folder cannot be read, "" when it can.
std::vector<FileEntry> list_folder(const std::filesystem::path& folder,
                                   const std::function<bool(const std::filesystem::path&)>& suits, std::string& fault);

/// Folders first, by name; then files by the order asked for. Equal ones by name.
void sort_entries(std::vector<FileEntry>& entries, FileOrder order, bool downward);

/// Whether a name holds the text, whatever the case of Latin letters.
bool matches_filter(const std::string& name, const std::string& filter);

/// The text with Latin letters made small.
std::string lower(std::string text);

/// "12 kB", "3.4 MB"; "2026-11-25 14:03" in local time.
std::string size_text(std::uintmax_t bytes);
std::string date_text(std::int64_t seconds);

}  // namespace tuft::app
