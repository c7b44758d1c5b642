#pragma once

#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

/// \file
/// Whole numbers of JSON that somebody else wrote. The library's own conversion of 1e300 to an integer is undefined,
/// and that of −1 gives a number that is not in the file.
namespace tuft::io {

/// The value as a whole number of type T; 4.0 is one. Throws `nlohmann::json::type_error` where it is none, or not
/// within T, as the library does for a text.
template <class T>
T whole_number(const nlohmann::json& value) {
    constexpr double kExact = 9007199254740992;  // 2⁵³: up to it each whole number is a double
    if (value.is_number_unsigned()) {
        if (const auto v = value.get<std::uint64_t>(); std::in_range<T>(v)) return static_cast<T>(v);
    } else if (value.is_number_integer()) {
        if (const auto v = value.get<std::int64_t>(); std::in_range<T>(v)) return static_cast<T>(v);
    } else if (value.is_number_float()) {
        const double v = value.get<double>();
        if (std::abs(v) <= kExact && v == std::floor(v) && std::in_range<T>(static_cast<std::int64_t>(v)))
            return static_cast<T>(v);
    }
    throw nlohmann::json::type_error::create(302, "a whole number is expected", &value);
}

/// The same of a member of an object; `otherwise` where it has none.
template <class T>
T whole_number(const nlohmann::json& object, const std::string& key, T otherwise) {
    if (!object.is_object()) throw nlohmann::json::type_error::create(306, "an object is expected", &object);
    const auto member = object.find(key);
    return member == object.end() ? otherwise : whole_number<T>(*member);
}

}  // namespace tuft::io
