#include "io/font/font.h"

#include <ft2build.h>
#include <hb-ft.h>

#include <algorithm>
#include <cmath>
#include FT_FREETYPE_H
#include FT_OUTLINE_H
#include FT_TRUETYPE_TABLES_H

#include "core/error.h"
#include "core/files/extension.h"
#include "core/files/files.h"

namespace tuft::io {
namespace {

constexpr std::size_t kMostFontBytes = std::size_t{256} << 20;
constexpr std::size_t kMostRings = 4096, kMostPoints = 100'000;  // of a glyph
constexpr int kMostChords = 64;                                  // of one curve

/// Outline of a glyph, taken from FreeType curve by curve.
struct Outline {
    double em = 1;         // font units
    double tolerance = 0;  // em
    std::vector<std::vector<Vec2>> rings;
    std::size_t n_points = 0;
    Vec2 at{0};

    Vec2 point(const FT_Vector* v) const { return Vec2(static_cast<double>(v->x), static_cast<double>(v->y)) / em; }
    int add(const Vec2& p) {
        if (rings.empty() || ++n_points > kMostPoints) return 1;
        rings.back().push_back(p);
        at = p;
        return 0;
    }
    // Chords of a curve whose second difference is at most `bend`: the distance from a chord is bend / (8 n²).
    int chords(double bend) const {
        return std::clamp(static_cast<int>(std::ceil(std::sqrt(bend / (8 * tolerance)))), 1, kMostChords);
    }
};

int move_to(const FT_Vector* to, void* user) {
    auto& o = *static_cast<Outline*>(user);
    if (o.rings.size() >= kMostRings) return 1;
    o.rings.emplace_back();
    return o.add(o.point(to));
}
int line_to(const FT_Vector* to, void* user) {
    auto& o = *static_cast<Outline*>(user);
    return o.add(o.point(to));
}
int conic_to(const FT_Vector* control, const FT_Vector* to, void* user) {
    auto& o = *static_cast<Outline*>(user);
    const Vec2 a = o.at, b = o.point(control), c = o.point(to);
    const int n = o.chords(2 * glm::length(a - 2.0 * b + c));
    for (int k = 1; k <= n; ++k) {
        const double t = static_cast<double>(k) / n, s = 1 - t;
        if (o.add(s * s * a + 2 * s * t * b + t * t * c)) return 1;
    }
    return 0;
}
int cubic_to(const FT_Vector* first, const FT_Vector* second, const FT_Vector* to, void* user) {
    auto& o = *static_cast<Outline*>(user);
    const Vec2 a = o.at, b = o.point(first), c = o.point(second), d = o.point(to);
    const int n = o.chords(6 * std::max(glm::length(a - 2.0 * b + c), glm::length(b - 2.0 * c + d)));
    for (int k = 1; k <= n; ++k) {
        const double t = static_cast<double>(k) / n, s = 1 - t;
        if (o.add(s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d)) return 1;
    }
    return 0;
}

}  // namespace

struct Font::Face {
    std::string name;
    std::vector<char> bytes;
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    hb_font_t* shaper = nullptr;
    FontMetrics metrics;

    Face(const std::filesystem::path& path, int index) : name(path.string()), bytes(read_file(path, kMostFontBytes)) {
        if (FT_Init_FreeType(&library) != 0) throw Error(name, Message("FreeType does not start"));
        if (FT_New_Memory_Face(library, reinterpret_cast<const FT_Byte*>(bytes.data()),
                               static_cast<FT_Long>(bytes.size()), index, &face) != 0 ||
            !FT_IS_SCALABLE(face) || face->units_per_EM == 0) {
            FT_Done_FreeType(library);
            throw Error(name, Message("no font with outlines"));
        }
        FT_Set_Char_Size(face, face->units_per_EM * 64, 0, 72, 72);
        shaper = hb_ft_font_create(face, nullptr);
        hb_ft_font_set_load_flags(shaper, FT_LOAD_NO_HINTING);
        read_metrics();
    }
    ~Face() {
        hb_font_destroy(shaper);
        FT_Done_Face(face);
        FT_Done_FreeType(library);
    }
    Face(const Face&) = delete;
    Face& operator=(const Face&) = delete;

