#include "brush/preset/preset.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <sstream>

#include "core/error.h"
#include "core/files/disk_cache.h"
#include "core/files/files.h"
#include "core/files/shipped_file.h"
#include "core/files/toml_text.h"
#include "core/text/units.h"

namespace tuft::brush {

namespace fs = std::filesystem;

namespace {

/// A number in a preset file: its table and key, the unit it is written in, its range there.
struct Field {
    const char* table;
    const char* key;
    double Preset::*member;
    double unit;
    double lo, hi;
};

constexpr double kMillilitre = 1e-6;

constexpr std::array kFields = {
    Field{"shape", "length_mm", &Preset::length, kMillimetre, 2, 300},
    Field{"shape", "radius_mm", &Preset::radius, kMillimetre, 0.1, 100},
    Field{"shape", "tip_power", &Preset::tip_power, 1, 0.5, 4},
    Field{"shape", "tip_radius_mm", &Preset::tip_radius, kMillimetre, 0, 10},
    Field{"shape", "hardness", &Preset::hardness, 1, 0, 1},
    Field{"ferrule", "width_mm", &Preset::width, kMillimetre, 0, 300},
    Field{"ferrule", "corner", &Preset::corner, 1, 1.5, 32},
    Field{"ferrule", "toe_mm", &Preset::toe, kMillimetre, 0, 200},
    Field{"ferrule", "slant_mm", &Preset::slant, kMillimetre, 0, 250},
    Field{"ferrule", "splay_deg", &Preset::splay, kDegree, 0, 60},
    Field{"ferrule", "hair_diameter_mm", &Preset::hair_diameter, kMillimetre, 0.01, 2},
    Field{"ferrule", "surface_tension_n_m", &Preset::surface_tension, 1, 0, 1},
    Field{"ferrule", "hair_friction", &Preset::hair_friction, 1, 0, 2},
    Field{"hold", "lean_rad", &Preset::lean, 1, 0, 0.8},
    Field{"foam", "modulus_kpa", &Preset::modulus, 1e3, 0, 1000},
    Field{"foam", "solid", &Preset::solid, 1, 0.005, 0.3},
    Field{"foam", "pore_min_mm", &Preset::pore_min, kMillimetre, 0.05, 10},
    Field{"foam", "pore_max_mm", &Preset::pore_max, kMillimetre, 0.05, 10},
    Field{"foam", "dome_mm", &Preset::dome, kMillimetre, 0, 10000},
    Field{"foam", "rim_mm", &Preset::rim, kMillimetre, 0, 100},
    Field{"foam", "unevenness_mm", &Preset::unevenness, kMillimetre, 0, 10},
    Field{"bending", "stiffness_n_m2", &Preset::stiffness, 1, 1e-10, 1},
    Field{"bending", "alpha", &Preset::alpha, 1, -6, 3},
    Field{"bending", "beta", &Preset::beta, 1, -0.995, 1},
    Field{"bending", "tip_stiffness", &Preset::tip_stiffness, 1, 0, 1},
    Field{"bending", "yield", &Preset::yield, 1, 0, 100},
    Field{"bending", "gamma", &Preset::gamma, 1, -6, 3},
    Field{"bending", "plastic_share", &Preset::plastic_share, 1, 0, 1},
    Field{"bending", "recovery_s", &Preset::recovery, 1, 0, 1e6},
    Field{"bending", "damping_ms", &Preset::damping, 1e-3, 0, 1000},
    Field{"contact", "transverse_stiffness_n_m2", &Preset::transverse_stiffness, 1, 10, 1e7},
    Field{"contact", "core_stiffness", &Preset::core_stiffness, 1, 0, 1000},
    Field{"contact", "core_start", &Preset::core_start, 1, 0, 1},
    Field{"contact", "end_compliance_mm", &Preset::end_compliance, kMillimetre, 0, 20},
    Field{"contact", "adhesion_n_m", &Preset::adhesion, 1, 0, 10},
    Field{"contact", "adhesion_range_mm", &Preset::adhesion_range, kMillimetre, 0.01, 20},
    Field{"contact", "friction_wet", &Preset::friction_wet, 1, 0, 2},
    Field{"contact", "friction_dry", &Preset::friction_dry, 1, 0, 2},
    Field{"contact", "grain", &Preset::grain, 1, 0.1, 0.9},
    Field{"contact", "with_hair", &Preset::with_hair, 1, 0, 1},
    Field{"contact", "pore_grip", &Preset::pore_grip, 1, 0, 10},
    Field{"contact", "stick", &Preset::stick, 1, 0.1, 1000},
    Field{"section", "flatten_moment", &Preset::flatten_moment, 1, 0, 10},
    Field{"section", "flatten_force", &Preset::flatten_force, 1, 0, 10},
    Field{"section", "flatten_contact", &Preset::flatten_contact, 1, 0, 10},
    Field{"section", "flatten_max", &Preset::flatten_max, 1, 1, 10},
    Field{"ink", "capacity_ml", &Preset::capacity, kMillilitre, 0, 100},
    Field{"ink", "tip_drop_mm", &Preset::tip_drop, kMillimetre, 0, 10},
    Field{"split", "factor", &Preset::split_factor, 1, 0, 100},
    Field{"split", "at", &Preset::split_at, 1, 0, 100},
    Field{"split", "merge_at", &Preset::merge_at, 1, 0, 100},
    Field{"split", "yaw_rad", &Preset::split_yaw, 1, 0, 0.7},
    Field{"force", "gain", &Preset::force_gain, 1, 0, 1e5},
    Field{"force", "limit_n", &Preset::force_limit, 1, 0, 100},
};

/// Values that are whole numbers.
struct WholeField {
    const char* table;
    const char* key;
    int Preset::*member;
    int lo, hi;
};

constexpr std::array kWholeFields = {
    WholeField{"shape", "segments", &Preset::segments, 4, 64},
    WholeField{"ferrule", "spines", &Preset::spines, 1, 9},
    WholeField{"foam", "seed", &Preset::pore_seed, 0, 1000000},
    WholeField{"split", "into", &Preset::split_into, 2, 5},
    WholeField{"hair", "bundles", &Preset::bundles, 1, 200},
    WholeField{"hair", "bristles", &Preset::bristles, 1, 4000},
};

Message whole_note(const WholeField& f) {
    return Message("{} must be a whole number from {} to {}", std::string(f.key), f.lo, f.hi);
}

long line_of(const toml::node& node) {
    return static_cast<long>(node.source().begin.line);
}

[[noreturn]] void fail(const std::string& source, long line, const Message& what) {
    if (line > 0) throw Error(source, line, what);
    throw Error(source, what);
}

std::string number(double v) {
    char text[32];
    std::snprintf(text, sizeof text, "%.12g", v);
    return text;
}

/// Every known key as "table.key", for hints.
std::vector<std::string> known_keys() {
    std::vector<std::string> keys{"name", "note", "geometry", "bending.spine"};
    for (const WholeField& f : kWholeFields) keys.push_back(std::string(f.table) + "." + f.key);
    for (const Field& f : kFields) keys.push_back(std::string(f.table) + "." + f.key);
    return keys;
}

[[noreturn]] void unknown_key(const std::string& source, const toml::node& node, const std::string& key) {
    const std::string near = nearest_name(key, known_keys());
    fail(source, line_of(node), Message("unknown key '{}'{}", key, did_you_mean(near)));
}

std::string text_of(const toml::node& node, const std::string& source, const std::string& key) {
    const std::optional<std::string> v = node.value<std::string>();
    if (!v || !node.is_string()) fail(source, line_of(node), Message("'{}' must be a text in quotes", key));
    return *v;
}

double number_of(const toml::node& node, const std::string& source, const std::string& key) {
    const std::optional<double> v = node.value<double>();
    if (!v || !node.is_number()) fail(source, line_of(node), Message("'{}' must be a number", key));
    return *v;
}

SpineMethod spine_of(const toml::node& node, const std::string& source, const std::string& key) {
    const std::string v = text_of(node, source, key);
    std::string known;
    for (std::size_t i = 0; i < std::size(kSpineWords); ++i) {
        if (v == kSpineWords[i]) return static_cast<SpineMethod>(i);
        known += std::string(i == 0                            ? ""
                             : i + 1 == std::size(kSpineWords) ? " or "
                                                               : ", ") +
                 '"' + kSpineWords[i] + '"';
    }
    fail(source, line_of(node), Message("'{}' must be {}, not \"{}\"", key, known, v));
}

/// Key that took the place of one in earlier files.
std::string current_key(const std::string& table, const std::string& key) {
    return table == "contact" && key == "end_give_mm" ? "end_compliance_mm" : key;
}

void read_value(Preset& p, const std::string& table, const std::string& written, const toml::node& node,
                const std::string& source) {
    const std::string key = current_key(table, written);
    const std::string full = table + "." + key;
    if (full == "bending.spine") {
        p.spine = spine_of(node, source, full);
        return;
    }
    for (const WholeField& f : kWholeFields) {
        if (table != f.table || key != f.key) continue;
        const double v = number_of(node, source, full);
        if (!(v >= f.lo && v <= f.hi) || v != std::floor(v)) fail(source, line_of(node), whole_note(f));
        p.*f.member = static_cast<int>(v);
        return;
    }
    for (const Field& f : kFields) {
        if (table != f.table || key != f.key) continue;
        const double v = number_of(node, source, full);
        if (!(v >= f.lo && v <= f.hi)) {
            fail(source, line_of(node),
                 Message("'{}' is {}, outside {} to {}", full, number(v), number(f.lo), number(f.hi)));
        }
        p.*f.member = v * f.unit + 0.0;  // no negative zero, whose text has no sign in TOML
        return;
    }
    unknown_key(source, node, full);
}

fs::path preset_folder() {
    return data_folder() / "models" / "brushes";
}

}  // namespace

namespace {

constexpr double kMostPores = 60000;

void check_foam(const Preset& p, const std::string& source) {
    if (!is_foam(p)) return;
    if (p.spines > 1 || p.spine != SpineMethod::rod)
        throw Error(source, "foam needs 'ferrule.spines' = 1 and 'bending.spine' = \"rod\"");
    if (p.pore_min > p.pore_max) throw Error(source, "'foam.pore_min_mm' must not exceed 'foam.pore_max_mm'");
    // About as many as the face and the lower half of the side cut, both as wide as twice the radius.
    const double least = 0.5 * p.pore_min, most = 0.5 * p.pore_max;
    const double pores = 4 * p.radius * (p.radius + p.length) / ((least + most) * (least + most));
    if (pores > kMostPores) throw Error(source, "the pores of 'foam' are too small for its size");
    if (p.rim > std::min(p.radius, 0.5 * p.length) || (p.dome > 0 && p.dome < 1.2 * p.radius))
        throw Error(source, "'foam.rim_mm' or 'foam.dome_mm' does not fit 'shape.radius_mm' and 'shape.length_mm'");
    if (p.geometry && p.geometry->triangles.empty()) throw Error(source, "the geometry of foam must have faces");
}

void check_geometry(const Preset& p, const std::string& source) {
    if (!p.geometry) return;
    if (p.spines > 2) throw Error(source, "a geometry is carried by one or two 'ferrule.spines'");
    if (p.spine != SpineMethod::rod) throw Error(source, "a geometry needs 'bending.spine' = \"rod\"");
    const Box box = p.geometry->bounds();
    constexpr double kSlack = 0.01;  // of the length
    const double length = p.length / kMillimetre;
    if (box.hi.z > kSlack * length || box.lo.z < -(1 + kSlack) * length || box.size().z < 0.5 * length)
        throw Error(source,
                    Message("the geometry reaches from z = {} to {} mm: it must fill the hair, from the mouth at "
                            "0 to the tip at {}",
                            number(box.lo.z), number(box.hi.z), number(-length)));
}

}  // namespace

bool can_bend(SpineMethod method, const Preset& p) {
    if (method == SpineMethod::rod) return true;
    if (is_foam(p) || p.geometry) return false;
    const bool flat = has_broad_side(p) && p.splay == 0 && p.slant == 0;
    return p.spines == 1 || (flat && (method == SpineMethod::chain || method == SpineMethod::truss));
}

void check_preset(const Preset& p, const std::string& source) {
    for (const Field& f : kFields) {
        const double v = p.*f.member / f.unit;
        const double slack = 1e-9 * (std::abs(f.lo) + std::abs(f.hi));
        if (!(v >= f.lo - slack && v <= f.hi + slack)) {
            throw Error(source, Message("'{}.{}' is {}, outside {} to {}", std::string(f.table), f.key, number(v),
                                        number(f.lo), number(f.hi)));
        }
    }
    for (const WholeField& f : kWholeFields)
        if (p.*f.member < f.lo || p.*f.member > f.hi) throw Error(source, whole_note(f));
    if (p.radius > (is_foam(p) ? 2 : 0.5) * p.length) {
        throw Error(source, is_foam(p) ? "'shape.radius_mm' of foam must not exceed twice 'shape.length_mm'"
                                       : "'shape.radius_mm' must not exceed half of 'shape.length_mm'");
    }
    check_foam(p, source);
    check_geometry(p, source);
    if (p.width > 0 && p.width < 2 * p.radius) {
        throw Error(source, "'ferrule.width_mm' must be at least the thickness, 2 'shape.radius_mm'");
    }
    if (p.spines > 1 && p.width == 0) {
        if (p.spines < 4) throw Error(source, "a round ferrule holds 1 spine, or 4 to 9 in a ring ('ferrule.spines')");
        if (p.slant > 0 || p.splay > 0)
            throw Error(source, "'ferrule.slant_mm' and 'ferrule.splay_deg' need 'ferrule.width_mm'");
    }
    if (p.spines == 1 && p.width > 0) throw Error(source, "'ferrule.width_mm' needs 'ferrule.spines' above 1");
    if (p.toe > 0 && p.slant > 0) throw Error(source, "'ferrule.toe_mm' and 'ferrule.slant_mm' exclude each other");
    if (std::max(p.toe, p.slant) > 0.8 * p.length) {
        throw Error(source, "the hair at the ferrule's edge must be a fifth of 'shape.length_mm' or longer");
    }
    if (!can_bend(p.spine, p)) {
        throw Error(
            source,
            "several spines need 'bending.spine' = \"rod\", or those of a flat or filbert \"chain\" or \"truss\"");
    }
    if (p.merge_at > p.split_at) {
        throw Error(source, "'split.merge_at' must not exceed 'split.at'");
    }
}

Preset parse_preset(std::string_view text, const std::string& source, const std::optional<fs::path>& folder) {
    const toml::table root = parse_toml(text, source);
    Preset p;
    for (const auto& [key, node] : root) {
        const std::string name(key.str());
        if (name == "name") {
            p.name = text_of(node, source, name);
        } else if (name == "note") {
            p.note = text_of(node, source, name);
        } else if (name == "geometry") {
            if (!folder)
                throw Error(source, "'geometry' names a file; only a brush in a file of its own has one beside it");
            p.geometry = std::make_shared<Geometry>(read_geometry(*folder, text_of(node, source, name), source));
        } else if (name == "geometry_obj") {
            p.geometry = std::make_shared<Geometry>(parse_geometry(text_of(node, source, name), source + ": geometry"));
        } else if (const toml::table* table = node.as_table()) {
            for (const auto& [sub, value] : *table) {
                read_value(p, name, std::string(sub.str()), value, source);
            }
        } else {
            unknown_key(source, node, name);
        }
    }
    if (p.name.empty()) p.name = fs::path(source).stem().string();
    check_preset(p, source);
    return p;
}

std::vector<std::string> list_presets() {
    std::vector<std::string> names;
    std::error_code ec;
    for (const fs::directory_entry& entry : fs::directory_iterator(preset_folder(), ec)) {
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    }
    std::sort(names.begin(), names.end());
    return names;
}

Preset scaled(const Preset& preset, double factor) {
    Preset p = preset;
    for (double Preset::*length : {&Preset::length, &Preset::radius, &Preset::tip_radius, &Preset::tip_drop,
                                   &Preset::end_compliance, &Preset::adhesion_range, &Preset::adhesion})
        p.*length *= factor;
    if (p.spines > 1) {
        for (double Preset::*length :
             {&Preset::width, &Preset::toe, &Preset::slant, &Preset::hair_diameter, &Preset::surface_tension})
            p.*length *= factor;
    }
    for (double Preset::*length : {&Preset::dome, &Preset::rim, &Preset::unevenness}) p.*length *= factor;
    if (p.geometry) p.geometry = std::make_shared<Geometry>(scaled(*p.geometry, factor));
    p.stiffness *= std::pow(factor, 4);
    p.force_gain /= factor * factor;
    p.capacity *= factor * factor * (is_foam(p) ? factor : 1);
    p.name = name_of({preset.name, factor});
    check_preset(p, p.name);
    return p;
}

SizedName sized_name(const std::string& name) {
    const std::size_t star = name.rfind('*');
    if (star == std::string::npos) return {name, 1};
    SizedName out{name.substr(0, star), 0};
    if (out.base.empty() || out.base.find('*') != std::string::npos) throw Error(Message("unknown brush '{}'", name));
    const char* end = name.data() + name.size();
    const auto [at, error] = std::from_chars(name.data() + star + 1, end, out.factor);
    if (error != std::errc{} || at != end || !(out.factor >= kLeastSize && out.factor <= kMostSize))
        throw Error(
            Message("brush '{}': a size from {} to {} must follow the *", name, number(kLeastSize), number(kMostSize)));
    return out;
}

std::string name_of(const SizedName& sized) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", std::clamp(sized.factor, kLeastSize, kMostSize));
    return std::string_view(text) == "1" ? sized.base : sized.base + "*" + text;
}

