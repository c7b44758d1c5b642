#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

/// \file
/// Writer of ZIP archives, for OpenRaster and 3MF. Inside `io` only.
namespace tuft::io {

/// An archive in memory. The same entries give the same bytes: every entry has the date 1 January 1980.
class ZipWriter {
  public:
    enum class Method { stored, deflated };

    /// Appends an entry. Throws `Error` where the archive would pass 4 GiB (ZIP64) or 65,534 entries.
    void add(const std::string& name, std::span<const std::uint8_t> bytes, Method method = Method::deflated);
    void add(const std::string& name, const std::string& text, Method method = Method::deflated);
    /// Appends the directory and returns all.
    std::vector<std::uint8_t> finish();

  private:
    std::vector<std::uint8_t> bytes_, directory_;
    std::size_t count_ = 0;
};

}  // namespace tuft::io
