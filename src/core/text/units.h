#pragma once

#include <optional>
#include <string>
#include <string_view>

/// Conversions between the units people use and the SI units used inside.
/// Only `io`, `cli` and `app` convert.
namespace tuft {

inline constexpr double kMillimetre = 1e-3;              ///< metres
inline constexpr double kDegree = 0.017453292519943295;  ///< radians

/// Metres in one unit named `um`, `mm`, `cm`, `m`, `in` or `ft`; empty for any other name.
std::optional<double> metres_per(std::string_view unit);

/// In what terms a model file gives its points. Inside, z is up and lengths are metres: a point
/// (x, y, z) of a file whose y is up is (x, −z, y) here.
struct FileFrame {
    std::string unit = "mm";
    bool y_up = false;
};

}  // namespace tuft
