#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <span>

#include "core/error.h"
#include "core/files/files.h"
#include "core/files/toml_text.h"
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

/// A value of the file: where it stands, and what it may be.
struct Field {
    const toml::node& node;
    const std::string& source;  ///< name of the file
    std::string key;

    [[noreturn]] void fail(const Message& what) const {
        throw Error(source, static_cast<long>(node.source().begin.line), what);
    }
};
struct Range {
    double lo = -1e300, hi = 1e300;  ///< as written
    double unit = 1;                 ///< of the file in SI
};

void read_number(const Field& field, double& out, const Range& range) {
    const auto v = field.node.value<double>();
    if (!field.node.is_number() || !v || !(*v >= range.lo && *v <= range.hi))
        field.fail(Message("'{}' has a value that is no number from {} to {}", field.key, fmt::format("{}", range.lo),
                           fmt::format("{}", range.hi)));
    out = *v * range.unit;
}

void read_row(const Field& field, std::span<double> out, const Range& range) {
    const toml::array* row = field.node.as_array();
    if (!row || row->size() != out.size())
        field.fail(Message("'{}' must be a row of {} numbers", field.key, out.size()));
    for (std::size_t i = 0; i < out.size(); ++i) read_number({*row->get(i), field.source, field.key}, out[i], range);
}

template <std::size_t N>
void read_row(const Field& field, std::array<Vec2, N>& out, const Range& range) {
    read_row(field, std::span(&out[0].x, 2 * N), range);
}

BiasPiece read_piece(const toml::table& table, const std::string& source) {
    BiasPiece p;
    for (const auto& [key, node] : table) {
        const Field field{node, source, std::string(key.str())};
        const std::string& name = field.key;
        if (name == "length_mm") {
            read_number(field, p.length, {.lo = 0, .hi = 1e6, .unit = kMillimetre});
        } else if (name == "place") {
            std::array<double, 2> place{};
            read_row(field, place, {.lo = 0, .hi = 1});
            p.begin = place[0], p.end = place[1];
        } else if (name == "shape") {
            read_row(field, p.shape, {.lo = -2, .hi = 2});
        } else if (name == "pressure") {
            read_row(field, p.pressure, {.lo = 0, .hi = 1});
        } else if (name == "tilt_deg") {
            read_row(field, p.tilt, {.lo = -90, .hi = 90, .unit = kDegree});
        } else if (name == "pressure_ratio") {
            read_row(field, p.pressure_ratio, {.lo = 0.5, .hi = 2});
        } else if (name == "shift_mm") {
            read_row(field, p.shift, {.lo = -1e4, .hi = 1e4, .unit = kMillimetre});
        } else if (name == "tilt_change_deg") {
            read_row(field, p.tilt_change, {.lo = -360, .hi = 360, .unit = kDegree});
        } else {
            field.fail(Message("unknown key '{}' in a piece of a bias correction", name));
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
    const toml::table root = parse_toml(text, source);
    BiasCorrection bias;
    for (const auto& [key, node] : root) {
        const Field field{node, source, std::string(key.str())};
        if (field.key == "linear") {
            std::array<double, 4> m{};
            read_row(field, m, {.lo = -2, .hi = 2});
            bias.linear = glm::dmat2(m[0], m[2], m[1], m[3]);
            if (!(std::abs(glm::determinant(bias.linear)) > 1e-3)) field.fail("'linear' folds strokes flat");
        } else if (field.key == "piece" && node.is_array_of_tables()) {
            if (node.as_array()->size() > kMaxPieces) field.fail("a bias correction has too many pieces");
            for (const toml::node& piece : *node.as_array())
                bias.pieces.push_back(read_piece(*piece.as_table(), source));
        } else {
            field.fail(Message("unknown key '{}' in a bias correction", field.key));
        }
    }
    return bias;
}

BiasCorrection load_bias(const std::filesystem::path& path) {
    const std::vector<char> bytes = read_file(path, kMaxBytes);
    return parse_bias({bytes.data(), bytes.size()}, path.string());
}

}  // namespace tuft::stroke
