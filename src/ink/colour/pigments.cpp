#include "ink/colour/pigments.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "ink/colour/presets.h"
#include "ink/spectra/upsample.h"

namespace tuft::ink {

using preset::list_text;
using preset::quoted;
using preset::shortest;
using preset::shortest_float;
using preset::shortest_in;

namespace {

constexpr std::size_t kMaxSamples = 1000;
constexpr double kThickest = 8, kThickestPaste = 100;  // film units that a full brush leaves

float sample(const std::vector<float>& nm, const std::vector<float>& values, float at) {
    const auto next = std::upper_bound(nm.begin(), nm.end(), at);
    if (next == nm.begin()) return values.front();
    if (next == nm.end()) return values.back();
    const auto i = static_cast<std::size_t>(next - nm.begin());
    const float part = (at - nm[i - 1]) / (nm[i] - nm[i - 1]);
    return values[i - 1] + part * (values[i] - values[i - 1]);
}

PigmentCurve read_curve(const preset::Reader& in) {
    PigmentCurve curve;
    curve.scale = static_cast<float>(in.number("scale", 1e-6, 1e6, 1.0));
    if (!in.has("wavelengths")) {
        const Rgb k = in.rgb("K", 0, 1e3), s = in.rgb("S", 0, 1e3);
        curve.k.assign(k.begin(), k.end());
        curve.s.assign(s.begin(), s.end());
        return curve;
    }
    curve.nm = in.numbers("wavelengths", 2, kMaxSamples, 200, 3000);
    for (std::size_t i = 1; i < curve.nm.size(); ++i)
        if (!(curve.nm[i] > curve.nm[i - 1])) in.fail(in.line_of("wavelengths"), "'wavelengths' must ascend");
    curve.k = in.numbers("K", curve.nm.size(), curve.nm.size(), 0, 1e6);
    curve.s = in.numbers("S", curve.nm.size(), curve.nm.size(), 0, 1e6);
    return curve;
}

const std::initializer_list<std::string_view> kPigmentKeys{
    "name",  "fraction", "preset",      "title",    "colour_index", "wavelengths", "K",     "S",
    "scale", "density",  "granulation", "staining", "height_um",    "roughness",   "source"};

Pigment read_pigment(const preset::Reader& in) {
    Pigment p;
    p.name = in.text("name", std::nullopt);
    if (p.name.empty()) in.fail(in.line(), "a pigment's 'name' must not be empty");
    p.density = static_cast<float>(in.number("density", 100, 25000, p.density));
    p.granulation = static_cast<float>(in.number("granulation", 0, 1, p.granulation));
    p.staining = static_cast<float>(in.number("staining", 0, 1, p.staining));
    p.height = static_cast<float>(in.number("height_um", 0, 10, 2.5) * 1e-6);
    p.roughness = static_cast<float>(in.number("roughness", 0, 1, 0.5));
    p.source = in.text("source", "");
    p.curve = read_curve(in);
    use_curve(p);
    return p;
}

/// A pigment written out in the ink, or a preset taken by name.
Pigment read_part(const preset::Reader& in) {
    if (!in.has("preset")) return read_pigment(in);
    const std::string name = in.text("preset", std::nullopt);
    for (const char* key : {"name", "K", "S", "wavelengths"})
        if (in.has(key)) in.fail(in.line_of(key), Message("'{}' comes from the preset '{}'", std::string(key), name));
    return load_pigment(name);
}

std::string pigment_text(const Pigment& p) {
    std::ostringstream out;
    if (!p.curve.nm.empty()) out << "wavelengths = " << list_text(p.curve.nm) << "\n";
    if (p.curve.k.empty()) {  // made from bands, not from a file
        out << "wavelengths = " << list_text(band_nm()) << "\nK = " << list_text(p.k) << "\nS = " << list_text(p.s)
            << "\n";
    } else {
        out << "K = " << list_text(p.curve.k) << "\nS = " << list_text(p.curve.s) << "\n";
        if (p.curve.scale != 1) out << "scale = " << shortest_float(p.curve.scale) << "\n";
    }
    out << "density = " << shortest_float(p.density) << "\ngranulation = " << shortest_float(p.granulation)
        << "\nstaining = " << shortest_float(p.staining) << "\nheight_um = " << shortest_in(p.height, 1e-6)
        << "\nroughness = " << shortest_float(p.roughness) << "\nsource = " << quoted(p.source) << "\n";
    return out.str();
}

}  // namespace

Coefficients coefficients_at(const PigmentCurve& curve, float nm) {
    return {static_cast<double>(curve.scale * sample(curve.nm, curve.k, nm)),
            static_cast<double>(curve.scale * sample(curve.nm, curve.s, nm))};
}

void use_curve(Pigment& pigment) {
    PigmentCurve curve = pigment.curve;
    if (curve.nm.empty()) {
        const Curves smooth =
            upsample_pigment({curve.k[0], curve.k[1], curve.k[2]}, {curve.s[0], curve.s[1], curve.s[2]});
        curve.k.assign(smooth.k.begin(), smooth.k.end());
        curve.s.assign(smooth.s.begin(), smooth.s.end());
        for (int i = 0; i < kWavelengths; ++i) curve.nm.push_back(static_cast<float>(wavelength_nm(i)));
    }
    for (int b = 0; b < kBands; ++b) {
        const Coefficients at = coefficients_at(curve, band_nm()[b]);
        pigment.k[b] = static_cast<float>(at.k);
        pigment.s[b] = static_cast<float>(at.s);
    }
}

double Ink::strength() const {
    double sum = 0;
    for (const InkPart& part : parts) sum += part.fraction;
    return sum;
}

Ink parse_ink(std::string_view text, const std::string& source) {
    const toml::table table = parse_toml(text, source);
    const preset::Reader in(table, source);
    in.only({"name", "title", "film", "supply", "supply_length_mm", "transfer_length_mm", "yield_pa", "pigment"});
    Ink ink;
    ink.name = in.text("name", "");
    ink.title = in.text("title", ink.name);
    ink.yield = in.number("yield_pa", 0, 1e4, ink.yield);
    ink.film = in.number("film", 0.01, ink.yield > 0 ? kThickestPaste : kThickest, ink.film);
    ink.supply = in.number("supply", 1e-6, 1, ink.supply);
    ink.supply_length = in.number("supply_length_mm", 0.001, 100, ink.supply_length * 1e3) * 1e-3;
    ink.transfer_length = in.number("transfer_length_mm", 0.001, 100, ink.transfer_length * 1e3) * 1e-3;
    const toml::array* parts = table["pigment"].as_array();
    if (!parts) in.fail(in.line(), "an ink needs at least one [[pigment]] (clean water: pigment = [])");
    if (parts->size() > 8) in.fail(in.line(), "an ink has at most 8 pigments");
    for (const toml::node& node : *parts) {
        const toml::table* part = node.as_table();
        if (!part) in.fail(node.source().begin.line, "'pigment' must be written as [[pigment]]");
        const preset::Reader part_in(*part, source);
        part_in.only(kPigmentKeys);
        InkPart p{read_part(part_in), part_in.number("fraction", 1e-4, 1, 1.0)};
        for (const InkPart& other : ink.parts)
            if (other.pigment.name == p.pigment.name)
                part_in.fail(part_in.line(), Message("pigment '{}' is listed twice", p.pigment.name));
        ink.parts.push_back(std::move(p));
    }
    if (ink.strength() > 1 + 1e-9)
        in.fail(in.line(), Message("the fractions sum to {}; at most 1 is possible", shortest(ink.strength())));
    return ink;
}

std::string ink_toml(const Ink& ink) {
    std::ostringstream out;
    out << "name = " << quoted(ink.name) << "\ntitle = " << quoted(ink.title) << "\nfilm = " << shortest(ink.film)
        << "\nsupply = " << shortest(ink.supply) << "\nsupply_length_mm = " << shortest_in(ink.supply_length, 1e-3)
        << "\ntransfer_length_mm = " << shortest_in(ink.transfer_length, 1e-3) << "\n";
    if (ink.yield > 0) out << "yield_pa = " << shortest(ink.yield) << "\n";
    if (ink.parts.empty()) out << "pigment = []\n";
    for (const InkPart& part : ink.parts) {
        out << "\n[[pigment]]\nname = " << quoted(part.pigment.name) << "\nfraction = " << shortest(part.fraction)
            << "\n"
            << pigment_text(part.pigment);
    }
    return out.str();
}

Pigment parse_pigment(std::string_view text, const std::string& source) {
    const toml::table table = parse_toml(text, source);
    const preset::Reader in(table, source);
    in.only(kPigmentKeys);
    for (const char* key : {"fraction", "preset"})
        if (in.has(key)) in.fail(in.line_of(key), Message("'{}' belongs into an ink", std::string(key)));
    return read_pigment(in);
}

Ink load_ink(std::string_view name) {
    const preset::Text text = preset::load(name, "inks", "ink");
    Ink ink = parse_ink(text.text, text.source);
    if (ink.name.empty()) ink.name = text.name;
    return ink;
}

Pigment load_pigment(std::string_view name) {
    const preset::Text text = preset::load(name, "pigments", "pigment");
    return parse_pigment(text.text, text.source);
}

std::vector<std::string> list_inks() {
    return preset::list("inks");
}
std::vector<std::string> list_pigments() {
    return preset::list("pigments");
}

}  // namespace tuft::ink
