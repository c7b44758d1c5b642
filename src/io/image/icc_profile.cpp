#include "io/image/icc_profile.h"

#include <cmath>
#include <string_view>
#include <utility>

namespace tuft::io {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::size_t kHeaderSize = 128;
constexpr std::array<double, 3> kD50{0.9642, 1, 0.8249};

/// Big-endian numbers, as ICC.1 has them.
void put(Bytes& out, std::uint64_t value, int n_bytes) {
    for (int k = n_bytes - 1; k >= 0; --k) out.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
}

void put_word(Bytes& out, std::string_view four) {
    for (const char c : four) out.push_back(static_cast<std::uint8_t>(c));
}

/// s15Fixed16Number.
void put_fixed(Bytes& out, double value) {
    put(out, static_cast<std::uint32_t>(static_cast<std::int32_t>(std::lround(value * 65536))), 4);
}

Bytes text_tag(std::string_view ascii) {
    Bytes tag;
    put_word(tag, "mluc");
    put(tag, 0, 4);
    put(tag, 1, 4);   // texts
    put(tag, 12, 4);  // bytes of a record
    put_word(tag, "enUS");
    put(tag, 2 * ascii.size(), 4);
    put(tag, 28, 4);  // where it begins
    for (const char c : ascii) put(tag, static_cast<std::uint8_t>(c), 2);
    return tag;
}

Bytes xyz_tag(const std::array<double, 3>& xyz) {
    Bytes tag;
    put_word(tag, "XYZ ");
    put(tag, 0, 4);
    for (const double v : xyz) put_fixed(tag, v);
    return tag;
}

Bytes matrix_tag(const ink::Matrix3& m) {
    Bytes tag;
    put_word(tag, "sf32");
    put(tag, 0, 4);
    for (const auto& row : m)
        for (const double v : row) put_fixed(tag, v);
    return tag;
}

Bytes curve_tag(bool linear) {
    Bytes tag;
    put_word(tag, "para");
    put(tag, 0, 4);
    put(tag, linear ? 0 : 3, 2);
    put(tag, 0, 2);
    if (linear)
        put_fixed(tag, 1);
    else
        for (const double v : {2.4, 1 / 1.055, 0.055 / 1.055, 1 / 12.92, 0.04045}) put_fixed(tag, v);
    return tag;
}

Bytes header(std::size_t size) {
    Bytes out;
    put(out, size, 4);
    put(out, 0, 4);           // no preferred CMM
    put(out, 0x04200000, 4);  // version
    put_word(out, "mntrRGB XYZ ");
    for (const int part : {2026, 1, 1, 0, 0, 0}) put(out, static_cast<std::uint64_t>(part), 2);  // one date for all
    put_word(out, "acsp");
    put(out, 0, 4);  // platform
    put(out, 0, 4);  // flags
    put(out, 0, 4);  // manufacturer
    put(out, 0, 4);  // device
    put(out, 0, 8);  // attributes
    put(out, 0, 4);  // perceptual
    for (const double v : kD50) put_fixed(out, v);
    out.resize(kHeaderSize, 0);
    return out;
}

}  // namespace

std::vector<std::uint8_t> icc_profile(ink::ColourSpace space) {
    const ink::ColourSpaceData& data = ink::data_of(space);
    const ink::Matrix3 xyz = ink::xyz_d50_of_linear(space);
    const auto column = [&](std::size_t c) { return std::array{xyz[0][c], xyz[1][c], xyz[2][c]}; };
    const Bytes curve = curve_tag(data.linear);
    const std::vector<std::pair<std::string_view, Bytes>> tags{{"desc", text_tag(data.title)},
                                                               {"cprt", text_tag("No copyright, use freely")},
                                                               {"wtpt", xyz_tag(kD50)},
                                                               {"chad", matrix_tag(ink::adaptation_to_d50(space))},
                                                               {"rXYZ", xyz_tag(column(0))},
                                                               {"gXYZ", xyz_tag(column(1))},
                                                               {"bXYZ", xyz_tag(column(2))},
                                                               {"rTRC", curve},
                                                               {"gTRC", curve},
                                                               {"bTRC", curve}};
    Bytes table, content;
    const std::size_t begin = kHeaderSize + 4 + 12 * tags.size();
    put(table, tags.size(), 4);
    std::size_t at = 0;
    for (const auto& [name, tag] : tags) {
        const bool shared = name == "gTRC" || name == "bTRC";
        if (!shared) {
            at = begin + content.size();
            content.insert(content.end(), tag.begin(), tag.end());
            content.resize((content.size() + 3) / 4 * 4, 0);
        }
        put_word(table, name);
        put(table, at, 4);
        put(table, tag.size(), 4);
    }
    Bytes profile = header(begin + content.size());
    profile.insert(profile.end(), table.begin(), table.end());
    profile.insert(profile.end(), content.begin(), content.end());
    return profile;
}

}  // namespace tuft::io
