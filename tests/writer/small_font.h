#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "core/files/files.h"

/// \file
/// Fonts of a few characters, made of polygons: which fonts are installed differs from machine to machine.
namespace tuft::writer {

using FontRing = std::vector<std::array<int, 2>>;  // 1/1000 of the side, y up; at most 16,383 from zero

inline FontRing font_box(int left, int bottom, int right, int top) {
    return {{left, bottom}, {left, top}, {right, top}, {right, bottom}};
}

/// Numbers as a font has them: the first byte is the highest.
class FontBytes {
  public:
    FontBytes& u8(unsigned v) { return bytes_ += static_cast<char>(v & 255), *this; }
    FontBytes& u16(int v) { return u8(static_cast<unsigned>(v) >> 8), u8(static_cast<unsigned>(v)); }
    FontBytes& u32(std::uint32_t v) { return u16(static_cast<int>(v >> 16)), u16(static_cast<int>(v & 0xffff)); }
    FontBytes& add(const std::string& more) { return bytes_ += more, *this; }
    FontBytes& pad() {
        while (bytes_.size() % 4 != 0) u8(0);
        return *this;
    }
    const std::string& bytes() const { return bytes_; }

  private:
    std::string bytes_;
};

/// One character of a font, by its rings (the nonzero rule).
inline std::string font_outline(const std::vector<FontRing>& rings) {
    FontBytes out;
    int lo[2] = {32767, 32767}, hi[2] = {-32768, -32768}, last = -1, before[2] = {0, 0};
    for (const FontRing& ring : rings)
        for (const auto& p : ring)
            for (int k = 0; k < 2; ++k) lo[k] = std::min(lo[k], p[k]), hi[k] = std::max(hi[k], p[k]);
    out.u16(static_cast<int>(rings.size())).u16(lo[0]).u16(lo[1]).u16(hi[0]).u16(hi[1]);
    for (const FontRing& ring : rings) out.u16(last += static_cast<int>(ring.size()));
    out.u16(0);
    for (int k = 0; k <= last; ++k) out.u8(1);  // on the outline, and both coordinates in two bytes
    for (int k = 0; k < 2; ++k)
        for (const FontRing& ring : rings)
            for (const auto& p : ring) out.u16(p[k] - before[k]), before[k] = p[k];
    return out.pad().bytes();
}

/// Writes a TrueType font of characters below U+FFFF.
inline void write_font(const std::filesystem::path& file, const std::map<int, std::vector<FontRing>>& characters) {
    const int n = static_cast<int>(characters.size()), segments = 2 * (n + 1);
    FontBytes glyf, loca, hmtx, ends, starts, shifts;
    loca.u32(0), hmtx.u16(1000).u16(0);
    int glyph = 0;
    for (const auto& [code, rings] : characters) {
        int left = 32767;
        for (const FontRing& ring : rings)
            for (const auto& p : ring) left = std::min(left, p[0]);
        loca.u32(static_cast<std::uint32_t>(glyf.bytes().size())), hmtx.u16(1000).u16(left);
        glyf.add(font_outline(rings));
        ends.u16(code), starts.u16(code), shifts.u16(++glyph - code);
    }
    loca.u32(static_cast<std::uint32_t>(glyf.bytes().size()));
    FontBytes cmap, head, hhea, maxp;
    ends.u16(0xffff), starts.u16(0xffff), shifts.u16(1);
    cmap.u16(0).u16(1).u16(3).u16(1).u32(12).u16(4).u16(16 + 4 * segments).u16(0).u16(segments).u16(2).u16(0).u16(0);
    cmap.add(ends.bytes()).u16(0).add(starts.bytes()).add(shifts.bytes());
    for (int k = 0; k <= n; ++k) cmap.u16(0);
    head.u32(0x10000).u32(0x10000).u32(0).u32(0x5f0f3cf5).u16(0).u16(1000).u32(0).u32(0).u32(0).u32(0);
    head.u16(0).u16(0).u16(1000).u16(1000).u16(0).u16(8).u16(2).u16(1).u16(0);
    hhea.u32(0x10000).u16(800).u16(-200).u16(0).u16(1000);
    for (int k = 0; k < 11; ++k) hhea.u16(k == 3);
    hhea.u16(0).u16(n + 1);
    maxp.u32(0x10000).u16(n + 1);
    for (int k = 0; k < 13; ++k) maxp.u16(k < 2 ? 0x7fff : 0);
    const std::map<std::string, std::string> tables{
        {"cmap", cmap.bytes()}, {"glyf", glyf.bytes()}, {"head", head.bytes()}, {"hhea", hhea.bytes()},
        {"hmtx", hmtx.bytes()}, {"loca", loca.bytes()}, {"maxp", maxp.bytes()}};
    FontBytes out, body;
    out.u32(0x10000).u16(static_cast<int>(tables.size())).u16(64).u16(2).u16(48);
    const std::size_t begin = 12 + 16 * tables.size();
    for (const auto& [name, bytes] : tables) {
        out.add(name).u32(0).u32(static_cast<std::uint32_t>(begin + body.bytes().size()));
        out.u32(static_cast<std::uint32_t>(bytes.size()));
        body.add(bytes).pad();
    }
    out.add(body.bytes());
    write_file(file, out.bytes().data(), out.bytes().size());
}

}  // namespace tuft::writer
