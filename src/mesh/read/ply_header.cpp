#include "mesh/read/ply_header.h"

#include <algorithm>
#include <charconv>
#include <span>

#include "core/error.h"
#include "mesh/read/text_cursor.h"

namespace tuft::mesh {
namespace {

std::string lower(std::string_view s) {
    std::string out(s);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
    return out;
}

PlyType parse_type(TextCursor& text) {
    const std::string name = lower(text.word());
    struct Name {
        const char *old_name, *new_name;
        PlyType type;
    };
    constexpr Name kNames[] = {{"char", "int8", PlyType::kInt8},        {"uchar", "uint8", PlyType::kUint8},
                               {"short", "int16", PlyType::kInt16},     {"ushort", "uint16", PlyType::kUint16},
                               {"int", "int32", PlyType::kInt32},       {"uint", "uint32", PlyType::kUint32},
                               {"float", "float32", PlyType::kFloat32}, {"double", "float64", PlyType::kFloat64}};
    for (const Name& n : kNames)
        if (name == n.old_name || name == n.new_name) return n.type;
    text.fail(Message("{} is not a PLY type such as float or uchar", in_quotes(name)));
}

PlyFormat parse_format(TextCursor& text) {
    const std::string name = lower(text.word());
    if (name == "ascii") return PlyFormat::kAscii;
    if (name == "binary_little_endian") return PlyFormat::kLittleEndian;
    if (name == "binary_big_endian") return PlyFormat::kBigEndian;
    text.fail(Message("{} is not a PLY format", in_quotes(name)));
}

PlyElement parse_element(TextCursor& text) {
    PlyElement element;
    element.line = text.line();
    element.name = lower(text.word());
    const std::int64_t count = text.integer("the number of rows");
    if (count < 0) text.fail(Message("an element cannot have {} rows", count));
    element.count = static_cast<std::uint64_t>(count);
    return element;
}

PlyProperty parse_property(TextCursor& text) {
    PlyProperty property;
    TextCursor ahead = text;
    if (same_word(ahead.word(), "list")) {
        text.word();
        property.is_list = true;
        property.count_type = parse_type(text);
    }
    property.type = parse_type(text);
    property.name = lower(text.word());
    if (property.name.empty()) text.fail("the property has no name");
    return property;
}

/// After the word end_header the rows begin right behind the line's end. In a file whose
/// lines end with CR alone, an LF that follows is already data.
std::size_t body_offset(const std::vector<char>& bytes, const char* after_word) {
    const char* end = bytes.data() + bytes.size();
    const char* p = after_word;
    while (p != end && *p != '\n' && *p != '\r') ++p;
    if (p != end && *p == '\r') {
        const auto first_lf = std::find(bytes.begin(), bytes.end(), '\n');
        const auto first_cr = std::find(bytes.begin(), bytes.end(), '\r');
        const bool crlf = first_lf != bytes.end() && first_lf == first_cr + 1;
        if (crlf && p + 1 != end && p[1] == '\n') ++p;
    }
    if (p != end) ++p;
    return static_cast<std::size_t>(p - bytes.data());
}

}  // namespace

std::size_t size_of(PlyType type) {
    switch (type) {
        case PlyType::kInt8:
        case PlyType::kUint8:
            return 1;
        case PlyType::kInt16:
        case PlyType::kUint16:
            return 2;
        case PlyType::kFloat64:
            return 8;
        default:
            return 4;
    }
}

bool is_real(PlyType type) {
    return type == PlyType::kFloat32 || type == PlyType::kFloat64;
}

std::size_t PlyElement::least_row_size(PlyFormat format) const {
    std::size_t size = 0;
    for (const PlyProperty& p : properties)
        size += format == PlyFormat::kAscii ? 2 : size_of(p.is_list ? p.count_type : p.type);
    return size;
}

bool PlyElement::has_list() const {
    return std::any_of(properties.begin(), properties.end(), [](const PlyProperty& p) { return p.is_list; });
}

int PlyElement::find(std::initializer_list<const char*> names) const {
    for (std::size_t i = 0; i < properties.size(); ++i)
        for (const char* wanted : names)
            if (properties[i].name == wanted) return static_cast<int>(i);
    return -1;
}

PlyHeader read_ply_header(const std::vector<char>& bytes, const std::string& file) {
    // No sane head is longer; a file without end_header must not be searched to its end.
    constexpr std::size_t kMaxHeader = 1 << 20;
    const std::span<const char> head(bytes.data(), std::min(bytes.size(), kMaxHeader));
    TextCursor text(head, file, {.comment = 0});
    if (!text.skip_to_token() || !same_word(text.word(), "ply"))
        text.fail("is not a PLY file: the first line must be 'ply'");
    text.next_line();
    PlyHeader header;
    bool has_format = false;
    while (text.skip_to_token()) {
        const std::string key = lower(text.word());
        if (key == "format") {
            header.format = parse_format(text);
            has_format = true;
        } else if (key == "element") {
            header.elements.push_back(parse_element(text));
        } else if (key == "property") {
            if (header.elements.empty()) text.fail("a property stands before any element");
            header.elements.back().properties.push_back(parse_property(text));
        } else if (key == "comment") {
            if (same_word(text.word(), "TextureFile")) header.textures.emplace_back(text.rest());
        } else if (key == "end_header") {
            if (!has_format) text.fail("the head does not say its format");
            header.body = body_offset(bytes, text.position());
            header.body_line = text.line() + 1;
            return header;
        } else if (key != "obj_info") {
            text.fail(Message("{} is not a PLY keyword; the head may be damaged", in_quotes(key)));
        }
        text.next_line();
    }
    text.fail("the head has no end_header line; the file is cut off or damaged");
}

}  // namespace tuft::mesh
