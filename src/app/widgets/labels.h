#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

/// \file
/// Names in little room.
namespace tuft::app {

/// Space for one label.
struct LabelSpace {
    std::size_t lines = 1;
    float width = 0;                                    ///< of a line
    std::function<float(const std::string&)> width_of;  ///< of a text without line breaks
};

/// Shortens names to labels of at most so many lines, broken at spaces. A line that is too wide ends with "...".
/// Labels that would be the same keep the ends of their names instead of the beginnings, or get a number: labels of
/// different names are different. UTF-8.
std::vector<std::string> make_distinct(const std::vector<std::string>& names, const LabelSpace& room);

/// Joins texts to lines of at most that width: a text begins a new line where it does not fit, and is never broken.
/// Spaces at the end of a line count for nothing.
std::string lines_of(const std::vector<std::string>& texts, float width,
                     const std::function<float(const std::string&)>& width_of);

}  // namespace tuft::app
