#include "ink/colour/presets.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <sstream>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/shipped_file.h"

namespace fs = std::filesystem;

namespace tuft::ink::preset {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;

}  // namespace

void Reader::only(std::initializer_list<std::string_view> keys) const {
    for (const auto& [key, value] : table_) {
        if (std::find(keys.begin(), keys.end(), key.str()) != keys.end()) continue;
        const std::vector<std::string> known(keys.begin(), keys.end());
        const std::string near = nearest_name(key.str(), known);
        fail(key.source().begin.line, Message("unknown key '{}'{}", std::string(key.str()), did_you_mean(near)));
    }
}

double Reader::number(std::string_view key, double lo, double hi, std::optional<double> fallback) const {
    const toml::node* node = table_.get(key);
    if (!node) {
        if (!fallback) fail(line(), Message("'{}' is missing", std::string(key)));
        return *fallback;
    }
    return in_range(*node, key, lo, hi);
}

Rgb Reader::rgb(std::string_view key, double lo, double hi) const {
    const toml::array& values = array(key);
    if (values.size() != 3) fail(line_of(key), Message("'{}' must be 3 numbers (red, green, blue)", std::string(key)));
    Rgb result;
    for (std::size_t b = 0; b < 3; ++b) result[b] = static_cast<float>(in_range(*values.get(b), key, lo, hi));
    return result;
}

std::vector<float> Reader::numbers(std::string_view key, std::size_t min, std::size_t max, double lo, double hi) const {
    const toml::array& values = array(key);
    if (values.size() < min || values.size() > max)
        fail(line_of(key), min == max ? Message("'{}' must be {} numbers, not {}", key, min, values.size())
                                      : Message("'{}' must be {} to {} numbers, not {}", key, min, max, values.size()));
    std::vector<float> result;
    for (const toml::node& node : values) result.push_back(static_cast<float>(in_range(node, key, lo, hi)));
    return result;
}

std::string Reader::text(std::string_view key, std::optional<std::string> fallback) const {
    const toml::node* node = table_.get(key);
    if (!node) {
        if (!fallback) fail(line(), Message("'{}' is missing", std::string(key)));
        return *fallback;
    }
    const auto value = node->value<std::string>();
    if (!value || !node->is_string()) fail(node->source().begin.line, Message("'{}' must be text", std::string(key)));
    return *value;
}

void Reader::fail(long at, const Message& what) const {
    throw Error(source_, at, what);
}

long Reader::line_of(std::string_view key) const {
    const toml::node* node = table_.get(key);
    return node ? static_cast<long>(node->source().begin.line) : line();
}

double Reader::in_range(const toml::node& node, std::string_view key, double lo, double hi) const {
    const auto value = node.value<double>();
    if (!value || !node.is_number()) fail(node.source().begin.line, Message("'{}' must be a number", std::string(key)));
    if (!(*value >= lo && *value <= hi)) {
        std::ostringstream range;
        range << "'" << key << "' must lie in [" << lo << ", " << hi << "], not be " << *value;
        fail(node.source().begin.line, range.str());
    }
    return *value + 0.0;  // no negative zero, whose text has no sign in TOML
}

const toml::array& Reader::array(std::string_view key) const {
    const toml::node* node = table_.get(key);
    if (!node) fail(line(), Message("'{}' is missing", std::string(key)));
    if (!node->as_array()) fail(line_of(key), Message("'{}' must be a list of numbers", std::string(key)));
    return *node->as_array();
}

std::vector<std::string> list(const char* folder) {
    std::vector<std::string> names;
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(data_folder() / "models" / folder, ec))
        if (entry.path().extension() == ".toml") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

Text load(std::string_view name, const char* folder, const char* kind) {
    fs::path path(name);
    if (path.extension() != ".toml") {
        const std::vector<std::string> known = list(folder);
        if (std::find(known.begin(), known.end(), name) == known.end()) {
            const std::string near = nearest_name(name, known);
            std::string all;
            for (const std::string& k : known) all += (all.empty() ? "" : ", ") + k;
            throw Error(Message("unknown {} '{}'{}", kind, name,
                                near.empty() ? Message("; there are: {}", all) : did_you_mean(near)));
        }
        path = data_folder() / "models" / folder / (std::string(name) + ".toml");
    }
    path = or_shipped(path);
    const std::vector<char> bytes = read_file(path, kMaxBytes);
    return {{bytes.begin(), bytes.end()}, path.string(), path.stem().string()};
}

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

std::string shortest_float(float v) {
    char buffer[32];
    for (int digits = 6; digits <= 9; ++digits) {
        std::snprintf(buffer, sizeof buffer, "%.*g", digits, static_cast<double>(v));
        if (static_cast<float>(std::strtod(buffer, nullptr)) == v) break;
    }
    return buffer;
}

std::string shortest_in(double v, double unit) {
    char buffer[40];
    for (int step = 0; step <= 4; ++step) {
        double number = v / unit;
        for (int k = 0; k < (step + 1) / 2; ++k) number = std::nextafter(number, step % 2 == 1 ? HUGE_VAL : -HUGE_VAL);
        for (int digits = 6; digits <= 17; ++digits) {
            std::snprintf(buffer, sizeof buffer, "%.*g", digits, number);
            if (std::strtod(buffer, nullptr) * unit == v) return buffer;
        }
    }
    return shortest(v / unit);
}

std::string shortest_in(float v, double unit) {
    char buffer[40];
    for (int digits = 6; digits <= 17; ++digits) {
        std::snprintf(buffer, sizeof buffer, "%.*g", digits, static_cast<double>(v) / unit);
        if (static_cast<float>(std::strtod(buffer, nullptr) * unit) == v) break;
    }
    return buffer;
}

std::string list_text(std::span<const float> values) {
    std::string out = "[";
    for (std::size_t i = 0; i < values.size(); ++i) out += (i ? ", " : "") + shortest_float(values[i]);
    return out + "]";
}

}  // namespace tuft::ink::preset
