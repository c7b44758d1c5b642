#pragma once

#include <optional>
#include <string>
#include <string_view>

/// \file
/// Conversions between the units of users and files and the SI units inside. Only `io`, `cli` and `app` convert.
namespace tuft {

inline constexpr double kMillimetre = 1e-3;              ///< metres
inline constexpr double kDegree = 0.017453292519943295;  ///< radians

/// Returns the metres in one unit named `um`, `mm`, `cm`, `m`, `in` or `ft`. Empty for any other name.
std::optional<double> metres_per(std::string_view unit);

/// Unit and vertical axis of a model file's points. Inside, z is up and lengths are metres: a point (x, y, z) of a
/// file with y up becomes (x, −z, y).
struct FileFrame {
    std::string unit = "mm";
    bool y_up = false;
    bool unit_overrides = false;  ///< `unit` was said of a file that states another one
};

}  // namespace tuft
