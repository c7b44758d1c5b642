#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "core/message.h"

/// \file
/// Folder listings for the file dialog. Any thread.
namespace tuft::app {

enum class FileOrder { name, size, date };

/// A file or folder in the list.
struct FileEntry {
    std::string name;
    bool folder = false;
    std::uintmax_t bytes = 0;
    std::int64_t changed = 0;  ///< seconds since 1970
};

/// Returns the folders and the files for which `suits` is true, without hidden ones. `fault`: why the folder cannot be
/// read; "" when it can.
std::vector<FileEntry> list_folder(const std::filesystem::path& folder,
                                   const std::function<bool(const std::filesystem::path&)>& suits, Message& fault);

/// Sorts folders first, by name; then files by `order`, equal ones by name.
void sort_entries(std::vector<FileEntry>& entries, FileOrder order, bool downward);

/// Returns true when the name contains the text, ignoring the case of Latin letters.
bool matches_filter(const std::string& name, const std::string& filter);

/// Returns the text with Latin letters in lower case.
std::string lower(std::string text);

/// Returns a size as "12 kB", "3.4 MB"; a time (seconds since 1970) as "2026-11-25 14:03", local.
std::string size_text(std::uintmax_t bytes);
std::string date_text(std::int64_t seconds);

}  // namespace tuft::app
