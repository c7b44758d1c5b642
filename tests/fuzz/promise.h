#pragma once

#include <cstdio>
#include <cstdlib>
#include <span>

#include "core/error.h"

namespace tuft::fuzz {

/// Ends the program when what must hold does not, under any build type.
inline void promise(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "broken promise: %s\n", what);
    std::abort();
}

/// Runs `fn`; refusing its input with an `Error` is right.
template <class Fn>
void refusing(Fn&& fn) {
    try {
        fn();
    } catch (const Error&) {
    }
}

/// Reads numbers from the front of an input; zeros once it is used up.
class Bytes {
  public:
    explicit Bytes(std::span<const std::uint8_t> data) : data_(data) {}

    bool empty() const { return data_.empty(); }
    std::uint8_t byte() {
        if (data_.empty()) return 0;
        const std::uint8_t first = data_.front();
        data_ = data_.subspan(1);
        return first;
    }
    /// From -1 to 1.
    double real() {
        const int low = byte();
        return (static_cast<int>(byte()) * 256 + low - 32768) / 32768.0;
    }
    int below(int n) { return byte() % n; }

  private:
    std::span<const std::uint8_t> data_;
};

}  // namespace tuft::fuzz
