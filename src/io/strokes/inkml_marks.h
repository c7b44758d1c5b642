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

/// The elements of an InkML file as text, and our own annotations among them (`tuft:...`).
namespace tuft::io {

/// The file, for telling where something is wrong.
struct InkmlText {
    std::string_view content;
    const std::string& path;             ///< as it is named in errors
    mutable std::ptrdiff_t counted = 0;  ///< offset up to which lines are counted
    mutable long counted_line = 1;       ///< line there

    /// Line of the character at `offset`, from 1. Offsets that ascend cost one pass over the file in all.
    long line_at(std::ptrdiff_t offset) const;
    /// Throws `Error` with the element's line.
    [[noreturn]] void fail(const pugi::xml_node& node, const Message& what) const;
    /// Throws `Error` when the attribute is no number.
    double number_of(const pugi::xml_node& node, const char* attribute) const;
};

/// The element's name without its namespace.
std::string_view local_name(const pugi::xml_node& node);
/// The element's own text.
std::string text_of(const pugi::xml_node& node);
std::string_view trimmed(std::string_view s);
/// Whether a vector of that squared length was normalised already: doing so again would change its last bits.
inline bool is_unit(double squared_length) {
    return std::abs(squared_length - 1) <= 1e-14;
}
/// The whole of `s` as a finite number.
std::optional<double> to_number(std::string_view s);

/// Own annotations in force at one place of the file.
struct InkmlMarks {
    stroke::Placement placement;
    bool placed = false;
    std::string brush, ink, label, layer, mask;
    std::vector<stroke::StencilEdge> stencil;
    std::uint64_t seed = 0;
    std::optional<stroke::StrokeSettings> settings;
    bool erases = false, on_palette = false, keeps_clock = false;
};

/// Takes over what the annotations of `parent` say; throws `Error` for what means nothing.
void apply_marks(const InkmlText& file, InkmlMarks& marks, const pugi::xml_node& parent);

/// What is to be done before this trace, in the order written.
std::vector<stroke::Preparation> preparations_of(const InkmlText& file, const pugi::xml_node& trace);

}  // namespace tuft::io
