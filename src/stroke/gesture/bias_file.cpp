#include <fmt/format.h>
#include <toml++/toml.h>

#include <cmath>
#include <iterator>

#include "core/error.h"
#include "core/system/files.h"
#include "core/text/nesting.h"
#include "core/text/units.h"
#include "stroke/gesture/bias_correction.h"

namespace tuft::stroke {
namespace {

constexpr std::size_t kMaxBytes = std::size_t{64} << 20;
constexpr std::size_t kMaxPieces = 100'000;

void add_row(std::string& out, const char* key, const double* values, std::size_t n, double unit) {
    fmt::format_to(std::back_inserter(out), "{} = [", key);
    for (std::size_t i = 0; i < n; ++i)
        fmt::format_to(std::back_inserter(out), "{}{:.12g}", i ? ", " : "", values[i] / unit);
    out += "]\n";
}

template <std::size_t N>
void add_row(std::string& out, const char* key, const std::array<Vec2, N>& v, double unit) {
    add_row(out, key, &v[0].x, 2 * N, unit);
}

[[noreturn]] void fail(const toml::node& node, const std::string& source, const Message& what) {
    throw Error(source, static_cast<long>(node.source().begin.line), what);
}

void read_number(const toml::node& node, const std::string& source, const std::string& key, double& out, double unit,
                 double lo, double hi) {
    const auto v = node.value<double>();
    if (!node.is_number() || !v || !(*v >= lo && *v <= hi))
        fail(node, source, fmt::format("'{}' has a value that is no number from {} to {}", key, lo, hi));
    out = *v * unit;
}

void read_row(const toml::node& node, const std::string& source, const std::string& key, double* out, std::size_t n,
              double unit, double lo, double hi) {
    const toml::array* row = node.as_array();
    if (!row || row->size() != n) fail(node, source, fmt::format("'{}' must be a row of {} numbers", key, n));
    for (std::size_t i = 0; i < n; ++i) read_number(*row->get(i), source, key, out[i], unit, lo, hi);
}

template <std::size_t N>
void read_row(const toml::node& node, const std::string& source, const std::string& key, std::array<Vec2, N>& out,
              double unit, double lo, double hi) {
    read_row(node, source, key, &out[0].x, 2 * N, unit, lo, hi);
}

BiasPiece read_piece(const toml::table& table, const std::string& source) {
    BiasPiece p;
    for (const auto& [key, node] : table) {
        const std::string name(key.str());
        if (name == "length_mm") {
            read_number(node, source, name, p.length, kMillimetre, 0, 1e6);
        } else if (name == "place") {
            std::array<double, 2> place{};
            read_row(node, source, name, place.data(), 2, 1, 0, 1);
            p.begin = place[0], p.end = place[1];
        } else if (name == "shape") {
            read_row(node, source, name, p.shape, 1, -2, 2);
        } else if (name == "pressure") {
            read_row(node, source, name, p.pressure.data(), p.pressure.size(), 1, 0, 1);
        } else if (name == "tilt_deg") {
            read_row(node, source, name, p.tilt, kDegree, -90, 90);
        } else if (name == "pressure_ratio") {
            read_row(node, source, name, p.pressure_ratio.data(), 4, 1, 0.5, 2);
        } else if (name == "shift_mm") {
            read_row(node, source, name, p.shift, kMillimetre, -1e4, 1e4);
        } else if (name == "tilt_change_deg") {
            read_row(node, source, name, p.tilt_change, kDegree, -360, 360);
        } else {
            fail(node, source, Message("unknown key '{}' in a piece of a bias correction", name));
        }
    }
    return p;
}

}  // namespace

std::string bias_toml(const BiasCorrection& bias) {
    std::string out = "# How a writer's strokes differ from those that were meant (tuft bias).\n";
    const std::array<double, 4> linear{bias.linear[0][0], bias.linear[1][0], bias.linear[0][1], bias.linear[1][1]};
    add_row(out, "linear", linear.data(), 4, 1);
    for (const BiasPiece& p : bias.pieces) {
        out += "\n[[piece]]\n";
        fmt::format_to(std::back_inserter(out), "length_mm = {:.12g}\n", p.length / kMillimetre);
        const std::array<double, 2> place{p.begin, p.end};
        add_row(out, "place", place.data(), 2, 1);
        add_row(out, "shape", p.shape, 1);
        add_row(out, "pressure", p.pressure.data(), p.pressure.size(), 1);
        add_row(out, "tilt_deg", p.tilt, kDegree);
        add_row(out, "pressure_ratio", p.pressure_ratio.data(), 4, 1);
        add_row(out, "shift_mm", p.shift, kMillimetre);
        add_row(out, "tilt_change_deg", p.tilt_change, kDegree);
    }
    return out;
}

BiasCorrection parse_bias(std::string_view text, const std::string& source) {
    check_toml_nesting(text, source);
    toml::table root;
    try {
        root = toml::parse(text);
    } catch (const toml::parse_error& e) {
        throw Error(source, static_cast<long>(e.source().begin.line), std::string(e.description()));
    }
    BiasCorrection bias;
    for (const auto& [key, node] : root) {
        if (key == "linear") {
            std::array<double, 4> m{};
            read_row(node, source, "linear", m.data(), 4, 1, -2, 2);
            bias.linear = glm::dmat2(m[0], m[2], m[1], m[3]);
            if (!(std::abs(glm::determinant(bias.linear)) > 1e-3)) fail(node, source, "'linear' folds strokes flat");
        } else if (key == "piece" && node.is_array_of_tables()) {
            if (node.as_array()->size() > kMaxPieces) fail(node, source, "a bias correction has too many pieces");
            for (const toml::node& piece : *node.as_array())
                bias.pieces.push_back(read_piece(*piece.as_table(), source));
        } else {
            fail(node, source, Message("unknown key '{}' in a bias correction", std::string(key.str())));
        }
    }
    return bias;
}

BiasCorrection load_bias(const std::filesystem::path& path) {
    const std::vector<char> bytes = read_file(path, kMaxBytes);
    return parse_bias({bytes.data(), bytes.size()}, path.string());
}

}  // namespace tuft::stroke
