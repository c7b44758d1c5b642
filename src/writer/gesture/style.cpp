#include "writer/gesture/style.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/toml_text.h"
#include "core/text/units.h"
#include "writer/gesture/stroke_line.h"

namespace fs = std::filesystem;

namespace tuft::writer {
namespace {

struct Range {
    double Style::*field;
    double lo, hi;    ///< as written
    double unit = 1;  ///< of the file in SI
};

const std::map<std::string, Range, std::less<>> kNumbers{
    {"brush_side_mm", {&Style::brush_side, 1, 10'000, kMillimetre}},
    {"speed_mm_s", {&Style::speed, 1, 2000, kMillimetre}},
    {"bend_radius", {&Style::bend_radius, 1, 10'000}},
    {"ends", {&Style::ends, 0.02, 1}},
    {"ease", {&Style::ease, 1, 1000}},
    {"half_width", {&Style::half_width, 1, 200}},
    {"link", {&Style::link, 0, 1024}},
    {"link_half", {&Style::link_half, 0, 50}},
    {"rounding", {&Style::rounding, 0, 200}},
    {"weight", {&Style::weight, 0.1, 3}},
    {"slant_deg", {&Style::slant, -45, 45, kDegree}},
    {"edge_angle_deg", {&Style::edge_angle, -180, 180, kDegree}},
    {"edge_pressure", {&Style::edge_pressure, 0.05, 1}},
    {"spacing", {&Style::spacing, 0.1, 10}},
    {"line_spacing", {&Style::line_spacing, 0.1, 10}},
};

fs::path style_folder() {
    return data_folder() / "models" / "writer";
}

/// Reads the table of leans, degrees, by codes of segments.
void read_leans(Style& style, const toml::node& node, const std::string& source) {
    constexpr double kMost = 45;
    const toml::table* table = node.as_table();
    if (!table) throw Error(source, static_cast<long>(node.source().begin.line), Message("'lean_deg' must be a table"));
    for (const auto& [key, value] : *table) {
        const auto degrees = value.value<double>();
        const long line = static_cast<long>(value.source().begin.line);
        if (key.str().size() != 1 || kSegmentCodes.find(key.str()) == std::string_view::npos)
            throw Error(source, line,
                        Message("'lean_deg' has no segment '{}': H, T, U, L, P, S or N", std::string(key.str())));
        if (!value.is_number() || !degrees || !(std::abs(*degrees) <= kMost))
            throw Error(
                source, line,
                Message("'{}' has a value that is no number from {} to {}", std::string(key.str()), -kMost, kMost));
        style.lean[key.str().front()] = *degrees * kDegree;
    }
}

void read_key(Style& style, const std::string& key, const toml::node& node, const std::string& source) {
    const auto fail = [&](const Message& what) {
        throw Error(source, static_cast<long>(node.source().begin.line), what);
    };
    if (key == "name" || key == "note") return;
    if (key == "brush") {
        const auto text = node.value<std::string>();
        if (!text || text->empty()) fail(Message("'brush' must be the name of a brush"));
        style.brush = *text;
    } else if (key == "kind") {
        static const std::map<std::string, HandKind> kinds{
            {"brush", HandKind::brush}, {"line", HandKind::line}, {"nib", HandKind::nib}};
        const auto found = kinds.find(node.value_or<std::string>(""));
        if (found == kinds.end()) fail(Message("'kind' must be brush, line or nib"));
        style.kind = found->second;
    } else if (key == "lean_deg") {
        read_leans(style, node, source);
    } else if (key == "tries") {
        const auto n = node.value<std::int64_t>();
        if (!n || *n < 1 || *n > 100) fail(Message("'tries' must be a whole number from 1 to 100"));
        style.tries = static_cast<int>(*n);
    } else if (const auto at = kNumbers.find(key); at != kNumbers.end()) {
        const Range& r = at->second;
        const auto value = node.value<double>();
        if (!node.is_number() || !value || !(*value >= r.lo && *value <= r.hi))
            fail(Message("'{}' has a value that is no number from {} to {}", key, r.lo, r.hi));
        style.*r.field = *value * r.unit;
    } else {
        std::vector<std::string> known{"brush", "kind", "tries", "lean_deg", "name", "note"};
        for (const auto& [name, range] : kNumbers) known.push_back(name);
        fail(Message("unknown key '{}'{}", key, did_you_mean(nearest_name(key, known))));
    }
}

}  // namespace

std::vector<std::string> list_styles() {
    std::vector<std::string> names;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(style_folder(), error))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

Style parse_style(std::string_view text, const std::string& source) {
    const toml::table root = parse_toml(text, source);
    Style style;
    for (const auto& [key, node] : root) read_key(style, std::string(key.str()), node, source);
    style.name = root["name"].value_or(fs::path(source).stem().string());
    return style;
}

Style load_style(const std::string& name_or_path) {
    fs::path path = name_or_path;
    if (name_or_path.find('/') == std::string::npos && path.extension() != ".toml") {
        const std::vector<std::string> names = list_styles();
        if (std::find(names.begin(), names.end(), name_or_path) == names.end())
            throw Error(Message("unknown style '{}'{}", name_or_path, did_you_mean(nearest_name(name_or_path, names))));
        path = style_folder() / (name_or_path + ".toml");
    }
    const std::vector<char> bytes = read_file(path, 1 << 20);
    return parse_style({bytes.data(), bytes.size()}, path.string());
}

}  // namespace tuft::writer
