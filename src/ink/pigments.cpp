#include "ink/pigments.h"

#include <toml++/toml.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>
#include <optional>
#include <sstream>

#include "core/error.h"
#include "core/files.h"

namespace fs = std::filesystem;

namespace tuft::ink {
namespace {

constexpr std::size_t kMaxPresetBytes = 1 << 20;

/// A table of a preset file, with errors that name file and line.
class Reader {
  public:
    Reader(const toml::table& table, const std::string& source) : table_(table), source_(source) {}

    void only(std::initializer_list<std::string_view> keys) const {
        for (const auto& [key, value] : table_) {
            if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
            const std::vector<std::string> known(keys.begin(), keys.end());
            const std::string near = nearest_name(key.str(), known);
            fail(key.source().begin.line,
                 "unknown key '" + std::string(key.str()) + "'" +
                     (near.empty() ? "" : ", did you mean '" + near + "'?"));
        }
    }

    double number(std::string_view key, double lo, double hi,
                  std::optional<double> fallback) const {
        const toml::node* node = table_.get(key);
        if (!node) {
            if (!fallback) fail(line(), "'" + std::string(key) + "' is missing");
            return *fallback;
        }
        return in_range(*node, key, lo, hi);
    }

    Rgb rgb(std::string_view key, double lo, double hi) const {
        const toml::node* node = table_.get(key);
        if (!node) fail(line(), "'" + std::string(key) + "' is missing");
        const toml::array* array = node->as_array();
        if (!array || array->size() != 3)
            fail(node->source().begin.line,
                 "'" + std::string(key) + "' must be 3 numbers (red, green, blue)");
        Rgb result;
        for (std::size_t b = 0; b < 3; ++b)
            result[b] = static_cast<float>(in_range(*array->get(b), key, lo, hi));
        return result;
    }

    std::string text(std::string_view key, std::optional<std::string> fallback) const {
        const toml::node* node = table_.get(key);
        if (!node) {
            if (!fallback) fail(line(), "'" + std::string(key) + "' is missing");
            return *fallback;
        }
        const auto value = node->value<std::string>();
        if (!value || !node->is_string())
            fail(node->source().begin.line, "'" + std::string(key) + "' must be text");
        return *value;
    }

    [[noreturn]] void fail(long line, const std::string& what) const {
        throw Error(source_, line, what);
    }
    long line() const { return table_.source().begin.line; }

  private:
    double in_range(const toml::node& node, std::string_view key, double lo, double hi) const {
        const auto value = node.value<double>();
        if (!value || !node.is_number())
            fail(node.source().begin.line, "'" + std::string(key) + "' must be a number");
        if (!(*value >= lo && *value <= hi)) {
            std::ostringstream range;
            range << "'" << key << "' must lie in [" << lo << ", " << hi << "], not be " << *value;
            fail(node.source().begin.line, range.str());
        }
        return *value;
    }

    const toml::table& table_;
    const std::string& source_;
};

toml::table parse_table(std::string_view text, const std::string& source) {
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& e) {
        throw Error(source, e.source().begin.line, std::string(e.description()));
    }
}

std::vector<std::string> list_presets(const char* kind) {
    std::vector<std::string> names;
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(data_folder() / "models" / kind, ec))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

struct PresetText {
    std::string text, source, name;
};

PresetText preset_text(std::string_view name, const char* folder, const char* kind) {
    fs::path path(name);
    if (path.extension() != ".toml") {
        const std::vector<std::string> known = list_presets(folder);
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            const std::string near = nearest_name(name, known);
            std::string all;
            for (const std::string& k : known) all += (all.empty() ? "" : ", ") + k;
            throw Error("unknown " + std::string(kind) + " '" + std::string(name) + "'" +
                        (near.empty() ? "; there are: " + all : ", did you mean '" + near + "'?"));
        }
        path = data_folder() / "models" / folder / (std::string(name) + ".toml");
    }
    const std::vector<char> bytes = read_file(path, kMaxPresetBytes);
    return {{bytes.begin(), bytes.end()}, path.string(), path.stem().string()};
}

