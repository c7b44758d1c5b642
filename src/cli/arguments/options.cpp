#include "cli/arguments/options.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "core/files/shipped_file.h"
#include "core/text/text.h"

namespace tuft::cli {

std::optional<double> number_of(const std::string& text) {
    double value = 0;
    const char* begin = text.data() + (text.starts_with('+') ? 1 : 0);
    const char* end = text.data() + text.size();
    const auto [last, error] = std::from_chars(begin, end, value);
    if (error != std::errc{} || last != end || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// "A,B[,C]" into numbers within ±`most`; empty when it is anything else.
std::vector<double> numbers(const std::string& text, char separator, std::size_t count, double most) {
    std::vector<double> values;
    std::stringstream stream(text);
    std::string part;
    while (std::getline(stream, part, separator)) {
        const std::optional<double> value = number_of(part);
        if (!value || std::abs(*value) > most) return {};
        values.push_back(*value);
    }
    if (values.size() != count || text.ends_with(separator)) values.clear();
    return values;
}

CLI::Validator number_in(double lo, double hi, const std::string& name) {
    return CLI::Validator(
        [lo, hi](std::string& text) -> std::string {
            const std::optional<double> value = number_of(text);
            if (value && *value >= lo && *value <= hi) return {};
            return fmt::format("'{}' is not a number from {:g} to {:g}", excerpt(text), lo, hi);
        },
        name.empty() ? fmt::format("{:g} to {:g}", lo, hi) : name);
}

CLI::Option* allow_shipped(CLI::Option* option) {
    return option->transform([](const std::string& path) { return or_shipped(path).string(); }, "");
}

void add_common(CLI::App* app, Common& c) {
    app->add_option("--threads", c.threads, "threads to use (0: one per core)")->check(number_in(0, 1024));
    app->add_flag("--json", c.json, "print one JSON object on standard output");
    app->add_flag("--quiet", c.quiet, "no progress, no notes");
}

void add_store(CLI::App* app, Surface& s) {
    app->add_option("--texel-store", s.texel_store,
                    "how texels are kept in memory: float, packed (16 bits, half the memory), "
                    "auto (packed from 4096 on)")
        ->check(CLI::IsMember({"auto", "float", "packed"}));
}

void add_reading(CLI::App* app, FileReading& reading, const std::string& what) {
    app->add_option("--unit", reading.unit,
                    what +
                        "; of a file that states another one, such as a GLB that was written in millimetres, this "
                        "one counts")
        ->check(CLI::IsMember({"um", "mm", "cm", "m", "in", "ft"}));
    app->add_option("--up", reading.up,
                    "axis of the model file that points up: z, or y, as many modellers write it; points "
                    "on the command line are with z up: (x, y, z) of a file with y up is (x, -z, y)")
        ->check(CLI::IsMember({"z", "y"}));
    app->add_option("--sides", reading.sides,
                    "front of the open parts of the model file, onto which ink goes: outward (default; a part that is "
                    "inside out is turned round), file (as the file has it), turned (the other side)")
        ->check(CLI::IsMember({"outward", "file", "turned"}));
    app->add_option("--chord", reading.chord_mm,
                    "STEP and IGES: distance between the surfaces and their triangles, in millimetres (default: a "
                    "5000th of the size)")
        ->check(number_in(1e-6, kFarthestMm, "POSITIVE"));
    app->add_option("--groups", reading.groups,
                    "STEP and IGES: what becomes a group of faces: bodies (default; of one colour each), or each face "
                    "of the CAD model, whose edges --seams groups then cuts along")
        ->check(CLI::IsMember({"bodies", "faces"}));
}

void add_surface(CLI::App* app, Surface& s) {
    add_reading(app, s, "unit of the numbers in the model file (default: as it states, else a guess from its size)");
    app->add_option("--atlas-size", s.atlas_size, "texels along the side of the atlas")
        ->check(number_in(1, kMostTexels, "POSITIVE"));
    app->add_option("--texel-size", s.texel_size_mm, "size of a texel in millimetres")
        ->check(number_in(kLeastTexelMm, kFarthestMm, "POSITIVE"));
    app->add_option("--pages", s.pages,
                    "most pages of the atlas (UDIM), each --atlas-size texels wide: as many as "
                    "--texel-size needs, or all of them")
        ->check(number_in(1, 100));
    app->parse_complete_callback([&s] {
        if (s.atlas_size > 0 && s.texel_size_mm > 0 && s.pages <= 1)
            throw CLI::ExcludesError("--atlas-size", "--texel-size (without --pages)");
    });
    auto* renew = app->add_flag("--new-uv", s.new_uv, "make a new atlas even if the file has UVs");
    auto* keep = app->add_flag("--keep-uv", s.keep_uv, "use the file's UVs or fail");
    renew->excludes(keep);
    auto* tight = app->add_flag("--tight", s.tight,
                                "halve large charts as long as the atlas is covered better then "
                                "(else: only where less than 65 % would be)");
    app->add_flag("--whole", s.whole, "never halve charts for the sake of the atlas")->excludes(tight);
    app->add_option("--seams", s.seams, "where the atlas must be cut: free, groups (of faces), sharp (edges), both")
        ->check(CLI::IsMember({"free", "groups", "sharp", "both"}))
        ->excludes(keep);
    app->add_option("--sharp-angle", s.sharp_angle_deg, "degrees from which an edge is sharp")
        ->check(number_in(1.0, 180.0));
    app->add_flag(
        "--plain", s.plain,
        "leave aside the colours that the model brings along (pictures, vertices, facets); else ink lies on them");
    add_store(app, s);
}

void add_cache(CLI::App* app, Surface& s) {
    app->add_flag("--no-cache", s.no_cache,
                  "neither read nor write prepared models, fitted strokes and measured brushes (in tuft/ of "
                  "$XDG_CACHE_HOME or ~/.cache)");
}

CLI::Option* add_point(CLI::App* app, const std::string& name, std::vector<double>& to, const std::string& what) {
    return app
        ->add_option_function<std::string>(
            name,
            [&to, name](const std::string& text) {
                to = numbers(text, ',', 3, kFarthestMm);
                if (to.empty())
                    throw CLI::ValidationError(
                        name, "'" + excerpt(text) + "' is not X,Y,Z in millimetres, each within 10 km");
            },
            what)
        ->type_name("X,Y,Z");
}

void add_layers(CLI::App* app, std::vector<std::string>& layers) {
    app->add_option("--layers", layers, "show these layers only, hidden ones too: NAME,...")->delimiter(',');
}

void add_recolouring(CLI::App* app, Recolouring& recolouring) {
    app->add_option("--substrate", recolouring.substrate,
                    "show the ink on this substrate (name or .toml), without painting it anew");
    app->add_option("--recolour", recolouring.recolours,
                    "show what was painted with INK as another ink or recipe: INK=NAME, INK=FILE.toml or INK=#rrggbb")
        ->type_name("INK=NAME");
}

void add_view_direction(CLI::App* app, View& v) {
    app->add_option_function<std::string>(
           "--view",
           [&v](const std::string& text) {
               const auto n = numbers(text, ',', 2, kMostDegrees);
               if (n.empty())
                   throw CLI::ValidationError("--view", "'" + excerpt(text) + "' is not AZIMUTH,ELEVATION in degrees");
               v.azimuth = n[0];
               v.elevation = n[1];
               v.directed = true;
           },
           "where to look from, in degrees: AZIMUTH,ELEVATION")
        ->type_name("AZ,EL");
}

void add_view(CLI::App* app, View& v) {
    add_camera(app, v);
    add_layers(app, v.layers);
}

void add_camera(CLI::App* app, View& v) {
    app->add_option_function<std::string>(
           "--size",
           [&v](const std::string& text) {
               constexpr int kLeast = 16, kMost = 16384;
               const auto n = numbers(text, 'x', 2, kMost);
               if (n.empty() || n[0] < kLeast || n[1] < kLeast || n[0] != std::floor(n[0]) || n[1] != std::floor(n[1]))
                   throw CLI::ValidationError(
                       "--size",
                       fmt::format("'{}' is not WIDTHxHEIGHT, such as 1280x720, with sides of {} to {} pixels",
                                   excerpt(text), kLeast, kMost));
               v.width = static_cast<int>(n[0]);
               v.height = static_cast<int>(n[1]);
           },
           "size of the picture, WIDTHxHEIGHT")
        ->type_name("WxH");
    add_view_direction(app, v);
    app->add_option("--light", v.light, "turn the lights by so many degrees (they follow the camera)")
        ->check(number_in(-kMostDegrees, kMostDegrees, "DEGREES"));
    app->add_flag("--raking", v.raking,
                  "one lamp from the side, which shows the relief of the ink; --light turns it about the view");
    app->add_option("--zoom", v.zoom, "magnification (1: the whole model)")->check(number_in(0.05, 100.0));
    app->add_option_function<std::string>(
           "--target",
           [&v](const std::string& text) {
               v.target_mm = numbers(text, ',', 3, kFarthestMm);
               if (v.target_mm.empty())
                   throw CLI::ValidationError("--target",
                                              "'" + excerpt(text) + "' is not X,Y,Z in millimetres, each within 10 km");
           },
           "the point to look at, in millimetres: X,Y,Z")
        ->type_name("X,Y,Z");
}

}  // namespace tuft::cli
