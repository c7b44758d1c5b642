#include "ink/spectra/colour_space.h"

#include <Eigen/LU>
#include <algorithm>

#include "core/error.h"
#include "core/files/loaded_module.h"
#include "ink/spectra/colour_module.h"
#include "ink/spectra/srgb.h"

namespace tuft::ink {
namespace {

constexpr Chromaticity kD65{0.3127, 0.3290}, kD60{0.32168, 0.33767};
// Of ICC.1, X = 0.9642, Y = 1, Z = 0.8249.
constexpr Chromaticity kD50{0.9642 / 2.7891, 1 / 2.7891};

constexpr std::array<ColourSpaceData, 3> kSpaces{
    ColourSpaceData{"srgb", "sRGB IEC61966-2.1", {0.64, 0.33}, {0.30, 0.60}, {0.15, 0.06}, kD65, false},
    ColourSpaceData{"display-p3", "Display P3", {0.680, 0.320}, {0.265, 0.690}, {0.150, 0.060}, kD65, false},
    ColourSpaceData{"acescg", "ACEScg", {0.713, 0.293}, {0.165, 0.830}, {0.128, 0.044}, kD60, true}};

Eigen::Vector3d xyz_of(const Chromaticity& c) {
    return {c.x / c.y, 1, (1 - c.x - c.y) / c.y};
}

Eigen::Matrix3d primaries_of(ColourSpace space) {
    const ColourSpaceData& d = data_of(space);
    Eigen::Matrix3d p;
    p << xyz_of(d.red), xyz_of(d.green), xyz_of(d.blue);
    const Eigen::Vector3d scale = p.inverse() * xyz_of(d.white);
    return p * scale.asDiagonal();
}

Eigen::Matrix3d adaptation(const Chromaticity& from, const Chromaticity& to) {
    Eigen::Matrix3d cone;  // Bradford
    cone << 0.8951, 0.2664, -0.1614, -0.7502, 1.7135, 0.0367, 0.0389, -0.0685, 1.0296;
    const Eigen::Vector3d ratio = (cone * xyz_of(to)).array() / (cone * xyz_of(from)).array();
    return cone.inverse() * ratio.asDiagonal() * cone;
}

Matrix3 rows_of(const Eigen::Matrix3d& m) {
    Matrix3 rows{};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) rows[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] = m(i, j);
    return rows;
}

ColourConversion load_conversion() {
    const ModuleSymbol found = find_in_module("libtuft_colour.so", TUFT_COLOUR_BUILT, kColourSymbol);
    if (found.symbol) return reinterpret_cast<ColourConversion>(found.symbol);
    throw Error(Message("the colour library cannot be loaded: {} (looked for {})", found.fault, found.tried));
}

ColourMatrices matrices_of(ColourSpace space) {
    ColourMatrices matrices;
    const char* fault = load_conversion()(space, matrices);
    if (fault) throw Error(Message("OpenColorIO: {}", fault));
    return matrices;
}

const ColourMatrices& known_matrices(ColourSpace space) {
    static constexpr Matrix3 kIdentity{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    static constexpr ColourMatrices kSame{kIdentity, kIdentity};
    if (space == ColourSpace::srgb) return kSame;  // what most commands write needs no library
    static const ColourMatrices p3 = matrices_of(ColourSpace::display_p3), acescg = matrices_of(ColourSpace::acescg);
    return space == ColourSpace::display_p3 ? p3 : acescg;
}

}  // namespace

const ColourSpaceData& data_of(ColourSpace space) {
    return kSpaces[static_cast<std::size_t>(space)];
}

std::optional<ColourSpace> colour_space_named(std::string_view name) {
    const auto at = std::find_if(kSpaces.begin(), kSpaces.end(), [&](const auto& d) { return d.name == name; });
    if (at == kSpaces.end()) return std::nullopt;
    return static_cast<ColourSpace>(at - kSpaces.begin());
}

std::vector<std::string_view> colour_space_names() {
    std::vector<std::string_view> names;
    names.reserve(kSpaces.size());
    for (const ColourSpaceData& d : kSpaces) names.push_back(d.name);
    return names;
}

Matrix3 xyz_of_linear(ColourSpace space) {
    return rows_of(primaries_of(space));
}

Matrix3 xyz_d50_of_linear(ColourSpace space) {
    return rows_of(adaptation(data_of(space).white, kD50) * primaries_of(space));
}

Matrix3 adaptation_to_d50(ColourSpace space) {
    return rows_of(adaptation(data_of(space).white, kD50));
}

const Matrix3& from_linear_srgb(ColourSpace space) {
    return known_matrices(space).from_srgb;
}

const Matrix3& to_linear_srgb(ColourSpace space) {
    return known_matrices(space).to_srgb;
}

float encode(ColourSpace space, float linear) {
    return data_of(space).linear ? linear : srgb_encode(linear);
}

Rgb transform(const Matrix3& m, const Rgb& c) {
    Rgb out;
    for (std::size_t i = 0; i < 3; ++i)
        out[i] = static_cast<float>(m[i][0] * double{c[0]} + m[i][1] * double{c[1]} + m[i][2] * double{c[2]});
    return out;
}

Rgb into_gamut(const Rgb& colour, ColourSpace space) {
    const Matrix3 xyz = xyz_of_linear(space);
    const float y = transform(xyz, colour)[1], grey = std::clamp(y, 0.0f, 1.0f);
    const auto [low, high] = std::minmax({colour[0], colour[1], colour[2]});
    const float part = std::min(low < 0 ? grey / (grey - low) : 1.0f, high > 1 ? (1 - grey) / (high - grey) : 1.0f);
    Rgb out;
    for (std::size_t c = 0; c < 3; ++c) out[c] = grey + (colour[c] - grey) * part;
    return out;
}

}  // namespace tuft::ink
