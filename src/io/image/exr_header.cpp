#include "io/image/exr_header.h"

#include <cstdint>
#include <optional>
#include <string_view>

namespace tuft::io {
namespace {

constexpr std::size_t kMagicAndVersion = 8;
constexpr std::uint32_t kMultipart = 0x1000;  // flag of the version

class Walker {
  public:
    Walker(std::span<const char> file, std::size_t max_pixels) : rest_(file), max_pixels_(max_pixels) {}

    Message run() {
        if (rest_.size() < kMagicAndVersion) return cut_short();
        rest_ = rest_.subspan(4);
        const bool many = (number() & kMultipart) != 0;
        for (;;) {
            if (rest_.empty()) return cut_short();
            if (many && rest_.front() == '\0') return {};  // no more parts
            while (!rest_.empty() && rest_.front() != '\0')
                if (Message fault = attribute(); !fault.empty()) return fault;
            if (rest_.empty()) return cut_short();
            rest_ = rest_.subspan(1);
            if (!many) return {};
        }
    }

  private:
    static Message cut_short() { return Message("its header is cut short"); }

    /// Little-endian; four bytes are there.
    std::uint32_t number() {
        std::uint32_t value = 0;
        for (std::size_t i = 4; i > 0; --i) value = value << 8 | static_cast<unsigned char>(rest_[i - 1]);
        rest_ = rest_.subspan(4);
        return value;
    }

    std::optional<std::string_view> word() {
        const std::string_view all(rest_.data(), rest_.size());
        const std::size_t end = all.find('\0');
        if (end == all.npos) return {};
        rest_ = rest_.subspan(end + 1);
        return all.substr(0, end);
    }

    Message attribute() {
        const auto name = word();
        const auto type = name ? word() : name;
        if (!type || rest_.size() < 4) return cut_short();
        const std::uint32_t size = number();
        if (size > rest_.size())
            return Message("an attribute of its header would take {} bytes, but {} are left of the file", size,
                           rest_.size());
        const std::span<const char> after = rest_.subspan(size);
        Message fault = *name == "dataWindow" && size == 16 ? window() : Message();
        rest_ = after;
        return fault;
    }

    /// First and last column and row: xMin, yMin, xMax, yMax.
    Message window() {
        std::int64_t corners[4];
        for (std::int64_t& corner : corners) corner = static_cast<std::int32_t>(number());
        const std::int64_t width = corners[2] - corners[0] + 1, height = corners[3] - corners[1] + 1;
        if (width <= 0 || height <= 0) return Message("it has no pixels");
        if (static_cast<std::size_t>(width) > max_pixels_ / static_cast<std::size_t>(height))
            return Message("it has {} × {} pixels, which is too many", width, height);
        return {};
    }

    std::span<const char> rest_;
    std::size_t max_pixels_;
};

}  // namespace

Message exr_header_fault(std::span<const char> file, std::size_t max_pixels) {
    return Walker(file, max_pixels).run();
}

}  // namespace tuft::io
