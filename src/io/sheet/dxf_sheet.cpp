#include <fmt/format.h>

#include "io/sheet/sheet_files.h"

/// DXF R12 (AC1009): pairs of a group code and a value, one a line.
namespace tuft::io {
namespace {

constexpr double kMm = 1000;  // millimetres per metre

struct Layer {
    decal::Role role;
    const char* name;
    int colour;  // of AutoCAD's index: 6 magenta, 7 black or white, 8 grey
};
constexpr Layer kLayers[] = {
    {decal::Role::cut, kCutContour, 6}, {decal::Role::mark, "Registration", 7}, {decal::Role::label, "Labels", 8}};

std::string pair(int code, const std::string& value) {
    return fmt::format("{:3}\n{}\n", code, value);
}
std::string pair(int code, double value) {
    return pair(code, fmt::format("{:.5f}", value));
}

/// That lengths are decimal millimetres. R12 knows no unit of the drawing. These are the variables of later releases, 4
/// millimetres and 1 metric, which readers look for in files of any release, and others pass over.
std::string header_units() {
    return pair(9, "$LUNITS") + pair(70, "2") + pair(9, "$MEASUREMENT") + pair(70, "1") + pair(9, "$INSUNITS") +
           pair(70, "4");
}

std::string polyline(const decal::Line& line, const std::string& layer) {
    std::string text = pair(0, "POLYLINE") + pair(8, layer) + pair(66, "1") + pair(10, 0.0) + pair(20, 0.0) +
                       pair(30, 0.0) + pair(70, line.closed ? "1" : "0");
    for (const Vec2& p : line.points)
        text += pair(0, "VERTEX") + pair(8, layer) + pair(10, kMm * p.x) + pair(20, kMm * p.y) + pair(30, 0.0);
    return text + pair(0, "SEQEND") + pair(8, layer);
}

/// Index of AutoCAD's own colours for an ink, of those that tell inks apart.
int ink_colour(std::size_t ink) {
    constexpr int kColours[] = {7, 1, 5, 3, 30, 4, 200, 8};
    return kColours[ink % std::size(kColours)];
}

std::string layer_entry(const std::string& name, int colour) {
    return pair(0, "LAYER") + pair(2, name) + pair(70, "0") + pair(62, std::to_string(colour)) + pair(6, "CONTINUOUS");
}

}  // namespace

std::string dxf_text(const decal::Sheet& sheet, std::size_t index) {
    const decal::Page& page = sheet.pages[index];
    std::string text = pair(999, "decal sheet, millimetres, true size") + pair(0, "SECTION") + pair(2, "HEADER") +
                       pair(9, "$ACADVER") + pair(1, "AC1009") + pair(9, "$EXTMIN") + pair(10, 0.0) + pair(20, 0.0) +
                       pair(30, 0.0) + pair(9, "$EXTMAX") + pair(10, kMm * page.size.x) + pair(20, kMm * page.size.y) +
                       pair(30, 0.0) + header_units() + pair(0, "ENDSEC");
    text += pair(0, "SECTION") + pair(2, "TABLES") + pair(0, "TABLE") + pair(2, "LTYPE") + pair(70, "1") +
            pair(0, "LTYPE") + pair(2, "CONTINUOUS") + pair(70, "0") + pair(3, "Solid line") + pair(72, "65") +
            pair(73, "0") + pair(40, 0.0) + pair(0, "ENDTAB");
    text += pair(0, "TABLE") + pair(2, "LAYER") + pair(70, std::to_string(std::size(kLayers) + sheet.inks.size()));
    for (const Layer& layer : kLayers) text += layer_entry(layer.name, layer.colour);
    const std::vector<std::string> inks = dxf_ink_layers(sheet);
    for (std::size_t i = 0; i < inks.size(); ++i) text += layer_entry(inks[i], ink_colour(i));
    text += pair(0, "ENDTAB") + pair(0, "ENDSEC") + pair(0, "SECTION") + pair(2, "ENTITIES");
    for (const Layer& layer : kLayers)
        for (const decal::Line& line : page.lines)
            if (line.role == layer.role) text += polyline(line, layer.name);
    for (const decal::InkArea& area : page.areas)
        for (const decal::Ring& ring : area.region) text += polyline({ring, true}, inks[area.ink]);
    return text + pair(0, "ENDSEC") + pair(0, "EOF");
}

}  // namespace tuft::io
