#include "writer/glyphs/outline_font.h"

#include <ft2build.h>
#include <hb-ft.h>

#include <algorithm>
#include <cmath>
#include FT_FREETYPE_H
#include FT_OUTLINE_H

#include "core/error.h"
#include "core/system/files.h"

namespace tuft::writer {
namespace {

constexpr std::size_t kMostFontBytes = std::size_t{256} << 20;
constexpr int kChords = 12;  // of one curve
constexpr std::size_t kMostRings = 1024;

struct Rings {
    std::vector<Ring> rings;
    std::size_t n_points = 0;
    Vec2 at{0};
    double scale = 1;
    Vec2 shift{0};

    Vec2 point(const FT_Vector* v) const {
        return shift + scale * Vec2(static_cast<double>(v->x), static_cast<double>(v->y));
    }
    int add(const Vec2& p) {
        if (rings.empty() || ++n_points > kMostPoints) return 1;
        rings.back().push_back(p);
        at = p;
        return 0;
    }
};

int move_to(const FT_Vector* to, void* user) {
    auto& r = *static_cast<Rings*>(user);
    if (r.rings.size() >= kMostRings) return 1;
    r.rings.emplace_back();
    return r.add(r.point(to));
}
int line_to(const FT_Vector* to, void* user) {
    auto& r = *static_cast<Rings*>(user);
    return r.add(r.point(to));
}
int conic_to(const FT_Vector* control, const FT_Vector* to, void* user) {
    auto& r = *static_cast<Rings*>(user);
    const Vec2 a = r.at, b = r.point(control), c = r.point(to);
    for (int k = 1; k <= kChords; ++k) {
        const double t = static_cast<double>(k) / kChords, s = 1 - t;
        if (r.add(s * s * a + 2 * s * t * b + t * t * c)) return 1;
    }
    return 0;
}
int cubic_to(const FT_Vector* first, const FT_Vector* second, const FT_Vector* to, void* user) {
    auto& r = *static_cast<Rings*>(user);
    const Vec2 a = r.at, b = r.point(first), c = r.point(second), d = r.point(to);
    for (int k = 1; k <= kChords; ++k) {
        const double t = static_cast<double>(k) / kChords, s = 1 - t;
        if (r.add(s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d)) return 1;
    }
    return 0;
}

class OutlineFont : public GlyphSource {
  public:
    explicit OutlineFont(const std::filesystem::path& path)
        : name_(path.string()), bytes_(read_file(path, kMostFontBytes)) {
        if (FT_Init_FreeType(&library_) != 0) throw Error(name_, Message("FreeType does not start"));
        if (FT_New_Memory_Face(library_, reinterpret_cast<const FT_Byte*>(bytes_.data()),
                               static_cast<FT_Long>(bytes_.size()), 0, &face_) != 0 ||
            !FT_IS_SCALABLE(face_) || face_->units_per_EM == 0) {
            FT_Done_FreeType(library_);
            throw Error(name_, Message("no font with outlines"));
        }
        FT_Set_Char_Size(face_, face_->units_per_EM * 64, 0, 72, 72);
        shaper_ = hb_ft_font_create(face_, nullptr);
        hb_ft_font_set_load_flags(shaper_, FT_LOAD_NO_HINTING);
    }
    ~OutlineFont() override {
        hb_font_destroy(shaper_);
        FT_Done_Face(face_);
        FT_Done_FreeType(library_);
    }
    OutlineFont(const OutlineFont&) = delete;
    OutlineFont& operator=(const OutlineFont&) = delete;

    std::optional<Glyph> find(char32_t code) override {
        const FT_UInt index = FT_Get_Char_Index(face_, code);
        if (index == 0) return std::nullopt;
        return outline(index, code, Vec2(0));
    }

    std::vector<std::optional<Glyph>> find_line(const std::u32string& line) override {
        hb_buffer_t* buffer = hb_buffer_create();
        hb_buffer_add_utf32(buffer, reinterpret_cast<const std::uint32_t*>(line.data()), static_cast<int>(line.size()),
                            0, static_cast<int>(line.size()));
        hb_buffer_guess_segment_properties(buffer);
        hb_shape(shaper_, buffer, nullptr, 0);
        unsigned n = 0;
        const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer, &n);
        const hb_glyph_position_t* at = hb_buffer_get_glyph_positions(buffer, &n);
        std::vector<std::optional<Glyph>> out;
        bool missing = false;
        for (unsigned i = 0; i < n; ++i) missing = missing || infos[i].codepoint == 0;
        for (unsigned i = 0; i < n && !missing; ++i) {
            const double unit = scale() / 64;
            Glyph glyph = outline(infos[i].codepoint, line[std::min<std::size_t>(infos[i].cluster, line.size() - 1)],
                                  unit * Vec2(at[i].x_offset, at[i].y_offset));
            glyph.advance = unit * at[i].x_advance;
            out.push_back(std::move(glyph));
        }
        hb_buffer_destroy(buffer);
        return missing ? GlyphSource::find_line(line) : out;
    }

  private:
    double scale() const { return kSide / face_->units_per_EM; }

    Glyph outline(FT_UInt index, char32_t code, const Vec2& offset) {
        if (FT_Load_Glyph(face_, index, FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP) != 0 ||
            face_->glyph->format != FT_GLYPH_FORMAT_OUTLINE)
            throw Error(name_, Message("character {} has no outline", utf8_of(code)));
        const double descent = std::abs(static_cast<double>(face_->descender)) * scale();
        Rings rings{.scale = scale(), .shift = offset + Vec2(0, std::min(descent, 0.4 * kSide))};
        FT_Outline_Funcs walk{move_to, line_to, conic_to, cubic_to, 0, 0};
        if (FT_Outline_Decompose(&face_->glyph->outline, &walk, &rings) != 0)
            throw Error(name_, Message("character {} has too large an outline", utf8_of(code)));
        Glyph glyph{.code = code,
                    .area = std::move(rings.rings),
                    .advance = scale() * static_cast<double>(face_->glyph->metrics.horiAdvance)};
        check_glyph(glyph, name_);
        return glyph;
    }

    std::string name_;
    std::vector<char> bytes_;
    FT_Library library_ = nullptr;
    FT_Face face_ = nullptr;
    hb_font_t* shaper_ = nullptr;
};

}  // namespace

bool is_outline_font(const std::filesystem::path& path) {
    std::string kind = path.extension().string();
    std::transform(kind.begin(), kind.end(), kind.begin(), [](unsigned char c) { return std::tolower(c); });
    static constexpr std::string_view kKinds[] = {".ttf", ".otf", ".ttc", ".otc", ".woff", ".woff2", ".pfb"};
    return std::find(std::begin(kKinds), std::end(kKinds), kind) != std::end(kKinds);
}

std::unique_ptr<GlyphSource> open_outline_font(const std::filesystem::path& path) {
    return std::make_unique<OutlineFont>(path);
}

}  // namespace tuft::writer
