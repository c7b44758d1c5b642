#include "app/widgets/missing_characters.h"

#include <imgui.h>

#include <cmath>

namespace tuft::app {
namespace {

// The characters of other scripts than Latin. Surrogates and private characters are none. A texture coordinate from 1
// on is a placeholder's, as the high byte is at least 1.
constexpr unsigned kFirst = 0x180, kSurrogates = 0xd800, kAfterPrivate = 0xf900, kLast = 0xfffc;
constexpr float kSliver = 1e-3f;  // pixels: ImGui leaves out glyphs of no width

}  // namespace

void add_placeholders(ImFont& font, const std::set<unsigned>& absent, float advance) {
    const ImVec2 white = font.ContainerAtlas->TexUvWhitePixel;
    for (unsigned c = kFirst; c <= kLast; ++c) {
        if (c == kSurrogates) c = kAfterPrivate;
        const auto character = static_cast<ImWchar>(c);
        if (absent.count(c) || font.FindGlyphNoFallback(character)) continue;
        const float u = static_cast<float>(c >> 8) + white.x, v = static_cast<float>(c & 0xff) + white.y;
        font.AddGlyph(nullptr, character, 0, 0, kSliver, kSliver, u, v, u, v, advance);
    }
    font.BuildLookupTable();
}

std::set<unsigned> drawn_placeholders(const ImDrawData& drawn) {
    std::set<unsigned> found;
    for (int i = 0; i < drawn.CmdListsCount; ++i)
        for (const ImDrawVert& vertex : drawn.CmdLists[i]->VtxBuffer)
            if (vertex.uv.x >= 1)
                found.insert(static_cast<unsigned>(std::floor(vertex.uv.x)) << 8 |
                             static_cast<unsigned>(std::floor(vertex.uv.y)));
    return found;
}

}  // namespace tuft::app