namespace {

/// A preset as a project stores it and a replay reads it, which rounds numbers to 12 digits: both paint the same.
Preset as_stored(const Preset& preset, const std::string& source) {
    return parse_preset(preset_toml(preset), source);
}

}  // namespace

Preset load_preset(const std::string& name_or_path) {
    if (name_or_path.find('*') != std::string::npos) {
        const SizedName sized = sized_name(name_or_path);
        return as_stored(scaled(load_preset(sized.base), sized.factor), name_or_path);
    }
    fs::path path = name_or_path;
    if (name_or_path.find('/') == std::string::npos && path.extension() != ".toml") {
        const std::vector<std::string> names = list_presets();
        const auto known = [&](const std::string& n) {
            return std::find(names.begin(), names.end(), n) != names.end();
        };
        std::string name = name_or_path;
        if (!known(name) && known(name + "-medium")) name += "-medium";
        if (!known(name)) {
            std::vector<std::string> candidates = names;
            for (const std::string& n : names) {
                const std::size_t dash = n.rfind("-medium");
                if (dash != std::string::npos) candidates.push_back(n.substr(0, dash));
            }
            const std::string near = nearest_name(name, candidates);
            if (names.empty()) {
                throw Error(Message("unknown brush '{}': no presets in {}", name, preset_folder().string()));
            }
            throw Error(Message("unknown brush '{}'{}", name, did_you_mean(near)));
        }
        path = preset_folder() / (name + ".toml");
    }
    path = or_shipped(path);
    const std::vector<char> bytes = read_file(path, (1 << 20) + kMostGeometryBytes);
    return as_stored(parse_preset({bytes.data(), bytes.size()}, path.string(), path.parent_path()), path.string());
}