    double em() const { return face->units_per_EM; }

    void read_metrics() {
        metrics.ascent = face->ascender / em();
        metrics.descent = face->descender / em();
        metrics.underline = face->underline_position / em();
        if (face->underline_thickness > 0) metrics.line_thickness = face->underline_thickness / em();
        if (const auto* os2 = static_cast<const TT_OS2*>(FT_Get_Sfnt_Table(face, FT_SFNT_OS2))) {
            if (os2->version >= 2 && os2->sxHeight > 0) metrics.x_height = os2->sxHeight / em();
            if (os2->yStrikeoutPosition > 0) metrics.strikeout = os2->yStrikeoutPosition / em();
        }
    }

    std::vector<std::vector<Vec2>> outline(FT_UInt index, double tolerance) {
        if (FT_Load_Glyph(face, index, FT_LOAD_NO_SCALE | FT_LOAD_NO_BITMAP) != 0 ||
            face->glyph->format != FT_GLYPH_FORMAT_OUTLINE)
            throw Error(name, Message("glyph {} has no outline", static_cast<unsigned>(index)));
        Outline out{.em = em(), .tolerance = tolerance};
        const FT_Outline_Funcs walk{move_to, line_to, conic_to, cubic_to, 0, 0};
        if (FT_Outline_Decompose(&face->glyph->outline, &walk, &out) != 0)
            throw Error(name, Message("glyph {} has too large an outline", static_cast<unsigned>(index)));
        return std::move(out.rings);
    }
};

Font::Font(const std::filesystem::path& path, int face) : face_(std::make_unique<Face>(path, face)) {}
Font::~Font() = default;
Font::Font(Font&&) noexcept = default;
Font& Font::operator=(Font&&) noexcept = default;

bool Font::has(char32_t code) const {
    return FT_Get_Char_Index(face_->face, code) != 0;
}

const FontMetrics& Font::metrics() const {
    return face_->metrics;
}

std::vector<ShapedGlyph> Font::shape(std::u32string_view run, const Shaping& shaping) {
    std::vector<ShapedGlyph> out;
    if (run.empty()) return out;
    const std::unique_ptr<hb_buffer_t, decltype(&hb_buffer_destroy)> buffer(hb_buffer_create(), hb_buffer_destroy);
    hb_buffer_add_utf32(buffer.get(), reinterpret_cast<const std::uint32_t*>(run.data()), static_cast<int>(run.size()),
                        0, static_cast<int>(run.size()));
    hb_buffer_guess_segment_properties(buffer.get());
    const hb_feature_t off[] = {{HB_TAG('l', 'i', 'g', 'a'), 0, 0, HB_FEATURE_GLOBAL_END},
                                {HB_TAG('c', 'l', 'i', 'g'), 0, 0, HB_FEATURE_GLOBAL_END}};
    hb_shape(face_->shaper, buffer.get(), off, shaping.ligatures ? 0 : 2);
    unsigned n = 0;
    const hb_glyph_info_t* infos = hb_buffer_get_glyph_infos(buffer.get(), &n);
    const hb_glyph_position_t* at = hb_buffer_get_glyph_positions(buffer.get(), &n);
    const double unit = 1 / (64 * face_->em());
    for (unsigned i = 0; i < n; ++i)
        out.push_back({.character = std::min<std::size_t>(infos[i].cluster, run.size() - 1),
                       .offset = unit * Vec2(at[i].x_offset, at[i].y_offset),
                       .advance = unit * at[i].x_advance,
                       .rings = face_->outline(infos[i].codepoint, shaping.tolerance)});
    return out;
}

bool is_font_file(const std::filesystem::path& path) {
    const std::string kind = lower_extension(path);
    static constexpr std::string_view kKinds[] = {".ttf", ".otf", ".ttc", ".otc", ".woff", ".woff2", ".pfb"};
    return std::find(std::begin(kKinds), std::end(kKinds), kind) != std::end(kKinds);
}

}  // namespace tuft::io
