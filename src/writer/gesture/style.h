#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// \file
/// Styles of writing: parameters of a hand, from a TOML file. Called by the writer.
namespace tuft::writer {

inline constexpr int kFitTries = 3;  ///< drawings on the plane by which a stroke is fitted, at most

/// How a hand's strokes get their width.
enum class HandKind {
    brush,  ///< heads, travel, turns, hooks and ends of a pointed brush, by class of stroke
    line,   ///< one width everywhere
    nib,    ///< a broad edge at a fixed angle, pressed evenly
};

/// A style of writing. Units are 1/1024 of a character's side.
struct Style {
    std::string name;
    HandKind kind = HandKind::brush;
    std::string brush = "goat-medium";  ///< preset, made for a character of side `brush_side`
    double brush_side = 0.133;          ///< metres
    double speed = 0.06;                ///< m/s at that side; proportional to it
    double bend_radius = 150;           ///< units, of the two-thirds law
    double ends = 0.3, ease = 40;       ///< part of the speed at ends; units over which it rises
    int tries = kFitTries;              ///< of the fit of a stroke
    double half_width = 18;             ///< units; of `line`, and the edge of `nib`
    double link = 0;                    ///< units: gaps up to this length are drawn as thin lines
    double link_half = 5;               ///< units, half width in the middle of a short one
    double rounding = 0;                ///< units over which corners are rounded
    double weight = 1;                  ///< factor of all half widths
    double slant = 0;                   ///< radians, letters lean to the right
    double edge_angle = 0.6981317;      ///< radians, of the nib's edge above the line
    double edge_pressure = 0.15;        ///< of the nib, part of the working depth
    /// Radians by which the holder leans back along the path, by the code of a segment (`segment_code`); others: 0.
    std::map<char, double> lean;
    double spacing = 1.05, line_spacing = 1.25;  ///< parts of the side, between centres of squares
};

/// Reads `models/writer/NAME.toml` by name, or a file. Throws `Error` naming file, line and value for an unknown key or
/// a value out of range, and with the nearest name for an unknown style.
Style load_style(const std::string& name_or_path);
Style parse_style(std::string_view text, const std::string& source);
std::vector<std::string> list_styles();

}  // namespace tuft::writer
