#include "io/scene/mtl_material.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>

#include "core/geometry/types.h"
#include "ink/spectra/srgb.h"
#include "mesh/read/text_cursor.h"

namespace tuft::io {
namespace {

using nlohmann::json;

constexpr double kSharpest = 1000;  // Ns of a mirror

/// Arguments of an option of `map_Kd`; -1: up to three numbers.
int arguments_of(std::string_view option) {
    for (const std::string_view one :
         {"-blendu", "-blendv", "-bm", "-boost", "-cc", "-clamp", "-imfchan", "-texres", "-type"})
        if (mesh::same_word(option, one)) return 1;
    if (mesh::same_word(option, "-mm")) return 2;
    for (const std::string_view many : {"-o", "-s", "-t"})
        if (mesh::same_word(option, many)) return -1;
    return 0;
}

bool is_number(const std::string& word) {
    char* end = nullptr;
    std::strtod(word.c_str(), &end);
    return !word.empty() && end == word.c_str() + word.size();
}

/// Up to three numbers of a line; one that is missing or not finite is `otherwise`.
std::array<double, 3> numbers_in(const std::string& line, double otherwise) {
    std::array<double, 3> values{otherwise, otherwise, otherwise};
    const char* at = line.c_str();
    for (double& value : values) {
        char* end = nullptr;
        const double read = std::strtod(at, &end);
        if (end == at) break;
        if (std::isfinite(read)) value = read;
        at = end;
    }
    return values;
}

double number_in(const std::string& line, double otherwise) {
    return numbers_in(line, otherwise)[0];
}

std::string number_text(double value) {
    char text[40];
    return {text, std::to_chars(text, text + sizeof text, value, std::chars_format::general, 6).ptr};
}

std::string colour_line(const char* key, const json& colour, bool encode) {
    std::string line = key;
    for (std::size_t c = 0; c < 3; ++c) {
        const bool there = colour.is_array() && c < colour.size() && colour[c].is_number();
        const float value = std::clamp(there ? colour[c].get<float>() : 1.0f, 0.0f, 1.0f);
        line += " " + number_text(encode ? ink::srgb_encode(value) : value);
    }
    return line + "\n";
}

/// The picture of `material[key]`, or "".
std::string file_in(const json& material, const char* key, const FileOfTexture& file_of_texture) {
    const auto info = material.find(key);
    if (info == material.end() || !info->is_object()) return {};
    const auto index = info->find("index");
    return index != info->end() && index->is_number_unsigned() ? file_of_texture(index->get<std::size_t>()) : "";
}

double factor_in(const json& of, const char* key, double otherwise) {
    const auto found = of.find(key);
    return found != of.end() && found->is_number() ? std::clamp(found->get<double>(), 0.0, 1.0) : otherwise;
}

std::string entry_of_gltf(const json& material, const FileOfTexture& file_of_texture) {
    static const json kNone = json::object();
    const auto found = material.find("pbrMetallicRoughness");
    const json& pbr = found != material.end() && found->is_object() ? *found : kNone;
    const json colour = pbr.value("baseColorFactor", json::array({1, 1, 1, 1}));
    const double rough = factor_in(pbr, "roughnessFactor", 1), metal = factor_in(pbr, "metallicFactor", 1);
    std::string out = colour_line("Kd", colour, true);
    out += "Ks 0.04 0.04 0.04\n";
    out += mtl_roughness(rough) + "Pm " + number_text(metal) + "\n";
    const std::string mode = material.value("alphaMode", "OPAQUE");
    if (mode != "OPAQUE" && colour.is_array() && colour.size() > 3 && colour[3].is_number())
        out += "d " + number_text(std::clamp(colour[3].get<double>(), 0.0, 1.0)) + "\n";
    if (material.contains("emissiveFactor")) out += colour_line("Ke", material["emissiveFactor"], false);
    out += mode == "BLEND" ? "illum 4\n" : "illum 2\n";
    if (const std::string file = file_in(pbr, "baseColorTexture", file_of_texture); !file.empty()) {
        out += "map_Kd " + file + "\n";
        if (mode != "OPAQUE") out += "map_d " + file + "\n";
    }
    if (const std::string file = file_in(material, "emissiveTexture", file_of_texture); !file.empty())
        out += "map_Ke " + file + "\n";
    if (const std::string file = file_in(material, "normalTexture", file_of_texture); !file.empty())
        out += "norm " + file + "\nmap_Bump -bm 1 " + file + "\n";  // Blender reads the second
    return out;
}

}  // namespace

std::string mtl_roughness(double roughness) {
    const double smooth = 1 - roughness;
    return "Ns " + number_text(kSharpest * smooth * smooth) + "\nPr " + number_text(roughness) + "\n";
}

std::string picture_name(std::string line) {
    const auto next_word = [&](std::size_t& at) {
        const std::size_t begin = std::min(line.find_first_not_of(" \t", at), line.size());
        at = std::min(line.find_first_of(" \t", begin), line.size());
        return line.substr(begin, at - begin);
    };
    while (line.starts_with('-')) {
        std::size_t at = 0;
        int n = arguments_of(next_word(at));
        if (n == 0) break;
        for (int k = 0; n < 0 ? k < 3 : k < n; ++k) {
            std::size_t after = at;
            if (n < 0 && !is_number(next_word(after))) break;
            if (n > 0) next_word(after);
            at = after;
        }
        const std::size_t rest = line.find_first_not_of(" \t", at);
        line = rest == line.npos ? "" : line.substr(rest);
    }
    return line;
}

MtlAsGltf gltf_of_mtl(const std::string& name, const std::vector<MtlStatement>& entry, const TextureOf& texture_of) {
    Vec3f kd(1), ke(0);
    double alpha = 1, rough = 0.5, metal = 0, ambient = 0;
    bool has_pr = false, has_pm = false, reflects = false;
    int base = -1, emissive = -1, normal = -1;
    std::string base_file, alpha_file;
    json statements = json::array();
    for (const auto& [key, line] : entry) {
        const auto is = [&key = key](const char* word) { return mesh::same_word(key, word); };
        const bool pictured = key.size() > 4 && mesh::same_word(key.substr(0, 4), "map_");
        int texture = -1;
        if (pictured || is("bump") || is("norm") || is("disp") || is("decal") || is("refl")) {
            const std::string file = picture_name(line);
            texture = texture_of(file);
            const std::string options = line.substr(0, line.size() - std::min(file.size(), line.size()));
            if (texture >= 0) statements.push_back({{"line", key + " " + options}, {"texture", texture}});
            if (is("map_Kd")) base = texture, base_file = file;
            if (is("map_d")) alpha_file = file;
            if (is("map_Ke")) emissive = texture;
            if (is("norm") || ((is("bump") || is("map_bump")) && normal < 0)) normal = texture;
            continue;
        }
        statements.push_back({{"line", key + " " + line}});
        const std::array<double, 3> three = numbers_in(line, 1);
        if (is("Kd"))
            for (int c = 0; c < 3; ++c)
                kd[c] = static_cast<float>(std::clamp(three[static_cast<std::size_t>(c)], 0.0, 1.0));
        if (is("Ke"))
            for (int c = 0; c < 3; ++c)
                ke[c] = static_cast<float>(std::clamp(three[static_cast<std::size_t>(c)], 0.0, 1.0));
        if (is("d")) alpha = std::clamp(number_in(line, 1), 0.0, 1.0);
        if (is("Tr")) alpha = 1 - std::clamp(number_in(line, 0), 0.0, 1.0);
        if (is("Pm")) metal = std::clamp(number_in(line, 0), 0.0, 1.0), has_pm = true;
        if (is("Ka")) ambient = std::clamp((three[0] + three[1] + three[2]) / 3, 0.0, 1.0);
        if (is("illum")) reflects = number_in(line, 0) == 3;
        if (is("Pr")) rough = std::clamp(number_in(line, 0.5), 0.0, 1.0), has_pr = true;
        if (is("Ns") && !has_pr) rough = 1 - std::sqrt(std::clamp(number_in(line, 0), 0.0, kSharpest) / kSharpest);
    }
    if (!has_pm && reflects) metal = ambient;
    json colour = json::array();
    for (int c = 0; c < 3; ++c) colour.push_back(base >= 0 ? 1.0f : ink::srgb_decode(kd[c]));
    colour.push_back(alpha);
    json material{{"name", name},
                  {"pbrMetallicRoughness",
                   {{"baseColorFactor", std::move(colour)}, {"metallicFactor", metal}, {"roughnessFactor", rough}}}};
    if (base >= 0) material["pbrMetallicRoughness"]["baseColorTexture"] = {{"index", base}};
    if (emissive >= 0) material["emissiveTexture"] = {{"index", emissive}};
    if (emissive >= 0 && ke == Vec3f(0)) ke = Vec3f(1);
    if (ke != Vec3f(0)) material["emissiveFactor"] = {ke.r, ke.g, ke.b};
    if (normal >= 0) material["normalTexture"] = {{"index", normal}};
    if (alpha < 1 || (!alpha_file.empty() && alpha_file == base_file)) material["alphaMode"] = "BLEND";
    return {std::move(material), std::move(statements)};
}

std::string mtl_entry(const std::string& name, const json& material, const json& statements,
                      const FileOfTexture& file_of_texture) {
    std::string out = "newmtl " + name + "\n";
    if (!statements.is_array() || statements.empty()) return out + entry_of_gltf(material, file_of_texture);
    for (const json& statement : statements) {
        if (!statement.is_object()) continue;
        std::string line = statement.value("line", "");
        std::replace(line.begin(), line.end(), '\n', ' ');
        const auto texture = statement.find("texture");
        if (texture == statement.end()) {
            out += line + "\n";
            continue;
        }
        const std::string file = texture->is_number_unsigned() ? file_of_texture(texture->get<std::size_t>()) : "";
        if (!file.empty()) out += line + (line.ends_with(' ') ? "" : " ") + file + "\n";
    }
    return out;
}

}  // namespace tuft::io
