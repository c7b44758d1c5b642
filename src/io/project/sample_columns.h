#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "stroke/journal/entry/samples.h"

/// \file
/// Samples as columns of numbers: all times, then all x, …; like numbers beside each other compress well. Inside `io`
/// only.
namespace tuft::io {

inline constexpr std::size_t kSampleColumns = 11;  ///< time, position, pressure, tilt, rotation
inline constexpr std::size_t kRolledColumns = 12;  ///< and the roll, where a sample has one

/// Returns true when some sample has a roll.
inline bool has_roll(std::span<const stroke::StrokeSample> samples) {
    for (const stroke::StrokeSample& s : samples)
        if (s.roll != 0) return true;
    return false;
}

/// Puts a sample into row `row` of `numbers`: [columns × n_rows], columns kSampleColumns or kRolledColumns.
inline void put_sample(const stroke::StrokeSample& s, std::span<double> numbers, std::size_t n_rows, std::size_t row) {
    const std::array<double, kRolledColumns> fields{s.time,       s.position.x, s.position.y, s.position.z,
                                                    s.pressure,   s.tilt.x,     s.tilt.y,     s.rotation.w,
                                                    s.rotation.x, s.rotation.y, s.rotation.z, s.roll};
    for (std::size_t f = 0; f * n_rows < numbers.size(); ++f) numbers[f * n_rows + row] = fields[f];
}

/// Gets it back; without a column of rolls the roll is 0.
inline stroke::StrokeSample get_sample(std::span<const double> numbers, std::size_t n_rows, std::size_t row) {
    const auto field = [&](std::size_t f) { return numbers[f * n_rows + row]; };
    return {.time = field(0),
            .position = {field(1), field(2), field(3)},
            .pressure = field(4),
            .tilt = {field(5), field(6)},
            .roll = numbers.size() > kSampleColumns * n_rows ? field(kSampleColumns) : 0,
            .rotation = Quat(field(7), field(8), field(9), field(10))};
}

}  // namespace tuft::io
