#pragma once

#include <cmath>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/message.h"
#include "stroke/journal/recorded_stroke.h"

namespace pugi {
class xml_node;
}

/// \file
/// Elements of an InkML file as text, and our own annotations (`tuft:...`). Called by inkml.cpp only. One thread at a
/// time per file.
namespace tuft::io {

/// The text of a file, for errors with line numbers. The references must outlive it.
struct InkmlText {
    std::string_view content;
    const std::string& path;             ///< as named in errors
    mutable std::ptrdiff_t counted = 0;  ///< offset up to which lines are counted
    mutable long counted_line = 1;       ///< line there

    /// Returns the line of the character at `offset`, from 1. Ascending offsets cost one pass over the file in total.
    long line_at(std::ptrdiff_t offset) const;
    /// Throws `Error` with the element's line.
    [[noreturn]] void fail(const pugi::xml_node& node, const Message& what) const;
    /// Returns an attribute as a number. Throws `Error` when it is none.
    double number_of(const pugi::xml_node& node, const char* attribute) const;
};

/// Returns an element's name without its namespace.
std::string_view local_name(const pugi::xml_node& node);
/// Returns an element's own text.
std::string text_of(const pugi::xml_node& node);
std::string_view trimmed(std::string_view s);
/// Returns true when a vector of that squared length is a unit vector. Normalising it again would change its last bits.
inline bool is_unit(double squared_length) {
    return std::abs(squared_length - 1) <= 1e-14;
}
/// Returns all of `s` as a finite number, else nothing.
std::optional<double> to_number(std::string_view s);

/// Own annotations that hold at one place of the file.
struct InkmlMarks {
    stroke::Placement placement;
    bool placed = false;
    std::string brush, ink, label, layer, mask;
    std::vector<stroke::StencilEdge> stencil;
    std::uint64_t seed = 0;
    std::optional<stroke::StrokeSettings> settings;
    bool erases = false, on_palette = false, keeps_clock = false;
};

/// Adds the annotations of `parent` to `marks`. Throws `Error` for unknown types and invalid values.
void apply_marks(const InkmlText& file, InkmlMarks& marks, const pugi::xml_node& parent);

/// Returns the brush actions before a trace, in the order written.
std::vector<stroke::Preparation> preparations_of(const InkmlText& file, const pugi::xml_node& trace);

}  // namespace tuft::io
