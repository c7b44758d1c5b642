#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/message.h"

/// \file
/// Reader of ZIP archives, for 3MF. Inside `io` only. One thread at a time.
namespace tuft::io {

/// An archive in memory. It reads at most 64 MiB plus 64 times the archive's size in total.
class Zip {
  public:
    /// Reads the directory, that of ZIP64 too. `bytes` must outlive this. Throws `Error` naming `file` where the
    /// archive is damaged or encrypted.
    Zip(std::span<const char> bytes, std::string file);

    bool has(const std::string& name) const { return entries_.contains(name); }
    const auto& entries() const { return entries_; }
    /// Returns the content of an entry, stored or deflated. Throws `Error` where the entry is missing, damaged or
    /// larger than 4 GiB, or the total exceeds the limit.
    std::vector<char> read(const std::string& name);

  private:
    struct Entry {
        std::size_t offset = 0, packed = 0, size = 0;
        int method = 0;
    };
    [[noreturn]] void fail(const Message& what) const;
    std::size_t number(std::size_t at, int n_bytes) const;
    /// Puts the 64-bit numbers of an entry's extra fields, `size` bytes at `at`, where the old ones are all ones.
    void read_zip64(std::size_t at, std::size_t size, Entry& entry) const;

    std::span<const char> bytes_;
    std::string file_;
    std::map<std::string, Entry> entries_;
    std::size_t budget_ = 0;  // bytes that may still be read
};

}  // namespace tuft::io
