#pragma once

#include <cstdint>

/// \file
/// Seeded random numbers. The same seed gives the same bits on every machine, for every module.
namespace tuft {

/// Returns a 64-bit mix of a seed and a counter (SplitMix64 finaliser, [Steele2014]). The same pair gives the
/// same bits everywhere, whatever the order of calls.
constexpr std::uint64_t hash_bits(std::uint64_t seed, std::uint64_t counter = 0) {
    std::uint64_t z = seed + 0x9e3779b97f4a7c15ULL * (counter + 1);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
}

/// Returns a number uniform in [0, 1) from a seed and a counter.
constexpr double uniform(std::uint64_t seed, std::uint64_t counter = 0) {
    return static_cast<double>(hash_bits(seed, counter) >> 11) * 0x1.0p-53;
}

/// A stream of numbers from one seed, for code that draws in sequence.
class Random {
  public:
    explicit constexpr Random(std::uint64_t seed) : seed_(seed) {}
    constexpr std::uint64_t bits() { return hash_bits(seed_, counter_++); }                ///< uniform
    constexpr double uniform() { return tuft::uniform(seed_, counter_++); }                ///< in [0, 1)
    constexpr double uniform(double lo, double hi) { return lo + (hi - lo) * uniform(); }  ///< in [lo, hi)

  private:
    std::uint64_t seed_;
    std::uint64_t counter_ = 0;
};

}  // namespace tuft