Pigment read_pigment(const Reader& in) {
    Pigment p;
    p.name = in.text("name", std::nullopt);
    if (p.name.empty()) in.fail(in.line(), "a pigment's 'name' must not be empty");
    p.k = in.rgb("K", 0, 1e3);
    p.s = in.rgb("S", 0, 1e3);
    p.height = static_cast<float>(in.number("height_um", 0, 10, 2.5) * 1e-6);
    p.roughness = static_cast<float>(in.number("roughness", 0, 1, 0.5));
    p.source = in.text("source", "");
    return p;
}

/// TOML basic string.
std::string quoted(const std::string& text) {
    std::ostringstream out;
    out << toml::value<std::string>(text);
    return out.str();
}

std::string shortest(double v) {
    std::ostringstream out;
    out << toml::value<double>(v);
    return out.str();
}

/// Shortest decimals that read back as the same float.
std::string shortest_float(float v) {
    char buffer[32];
    for (int digits = 6; digits <= 9; ++digits) {
        std::snprintf(buffer, sizeof buffer, "%.*g", digits, static_cast<double>(v));
        if (static_cast<float>(std::strtod(buffer, nullptr)) == v) break;
    }
    return buffer;
}

std::string rgb_text(const Rgb& bands) {
    std::string out = "[";
    for (int b = 0; b < 3; ++b) out += (b ? ", " : "") + shortest_float(bands[b]);
    return out + "]";
}

}  // namespace

double Ink::strength() const {
    double sum = 0;
    for (const InkPart& part : parts) sum += part.fraction;
    return sum;
}

Ink parse_ink(std::string_view text, const std::string& source) {
    const toml::table table = parse_table(text, source);
    const Reader in(table, source);
    in.only(
        {"name", "title", "film", "supply", "supply_length_mm", "transfer_length_mm", "pigment"});
    Ink ink;
    ink.name = in.text("name", "");
    ink.title = in.text("title", ink.name);
    ink.film = in.number("film", 0.01, 8, ink.film);
    ink.supply = in.number("supply", 1e-6, 1, ink.supply);
    ink.supply_length = in.number("supply_length_mm", 0.001, 100, ink.supply_length * 1e3) * 1e-3;
    ink.transfer_length =
        in.number("transfer_length_mm", 0.001, 100, ink.transfer_length * 1e3) * 1e-3;
    const toml::array* parts = table["pigment"].as_array();
    if (!parts || parts->empty()) in.fail(in.line(), "an ink needs at least one [[pigment]]");
    if (parts->size() > 8) in.fail(in.line(), "an ink has at most 8 pigments");
    for (const toml::node& node : *parts) {
        const toml::table* part = node.as_table();
        if (!part) in.fail(node.source().begin.line, "'pigment' must be written as [[pigment]]");
        const Reader part_in(*part, source);
        part_in.only({"name", "fraction", "K", "S", "height_um", "roughness", "source"});
        InkPart p{read_pigment(part_in), part_in.number("fraction", 1e-4, 1, 1.0)};
        for (const InkPart& other : ink.parts)
            if (other.pigment.name == p.pigment.name)
                part_in.fail(part_in.line(), "pigment '" + p.pigment.name + "' is listed twice");
        ink.parts.push_back(std::move(p));
    }
    if (ink.strength() > 1 + 1e-9)
        in.fail(in.line(),
                "the fractions sum to " + shortest(ink.strength()) + "; at most 1 is possible");
    return ink;
}

