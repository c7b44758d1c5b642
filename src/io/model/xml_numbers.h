#pragma once

#include <charconv>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>

/// \file
/// Names and lists of numbers in XML files of models. Inside `io` only.
namespace tuft::io {

/// The name of an element or attribute without its prefix.
inline std::string_view local_part(std::string_view name) {
    const std::size_t colon = name.find(':');
    return colon == name.npos ? name : name.substr(colon + 1);
}

/// Numbers with white space or commas between them, one after the other.
class NumberList {
  public:
    explicit NumberList(std::string_view text) : at_(text.data()), end_(at_ + text.size()) {}

    /// Nothing at the end, and at what is no number. One beyond what T holds is infinite, or the largest.
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
    bool at_end() {
        while (at_ < end_ && static_cast<unsigned char>(*at_) <= ' ') ++at_;
        return at_ == end_;
    }

  private:
    const char* at_;
    const char* end_;
};

}  // namespace tuft::io
