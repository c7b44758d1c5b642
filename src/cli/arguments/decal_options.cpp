#include <fmt/format.h>

#include "cli/arguments/options.h"
#include "core/text/text.h"

namespace tuft::cli {
namespace {

constexpr double kLongestMm = 100000;

/// "3", "3mm", "0.3cm", "1in" into millimetres.
std::optional<double> millimetres_of(const std::string& text) {
    std::size_t unit = text.size();
    while (unit > 0 && std::isalpha(static_cast<unsigned char>(text[unit - 1]))) --unit;
    const std::optional<double> value = number_of(text.substr(0, unit));
    const std::optional<double> metres =
        unit == text.size() ? std::optional(kMillimetre) : metres_per(text.substr(unit));
    if (!value || !metres) return std::nullopt;
    return *value * *metres / kMillimetre;
}

CLI::Option* add_length(CLI::App* app, const std::string& name, double& mm, double lo, const std::string& what) {
    return app
        ->add_option_function<std::string>(
            name,
            [&mm, name, lo](const std::string& text) {
                const std::optional<double> value = millimetres_of(text);
                if (!value || *value < lo || *value > kLongestMm)
                    throw CLI::ValidationError(
                        name, fmt::format("'{}' is not a length from {:g} mm to 100 m", excerpt(text), lo));
                mm = *value;
            },
            what)
        ->type_name("LENGTH");
}

void read_page(Decals& d, const std::string& text) {
    struct Named {
        const char* name;
        double width, height;  // mm; 0: endless
    };
    for (const Named& page : {Named{"A4", 210, 297}, Named{"A3", 297, 420}, Named{"roll", 1370, 0}})
        if (text == page.name) {
            d.print.page_mm = {page.width, page.height};
            return;
        }
    if (text.starts_with("roll:"))
        if (const std::optional<double> width = millimetres_of(text.substr(5)); width && *width >= kLeastPageMm) {
            d.print.page_mm = {*width, 0};
            if (*width <= kLongestMm) return;
        }
    const auto cross = text.find('x');
    if (cross != std::string::npos) {
        const std::optional<double> width = millimetres_of(text.substr(0, cross));
        const std::optional<double> height = millimetres_of(text.substr(cross + 1));
        if (width && height && *width >= kLeastPageMm && *height >= kLeastPageMm && *width <= kLongestMm &&
            *height <= kLongestMm) {
            d.print.page_mm = {*width, *height};
            return;
        }
    }
    throw CLI::ValidationError(
        "--page",
        fmt::format("'{}' is not A4, A3, WxH (such as 320x450mm), roll or roll:WIDTH, each side at least {} mm",
                    excerpt(text), kLeastPageMm));
}

}  // namespace

CLI::App* add_decals(CLI::App& app, Decals& d) {
    auto* s =
        app.add_subcommand("decals", "flatten the painted areas at true size, as sheets of film to print and cut");
    s->add_option("PROJECT", d.project, "project file (.tuft)")->required();
    s->add_option("-o,--output", d.output, ".pdf (spot colours, all pages), .svg or .dxf (cut lines, outlines)")
        ->required();
    s->add_option("--mask", d.mask, "the areas of this mask, painted or not, instead of all painted areas");
    add_layers(s, d.layers);
    add_recolouring(s, d.recolouring);
    s->add_option_function<std::string>(
         "--max-strain",
         [&d](std::string text) {
             if (text.ends_with('%')) text.pop_back();
             const std::optional<double> value = number_of(text);
             if (!value || *value < 0.1 || *value > 50)
                 throw CLI::ValidationError("--max-strain", "'" + excerpt(text) + "' is not a strain from 0.1% to 50%");
             d.max_strain = *value / 100;
         },
         "strain up to which the film follows the surface: 3% water-slide decal (default), 15% wrap film")
        ->type_name("PERCENT");
    add_length(s, "--bleed", d.bleed_mm, 0,
               "film beyond the paint; up to 3 mm of it also print beyond cuts through paint (default: 3mm; wraps: "
               "75mm)");
    add_length(s, "--overlap", d.overlap_mm, 0, "overlap of two panels (default: 1mm; wraps: 25mm)");
    add_length(s, "--join", d.join_mm, 0,
               "islands of paint nearer than this to each other share a piece (default: 10mm)");
    s->add_option(
         "--least-fragment", d.least_fragment_mm2,
         "leave out what a cut parts from a piece with 100 times its paint, where it has less paint than this, "
         "and specks of less than a tenth of it where all together have less than a thousandth of the paint, in mm2 "
         "(default: 10; 0: lay them)")
        ->check(number_in(0, 1e6));
    s->add_option("--least-piece", d.least_piece_mm2,
                  "leave out slivers that have less paint than this, on more than ten times as much film, where all "
                  "together have less than a thousandth of the paint, in mm2 (default: 0: lay them)")
        ->check(number_in(0, 1e6));
    s->add_option_function<std::string>(
         "--page", [&d](const std::string& text) { read_page(d, text); },
         "A4 (default), A3, WxH, roll (1370 mm wide) or roll:WIDTH")
        ->type_name("PAGE");
    s->add_option("--grain", d.print.grain,
                  "free: pieces are turned to fill the page, where that saves film (default); up: all point up the "
                  "page, along the grain of "
                  "the film")
        ->check(CLI::IsMember({"free", "up"}));
    s->add_option("--dpi", d.print.dpi, "dots per inch of the print")->check(number_in(10, 4800));
    s->add_flag("--plates", d.print.plates, "print one plate for each pigment, a separation of its name (.pdf)");
    s->add_flag(
        "--outlines", d.print.outlines,
        "print what is painted in one ink, or with --plates each plate, as filled outlines instead of a picture; "
        "in .svg on a layer 'Ink NAME' each, in .dxf 'Ink_NAME'");
    s->add_option("--colour-space", d.print.colour_space,
                  "of the pictures, whose profile is stored: srgb (default), display-p3")
        ->check(CLI::IsMember({"srgb", "display-p3"}));
    s->add_flag("--strain-map", d.print.strain_map, "append pages that show the strain of the film");
    s->add_option("--guide", d.guide,
                  "folder for a placing guide: a picture of the model for each piece, and lines.obj, the cut lines on "
                  "the model")
        ->type_name("FOLDER");
    return s;
}

}  // namespace tuft::cli
