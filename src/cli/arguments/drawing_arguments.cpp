#include "cli/arguments/drawing_arguments.h"

#include <CLI/CLI.hpp>

#include "cli/arguments/options.h"

namespace tuft::cli {
namespace {

void add_area_options(CLI::App& command, Paint& paint) {
    command
        .add_option(
            "--areas", paint.drawing.areas,
            "how drawings (.svg) are painted: mask, in the colours of the file, each shape masked and filled, in "
            "the order of the file; brush, in one ink (--ink) by lines of a brush, white left bare; default: mask "
            "where the file has colours besides black and neither --ink, --brush nor --erase is given, else brush")
        ->check(CLI::IsMember({"mask", "brush"}));
    command
        .add_option("--wide-lines", paint.drawing.wide_lines_mm,
                    "lines of a drawing in one ink are masked and filled from this width on, with the ends, corners "
                    "and dashes of the file; narrower ones, and all with --areas brush, --brush or --erase, are "
                    "strokes of a brush")
        ->check(number_in(0.0, 1e6))
        ->type_name("MM");
    command
        .add_option("--edges", paint.place.edges,
                    "where masked areas of drawings end: facing (default), on all that faces the drawing, parts seen "
                    "through openings too; cut, on what is connected with the middle of the drawing, beyond its shut "
                    "lines, not beyond openings and steps; run-over, as facing, and on walls; end-before, as cut, and "
                    "all strokes too a margin before sharp edges and borders; wrap, round edges along the surface "
                    "(--mapping wrap)")
        ->check(CLI::IsMember({"facing", "cut", "run-over", "end-before", "wrap"}));
    command.add_option("--edge-margin", paint.place.edge_margin_mm, "distance that end-before leaves")
        ->check(number_in(0.01, 1000.0))
        ->needs("--edges")
        ->type_name("MM");
    command
        .add_option("--only", paint.drawing.only,
                    "only these layers and named groups of an .svg: NAME, more by another --only")
        ->allow_extra_args(false)
        ->type_name("NAME");
}

void add_copy_options(CLI::App& command, Paint& paint) {
    command
        .add_option(
            "--along", paint.copies.along,
            "repeats the drawing along a path on the model, such as an ornament round a bowl: rim, level "
            "round the model at the height of --place; edge, along the border, edge, shut line, border of groups "
            "or rounded crease nearest to --place, at most 50 mm and a tenth of the model away, on the side of "
            "--place; or a stroke file whose first line is the path")
        ->excludes("--on")
        ->type_name("rim|edge|FILE");
    command
        .add_option("--repeat", paint.copies.repeat,
                    "with --along: fit (default), as many copies as the path has room for, made to meet; or a "
                    "number of copies, evenly spaced, which meet unless --place-width gives their width")
        ->needs("--along")
        ->type_name("fit|N");
    command
        .add_option("--mirror", paint.copies.mirror,
                    "paints the other flank as well: copies beyond the planes through the middle of the model across "
                    "these axes, such as y; a group of its own in the journal")
        ->check(CLI::IsMember({"x", "y", "z", "xy", "xz", "yz", "xyz"}))
        ->type_name("AXES");
    command.add_flag(
        "--readable", paint.copies.readable,
        "with --mirror: groups of an .svg with the class 'readable' (or data-readable) are not mirrored, such "
        "as lettering; they stay where the mirror puts them");
    command.add_option("--radial", paint.copies.radial, "copies round the middle of the model, with the original")
        ->check(number_in(1, 32))
        ->type_name("N");
    command.add_option("--radial-axis", paint.copies.radial_axis, "axis of --radial")
        ->check(CLI::IsMember({"x", "y", "z"}));
}

}  // namespace

void add_drawing_options(CLI::App& command, Paint& paint) {
    add_area_options(command, paint);
    add_copy_options(command, paint);
    command.add_flag("--auto-texel", paint.drawing.auto_texel,
                     "texels as small as the finest detail of a drawing's areas needs: a third of it");
}

}  // namespace tuft::cli
