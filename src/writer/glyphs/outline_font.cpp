#include "writer/glyphs/outline_font.h"

#include <algorithm>

#include "io/font/font.h"

namespace tuft::writer {
namespace {

constexpr double kLowest = 0.4;  // em: a deeper descent would raise the characters out of their squares

class OutlineFont : public GlyphSource {
  public:
    OutlineFont(const std::filesystem::path& path, int face) : name_(path.string()), font_(path, face) {}

    std::optional<Glyph> find(char32_t code) override {
        if (!font_.has(code)) return std::nullopt;
        const std::u32string one(1, code);
        return glyph_of(font_.shape(one).at(0), one);
    }

    std::vector<std::optional<Glyph>> find_line(const std::u32string& line) override {
        if (!std::all_of(line.begin(), line.end(), [&](char32_t code) { return font_.has(code); }))
            return GlyphSource::find_line(line);
        std::vector<std::optional<Glyph>> out;
        for (const io::ShapedGlyph& shaped : font_.shape(line)) out.push_back(glyph_of(shaped, line));
        return out;
    }

  private:
    // The square of a character stands on the font's descent.
    Glyph glyph_of(const io::ShapedGlyph& shaped, const std::u32string& line) const {
        const double descent = std::min(std::abs(font_.metrics().descent), kLowest);
        Glyph glyph{.code = line[shaped.character], .advance = kSide * shaped.advance};
        for (const std::vector<Vec2>& ring : shaped.rings) {
            Ring own;
            for (const Vec2& p : ring) own.push_back(kSide * (p + shaped.offset + Vec2(0, descent)));
            glyph.area.push_back(std::move(own));
        }
        check_glyph(glyph, name_);
        return glyph;
    }

    std::string name_;
    io::Font font_;
};

}  // namespace

std::unique_ptr<GlyphSource> open_outline_font(const std::filesystem::path& path, int face) {
    return std::make_unique<OutlineFont>(path, face);
}

}  // namespace tuft::writer
