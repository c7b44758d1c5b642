#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "decal/sheet.h"

/// \file
/// Decal sheets as files for printers and plotters. Called by `tuft decals`.
namespace tuft::io {

/// Name of the spot colour, class and layer of cut lines. Plotters find it by this spelling.
inline constexpr const char* kCutContour = "CutContour";

/// Returns the layer of each ink of a sheet: "Ink " and its name, with `_` for control characters and `<>/\":;?*|='`,
/// which layers of CAD may not have. Of several of one name the second is "Ink NAME_2".
std::vector<std::string> ink_layers(const decal::Sheet& sheet);

/// The same by the rules of DXF R12: at most 31 of A-Z, a-z, 0-9, $, - and _; another character is an `_`.
std::vector<std::string> dxf_ink_layers(const decal::Sheet& sheet);

/// Writes a sheet; the extension chooses the format. Lengths are true: 1:1, in millimetres or points of 1/72 inch.
///
/// - `.pdf` (PDF 1.6): all pages in one file. Cut lines are hairlines of 0.25 points in the separation `CutContour`
///   (100 % magenta on screens), which overprint. Registration marks, numbers and scale bar are of the separation
///   `All`, on every plate. Pictures carry the ICC profile of the sheet (sRGB by default), with the coverage of paint
///   as soft mask; with plates each pigment is a separation of its own name, laid over the others (multiplied). Areas
///   of one ink are filled paths, of the plate's separation if there are plates.
/// - `.svg`: a file for each page, pictures as PNG inside; cut lines in a layer `CutContour`, areas of one
///   ink in a layer `Ink NAME` each.
/// - `.dxf` (R12, ASCII, millimetres): a file for each page of film, closed polylines on the layer `CutContour`, marks
///   on `Registration`, numbers and arrows on `Labels`, borders of areas of one ink on `Ink_NAME`; no pictures.
///
/// With several files their number stands before the extension: NAME-1.svg. All are written or none. Returns the paths
/// of what was written. Throws `Error` for another extension, for pictures of plates in SVG, and where a file cannot be
/// written.
std::vector<std::filesystem::path> write_sheet(const std::filesystem::path& path, const decal::Sheet& sheet);

/// Returns the bytes of one format. `page` counts from 0.
std::string pdf_bytes(const decal::Sheet& sheet);
std::string svg_text(const decal::Sheet& sheet, std::size_t page);
std::string dxf_text(const decal::Sheet& sheet, std::size_t page);

}  // namespace tuft::io
