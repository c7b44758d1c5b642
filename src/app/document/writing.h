#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "mesh/query/surface_query.h"
#include "stroke/drawing/drawing.h"
#include "stroke/journal/recorded_stroke.h"

/// \file
/// A drawing or handwriting before it is placed on the model. Called by tools/writing_tool.h. Window thread.
namespace tuft::app {

/// What is put onto the model.
struct WritingForm {
    std::vector<stroke::RecordedStroke> traces;  ///< flat, metres, in the frame of the file
    std::vector<Message> notes;                  ///< skipped content of the file, one line each
    Vec2 centre{0};                              ///< metres, of the ink of all traces
    double width = 0, height = 0;                ///< metres, of the ink of all traces, as in the file
    Box box;                                     ///< metres, of the ink of all traces, in the frame of the file
};

/// What the copies of a drawing follow.
enum class BandLine {
    none,   ///< it is placed once
    edge,   ///< the feature line nearest to the cursor
    rim,    ///< round the model, level, through the cursor
    curve,  ///< the curve set last with the tool Curve
};

/// A loaded drawing and how the user places it.
struct Writing {
    std::filesystem::path file;
    WritingForm lines;      ///< strokes of a brush; of a picture none
    WritingForm areas;      ///< in the colours of the file, each shape masked and filled; only of a drawing in colours
    double scale = 1;       ///< times the size in the file
    double turn = 0;        ///< radians, clockwise in the view
    bool mirrored = false;  ///< from left to right
    stroke::SurfaceMapping mapping = stroke::SurfaceMapping::drape;
    BandLine along = BandLine::none;
    int repeats = 0;        ///< copies along a line; 0: as many as it has room for, made to meet
    bool own_ink = false;   ///< uses the inks that the file names: `areas` where there are any, else brush and ink
    bool own_width = true;  ///< uses the line widths of the drawing, where it has any

    bool empty() const { return lines.traces.empty() && areas.traces.empty(); }
    bool in_colours() const { return own_ink && !areas.traces.empty(); }
    const WritingForm& form() const { return in_colours() ? areas : lines; }
};

/// Reads an InkML or SVG file. `own_ink` is set where the file names more than one ink. Throws `Error`, also when
/// nothing in it is flat.
Writing read_writing(const std::filesystem::path& file);

/// Returns the lines that an InkML file, or an SVG in black alone, is painted by, or the outlines of the areas of an
/// SVG in colours; the longer side of the drawing is [0, 1], its centre (0.5, 0.5), y down. Reads the file once. Throws
/// `Error` as `read_writing`. Any thread.
std::vector<std::vector<Vec2>> read_sketch(const std::filesystem::path& file);

/// Returns a point of the model rounded to 0.001 mm, as options state it; metres.
Vec3 rounded_place(const Vec3& at);

/// How something flat is turned and mapped.
struct FlatPose {
    double turn = 0;  ///< radians, clockwise in the view
    stroke::SurfaceMapping mapping = stroke::SurfaceMapping::drape;
};

/// `place_writing` for anything flat.
stroke::Placement place_flat(const mesh::SurfaceQuery& query, const Vec3& at, const Vec3& normal, const Vec3& right,
                             const Vec3& eye, const FlatPose& pose);

/// Returns the placement with the drawing's centre at the surface point `at` (metres). `right`: unit, the view's right.
/// `normal`: unit, towards the eye. `eye`: unit, direction to the eye. Origin and turn are rounded to 0.001 mm and
/// 0.01° as in `tuft paint --place --place-turn --read-from`, so that `place_words` states them exactly.
stroke::Placement place_writing(const Writing& writing, const mesh::SurfaceQuery& query, const Vec3& at,
                                const Vec3& normal, const Vec3& right, const Vec3& eye);

/// Returns the scale at which the drawing is painted: `writing.scale` with the width rounded to 0.001 mm.
double painted_scale(const Writing& writing);

/// Returns the width that it is painted with, metres, rounded to 0.001 mm.
double painted_width(const Writing& writing);

/// Returns the options of `tuft paint` for size and kind of a drawing, with a space before each.
std::string size_words(const Writing& writing);

/// Returns the options of `tuft paint` for this placement: "--place 1.000,2.000,3.000 --place-width 60.000 --place-turn
/// 5.00"; for SVG with the "--areas" by which it is painted.
std::string place_words(const Writing& writing, const stroke::Placement& placement);
/// The same for anything flat: without width and areas.
std::string place_words(const stroke::Placement& placement);

/// Returns a text as one argument of a shell; lines are divided by \\n.
std::string quoted(const std::string& text);

/// Returns true when the drawing has line widths.
bool has_widths(const Writing& writing);

/// Brush and pressure for a drawing.
struct WritingHand {
    std::string brush, ink;  ///< presets; with `Writing::own_ink` for traces that name none
    double pressure = 1;     ///< factor on default pressures, for lines without widths
};

/// A drawing's traces as journal entries at a placement. Not set yet are brush sizes and pressures
/// (`stroke::choose_brushes`, `stroke::press_to_widths`) and films of areas (`stroke::mix_drawing_inks`).
struct PlacedWriting {
    std::vector<stroke::JournalEntry> entries;
    double scale = 1;   ///< times the size in the file
    double extent = 0;  ///< metres, the larger side on the model
    stroke::BrushFit fit;
};
PlacedWriting placed_writing(const Writing& writing, const stroke::Placement& placement, const WritingHand& hand);
/// The same before they have a place: in the frame of the file, with their mapping.
PlacedWriting unplaced_writing(const Writing& writing, const WritingHand& hand);

/// Returns the lines of a drawing and the outlines of its areas, the latter closed; metres, in the frame of the file.
std::vector<std::vector<Vec2>> drawn_lines(const WritingForm& form);

/// Returns the drawing's lines and the outlines of its areas on the surface, for a preview: one for each part that is
/// on the surface, at most `most` samples in total.
struct PreviewPoint {
    Vec3 position, normal;  ///< metres; unit
    bool seen = true;       ///< not occluded by the model
};
std::vector<std::vector<PreviewPoint>> preview_lines(const mesh::SurfaceQuery& query, const Writing& writing,
                                                     const stroke::Placement& placement, std::size_t most = 3000);
/// The same of lines in the frame of the placement, metres.
std::vector<std::vector<PreviewPoint>> preview_lines(const mesh::SurfaceQuery& query,
                                                     const std::vector<std::vector<Vec2>>& lines,
                                                     const stroke::Placement& placement, std::size_t most = 3000);

}  // namespace tuft::app
