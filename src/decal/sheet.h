#pragma once

#include <string>
#include <vector>

#include "core/system/progress.h"
#include "decal/ink_areas.h"
#include "decal/outline.h"
#include "decal/print.h"

/// \file
/// Decal sheets: the paint of a model, or what a mask holds, on pages of film at true size, ready for a printer and a
/// plotter. `tuft decals` calls it; io/sheet writes the result.
namespace tuft::decal {

/// What a line is for.
enum class Role {
    cut,    ///< cut line: a spot colour of its own
    mark,   ///< registration marks and scale bar, on every plate
    label,  ///< numbers, arrows, ticks of laps and the foot of the page
};

/// A line on a page, metres from its lower left corner, y up.
struct Line {
    std::vector<Vec2> points;
    bool closed = false;
    Role role = Role::cut;
};

/// Paint of one ink on a page, with its borders instead of a picture.
struct InkArea {
    std::size_t ink = 0;  ///< index into `Sheet::inks`
    Region region;        ///< metres from the lower left corner, y up
};

/// A page of film, or the map of its strain.
struct Page {
    Vec2 size{0};  ///< metres
    std::vector<Line> lines;
    std::vector<PrintImage> prints;
    std::vector<InkArea> areas = {};
    bool strain_map = false;
};

/// A piece of film to be cut out and laid on.
struct Piece {
    int number = 1;           ///< as printed beside it
    std::size_t surface = 0;  ///< index into `Sheet::surfaces`
    Region film;              ///< cut line, in the plane of its surface, metres
    double paint_area = 0;    ///< m²
    double strain = 0;        ///< largest of the panel
    Vec2 up{0, 1};            ///< unit, of the arrow beside it, in that plane
    std::size_t page = 0;     ///< index into `Sheet::pages`
    PagePlacement placement;  ///< of that plane
    bool outlined = false;    ///< its paint is in `Page::areas`
};

/// A plate: one ink of a screen or pad print.
struct Plate {
    std::string name;                       ///< of the pigment
    std::array<double, 3> colour{0, 0, 0};  ///< sRGB 0–1 of a tint of 100 %, for screens
    double full = 1;                        ///< film units of a tint of 100 %
};

/// An ink of `Page::areas`.
struct SheetInk {
    std::string name;                                ///< `make_sheet` leaves it empty
    std::array<double, 3> colour{0, 0, 0};           ///< 0–1, coded as `PrintImage::rgb`
    std::optional<std::array<double, 3>> srgb = {};  ///< 0–1, cut to sRGB; empty: `colour` is
    std::vector<double> mix = {};  ///< [n_plates] parts of the pigments, sum 1; empty: those of its plate
};

/// What `make_sheet` left out; see there.
struct LeftOut {
    std::size_t fragments = 0;
    double paint_area = 0;  ///< m²
};

/// Pages of film, ready to be written.
struct Sheet {
    std::vector<Page> pages;
    std::vector<Piece> pieces;
    std::vector<PrintSurface> surfaces;
    std::vector<Plate> plates;   ///< of `PrintImage::plates`
    std::vector<SheetInk> inks;  ///< of `Page::areas`; with plates one for each, in their order
    double max_strain = 0;       ///< limit
    LeftOut left_out;
    /// ICC profile of the colours of `PrintImage::rgb`; empty: the writer's own of sRGB.
    std::vector<std::uint8_t> profile = {};
};

/// Options of `make_sheet`.
struct SheetOptions {
    double max_strain = 0.03;      ///< of the film
    double bleed = 0.003;          ///< film beyond the paint, metres
    double overlap = 0.001;        ///< of two panels, metres; the one with the lower number lies below
    double join = 0.01;            ///< see `OutlineOptions`
    double least_fragment = 1e-5;  ///< m² of paint; see `make_sheet`
    double least_piece = 0;        ///< the same, of slivers; 0: all are laid
    Vec2 page{0.21, 0.297};        ///< metres; height 0: a roll
    bool upright = false;          ///< all pieces with their arrow up the page; else where that takes hardly more film
    double pixel = 0.0254 / 300;   ///< metres
    bool strain_map = false;       ///< appends a page of strain for each page of film
    bool prints = true;            ///< makes pictures; else lines only
    bool outlines = false;         ///< areas instead of pictures; see `make_sheet`
    std::string title;             ///< in the foot of each page
    ProgressFn progress;
};

/// Largest part of the bleed that is printed beyond cut lines through paint, metres.
inline constexpr double kPrintedBleed = 0.003;

/// Whether a piece has less than `least` m² of paint on more than ten times as much film: a sliver, such as a drawing
/// leaves on the wall of a gap, or a fine line or a small dot that stands alone.
bool is_sliver(const Piece& piece, double least);

/// Returns the sheet of a model: panels by `cut_into_panels`, cut lines by `find_outlines`, nested by `nest`. The arrow
/// of a piece points up the model (+z), or on level surfaces to its back (+y). Pieces are numbered panel by panel.
///
/// A cut leaves fragments where it crosses a motif twice. One whose paint goes on over a seam, in a piece with at least
/// 100 times as much, and that has less than `least_fragment`, is too small to be laid and not missed: it is left out.
/// So are specks anywhere of less than a tenth of `least_fragment`, if all of them together have less than a thousandth
/// of all paint; and likewise slivers of less than `least_piece`. `Sheet::left_out` says how much.
///
/// With `outlines` the paint of a piece is `InkArea`s (`find_ink_area`): one for each plate if `PrintSource::plates`
/// are given, else one if the piece is painted in a single ink (`find_single_ink`); a piece of several inks is a
/// picture.
///
/// Pages of film come first, then their strain maps. Throws `Error` where nothing is painted or a piece fits no page.
/// The same bits for any number of threads.
Sheet make_sheet(const mesh::TriangleMesh& model, const PrintSource& source, const SheetOptions& options);

}  // namespace tuft::decal
