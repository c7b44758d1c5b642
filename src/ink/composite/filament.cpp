#include "ink/composite/filament.h"

#include <algorithm>
#include <limits>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text/units.h"
#include "ink/colour/presets.h"
#include "ink/composite/match.h"
#include "ink/spectra/colorimetry.h"
#include "ink/spectra/kubelka_munk.h"

namespace tuft::ink {
namespace {

constexpr double kContrast = 0.98;
constexpr std::size_t kMostBytes = std::size_t{1} << 20;

double luminance(const Rgb& c) {
    return 0.2126 * double{c[0]} + 0.7152 * double{c[1]} + 0.0722 * double{c[2]};
}

/// K/S of a thick film; a band of no reflectance absorbs all that enters it.
Bands absorption_over_scattering(const Bands& thick) {
    Bands ratio;
    for (int b = 0; b < kBands; ++b) {
        const float r = std::clamp(thick[b], 1e-4f, 1.0f);
        ratio[b] = (1 - r) * (1 - r) / (2 * r);
    }
    return ratio;
}

/// Colour of a wall of optical thickness s = S · thickness over `under`.
Rgb colour_over(const Bands& ratio, double s, const Bands& under) {
    Bands seen;
    for (int b = 0; b < kBands; ++b)
        seen[b] = static_cast<float>(over(layer(double{ratio[b]} * s, s, 1), double{under[b]}));
    return into_gamut(rgb_of_bands(seen));
}

/// S · thickness at which the wall hides black.
double hiding_scattering(const Bands& ratio, double thick_luminance) {
    double low = 0, high = 1;
    const auto hides = [&](double s) {
        return luminance(colour_over(ratio, s, Bands{})) >= kContrast * thick_luminance;
    };
    while (!hides(high) && high < 1e9) high *= 2;
    for (int i = 0; i < 60; ++i) {
        const double middle = 0.5 * (low + high);
        (hides(middle) ? high : low) = middle;
    }
    return high;
}

}  // namespace

Rgb colour_of_wall(const Filament& filament, const Filament& core, double wall) {
    if (!(filament.hiding > 0)) return filament.colour;
    const Bands ratio = absorption_over_scattering(bands_of_rgb(filament.colour));
    const double s = hiding_scattering(ratio, luminance(filament.colour)) * wall / filament.hiding;
    return colour_over(ratio, s, bands_of_rgb(core.colour));
}

FilamentChoice choose_filament(std::span<const ColourPatch> patches, std::span<const Rgb> printed) {
    const auto lab = [](const Rgb& c) { return lab_of_rgb({double{c[0]}, double{c[1]}, double{c[2]}}); };
    double area = 0;
    for (const ColourPatch& patch : patches) area += patch.area;
    if (!(area > 0)) return {};
    FilamentChoice best{0, std::numeric_limits<double>::infinity()};
    for (std::size_t f = 0; f < printed.size(); ++f) {
        const Lab own = lab(printed[f]);
        double sum = 0;
        for (const ColourPatch& patch : patches) sum += patch.area * delta_e_2000(lab(patch.colour), own);
        if (sum / area < best.delta_e) best = {f, sum / area};
    }
    return best;
}

std::vector<Filament> load_filaments(const std::filesystem::path& path) {
    const std::vector<char> bytes = read_file(path, kMostBytes);
    const std::string source = path.string();
    const toml::table root = parse_toml({bytes.data(), bytes.size()}, source);
    const toml::array* list = root["filament"].as_array();
    if (root.size() != 1 || !list || list->empty() || !list->is_homogeneous(toml::node_type::table))
        throw Error(source, "must have [[filament]] tables and nothing else");
    if (list->size() > kMostFilaments) throw Error(source, Message("has more than {} filaments", kMostFilaments));
    std::vector<Filament> filaments;
    for (const toml::node& node : *list) {
        const preset::Reader reader(*node.as_table(), source);
        reader.only({"name", "colour", "hiding_mm"});
        const std::string hex = reader.text("colour", std::nullopt);
        const std::optional<Rgb> colour = colour_of_hex(hex);
        const long line = reader.line_of("colour");
        if (!colour) reader.fail(line, Message("'{}' is not a colour such as #c03020", hex));
        filaments.push_back({.name = reader.text("name", hex),
                             .colour = *colour,
                             .hiding = kMillimetre * reader.number("hiding_mm", 0, 100, 0)});
    }
    return filaments;
}

}  // namespace tuft::ink
