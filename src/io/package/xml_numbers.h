#pragma once

#include <charconv>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

/// \file
/// Names and lists of numbers in XML files. Called by the readers of X3D and 3MF. Inside `io` only. Any thread.
namespace tuft::io {

/// Returns the name of an element or attribute without its namespace prefix.
inline std::string_view local_part(std::string_view name) {
    const std::size_t colon = name.find(':');
    return colon == name.npos ? name : name.substr(colon + 1);
}

/// Reads numbers separated by white space or commas. `text` must outlive it.
class NumberList {
  public:
    explicit NumberList(std::string_view text) : at_(text.data()), end_(at_ + text.size()) {}

    /// Returns the next number; nothing at the end or where the text is no number. A number beyond the range of T gives
    /// infinity, or the largest T where T has none.
    template <class T>
    std::optional<T> next() {
        while (at_ < end_ && (*at_ == ' ' || *at_ == ',' || *at_ == '\n' || *at_ == '\t' || *at_ == '\r')) ++at_;
        if (at_ < end_ && *at_ == '+') ++at_;
        T value{};
        const auto [stop, fault] = std::from_chars(at_, end_, value);
        if (fault == std::errc::invalid_argument) return std::nullopt;
        at_ = stop;
        if (fault != std::errc())
            value = std::numeric_limits<T>::has_infinity ? std::numeric_limits<T>::infinity()
                                                         : std::numeric_limits<T>::max();
        return value;
    }
    /// Returns true when only white space is left.
    bool at_end() {
        while (at_ < end_ && static_cast<unsigned char>(*at_) <= ' ') ++at_;
        return at_ == end_;
    }

  private:
    const char* at_;
    const char* end_;
};

}  // namespace tuft::io