namespace {

/// A round tuft says nothing of a ferrule, hair nothing of foam, and a brush that is held upright nothing of its lean.
bool says(const Preset& p, std::string_view table) {
    if (table == "hold") return p.lean != 0;
    if (table == "foam") return is_foam(p);
    if (table != "ferrule") return true;
    const Preset round;
    if (p.spines != round.spines) return true;
    return std::any_of(kFields.begin(), kFields.end(), [&](const Field& f) {
        return std::string_view(f.table) == "ferrule" && p.*f.member != round.*f.member;
    });
}

}  // namespace

std::string preset_toml(const Preset& p) {
    std::ostringstream out;
    const auto quoted = [](const std::string& text) {
        std::string q = "\"";
        for (const char c : text) {
            if (c == '"' || c == '\\') q += '\\';
            q += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
        }
        return q + "\"";
    };
    out << "name = " << quoted(p.name) << "\nnote = " << quoted(p.note) << "\n";
    if (p.geometry) out << "geometry_obj = '''\n" << geometry_text(*p.geometry) << "'''\n";
    std::string table;
    for (const Field& f : kFields) {
        if (!says(p, f.table)) continue;
        if (table != f.table) {
            table = f.table;
            out << "\n[" << table << "]\n";
            if (table == "bending") {
                out << "spine = \"" << kSpineWords[static_cast<std::size_t>(p.spine)] << "\"\n";
            }
            for (const WholeField& w : kWholeFields)
                if (table == w.table) out << w.key << " = " << p.*w.member << "\n";
        }
        out << f.key << " = " << number(p.*f.member / f.unit) << "\n";
    }
    out << "\n[hair]\n";
    for (const WholeField& w : kWholeFields)
        if (std::string_view(w.table) == "hair") out << w.key << " = " << p.*w.member << "\n";
    return out.str();
}

void add_to(CacheKey& key, const Preset& p) {
    key.add(p.spine);
    for (const Field& f : kFields) key.add(p.*f.member);
    for (const WholeField& f : kWholeFields) key.add(p.*f.member);
    key.add(p.geometry != nullptr);
    if (!p.geometry) return;
    key.add_array(std::span<const Vec3>(p.geometry->points));
    key.add_array(std::span<const std::array<std::uint32_t, 3>>(p.geometry->triangles));
    for (const std::vector<std::uint32_t>& line : p.geometry->lines)
        key.add_array(std::span<const std::uint32_t>(line));
}

}  // namespace tuft::brush