std::string ink_toml(const Ink& ink) {
    std::ostringstream out;
    out << "name = " << quoted(ink.name) << "\ntitle = " << quoted(ink.title)
        << "\nfilm = " << shortest(ink.film) << "\nsupply = " << shortest(ink.supply)
        << "\nsupply_length_mm = " << shortest(ink.supply_length * 1e3)
        << "\ntransfer_length_mm = " << shortest(ink.transfer_length * 1e3) << "\n";
    for (const InkPart& part : ink.parts) {
        const Pigment& p = part.pigment;
        out << "\n[[pigment]]\nname = " << quoted(p.name)
            << "\nfraction = " << shortest(part.fraction) << "\nK = " << rgb_text(p.k)
            << "\nS = " << rgb_text(p.s) << "\nheight_um = " << shortest(p.height * 1e6)
            << "\nroughness = " << shortest_float(p.roughness) << "\nsource = " << quoted(p.source)
            << "\n";
    }
    return out.str();
}

Substrate parse_substrate(std::string_view text, const std::string& source) {
    const toml::table table = parse_table(text, source);
    const Reader in(table, source);
    in.only({"name", "title", "reflectance", "roughness", "metallic", "capacity", "interface",
             "relief_um", "relief_length_um", "absorbency", "pores", "diffusion", "threshold", "edge",
             "evaporation", "source"});
    Substrate s;
    const auto read = [&](float& field, std::string_view key, double lo, double hi,
                          double unit = 1) {
        const double value = in.number(key, lo, hi, static_cast<double>(field) / unit);
        field = static_cast<float>(value * unit);
    };
    s.name = in.text("name", "");
    s.title = in.text("title", s.name);
    s.reflectance = in.rgb("reflectance", 0, 1);
    s.roughness = static_cast<float>(in.number("roughness", 0, 1, 0.5));
    s.metallic = static_cast<float>(in.number("metallic", 0, 1, 0.0));
    s.capacity = static_cast<float>(in.number("capacity", 0.1, 1000, 8.0));
    read(s.interface, "interface", 0, 1);
    read(s.relief, "relief_um", 0, 1000, 1e-6);
    read(s.relief_length, "relief_length_um", 1, 10000, 1e-6);
    read(s.absorbency, "absorbency", 0, 100);
    read(s.pores, "pores", 0, 1000);
    read(s.diffusion, "diffusion", 0, 1e-4);
    read(s.threshold, "threshold", 0, 10);
    read(s.edge, "edge", 0, 1);
    read(s.evaporation, "evaporation", 0, 10);
    return s;
}

std::string substrate_toml(const Substrate& s) {
    return "name = " + quoted(s.name) + "\ntitle = " + quoted(s.title) +
           "\nreflectance = " + rgb_text(s.reflectance) +
           "\nroughness = " + shortest_float(s.roughness) +
           "\nmetallic = " + shortest_float(s.metallic) +
           "\ncapacity = " + shortest_float(s.capacity) +
           "\ninterface = " + shortest_float(s.interface) +
           "\nrelief_um = " + shortest_float(s.relief * 1e6f) +
           "\nrelief_length_um = " + shortest_float(s.relief_length * 1e6f) +
           "\nabsorbency = " + shortest_float(s.absorbency) +
           "\npores = " + shortest_float(s.pores) +
           "\ndiffusion = " + shortest_float(s.diffusion) +
           "\nthreshold = " + shortest_float(s.threshold) +
           "\nedge = " + shortest_float(s.edge) +
           "\nevaporation = " + shortest_float(s.evaporation) + "\n";
}

Ink load_ink(std::string_view name) {
    const PresetText preset = preset_text(name, "inks", "ink");
    Ink ink = parse_ink(preset.text, preset.source);
    if (ink.name.empty()) ink.name = preset.name;
    return ink;
}

Substrate load_substrate(std::string_view name) {
    const PresetText preset = preset_text(name, "substrates", "substrate");
    Substrate substrate = parse_substrate(preset.text, preset.source);
    if (substrate.name.empty()) substrate.name = preset.name;
    return substrate;
}

std::vector<std::string> list_inks() {
    return list_presets("inks");
}
std::vector<std::string> list_substrates() {
    return list_presets("substrates");
}

}  // namespace tuft::ink
