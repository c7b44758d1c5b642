#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/message.h"

/// \file
/// Reads ZIP archives, for 3MF. Inside `io` only.
namespace tuft::io {

class Zip {
  public:
    /// Reads the directory; `bytes` must outlive this. Throws `Error` naming `file` where it is damaged, encrypted or
    /// larger than 4 GiB (ZIP64).
    Zip(std::span<const char> bytes, std::string file);

    bool has(const std::string& name) const { return entries_.contains(name); }
    const auto& entries() const { return entries_; }
    /// What is in an entry, stored or deflated. All that is read of an archive takes 64 MiB and 64 times its size at
    /// most; more is an `Error`, and so is an entry that is not there.
    std::vector<char> read(const std::string& name);

  private:
    struct Entry {
        std::size_t offset = 0, packed = 0, size = 0;
        int method = 0;
    };
    [[noreturn]] void fail(const Message& what) const;
    std::uint32_t number(std::size_t at, int n_bytes) const;

    std::span<const char> bytes_;
    std::string file_;
    std::map<std::string, Entry> entries_;
    std::size_t budget_ = 0;
};

}  // namespace tuft::io
