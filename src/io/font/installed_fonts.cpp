#include "io/font/installed_fonts.h"

#include <fontconfig/fontconfig.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <string_view>
#include <tuple>

namespace tuft::io {
namespace {

template <class T, void (*destroy)(T*)>
struct Destroy {
    void operator()(T* object) const { destroy(object); }
};
using Pattern = std::unique_ptr<FcPattern, Destroy<FcPattern, FcPatternDestroy>>;
using FontSet = std::unique_ptr<FcFontSet, Destroy<FcFontSet, FcFontSetDestroy>>;
using CharSet = std::unique_ptr<FcCharSet, Destroy<FcCharSet, FcCharSetDestroy>>;

const FcChar8* text_of(const std::string& text) {
    return reinterpret_cast<const FcChar8*>(text.c_str());
}

std::string string_in(const FcPattern* pattern, const char* name, int index = 0) {
    FcChar8* text = nullptr;
    if (FcPatternGetString(pattern, name, index, &text) != FcResultMatch) return {};
    return reinterpret_cast<const char*>(text);
}

bool is_generic(std::string_view family) {
    static constexpr std::array names{"serif",         "sans-serif", "sans",     "monospace",  "cursive",
                                      "fantasy",       "system-ui",  "ui-serif", "ui-rounded", "ui-monospace",
                                      "ui-sans-serif", "emoji",      "math",     "fangsong"};
    return std::find(names.begin(), names.end(), family) != names.end();
}

Pattern pattern_of(const FontRequest& request, char32_t code) {
    Pattern pattern(FcPatternCreate());
    for (const std::string& family : request.families) FcPatternAddString(pattern.get(), FC_FAMILY, text_of(family));
    FcPatternAddInteger(pattern.get(), FC_WEIGHT, FcWeightFromOpenType(request.weight));
    FcPatternAddInteger(pattern.get(), FC_SLANT, request.italic ? FC_SLANT_ITALIC : FC_SLANT_ROMAN);
    FcPatternAddInteger(pattern.get(), FC_WIDTH, request.width);
    FcPatternAddBool(pattern.get(), FC_OUTLINE, FcTrue);
    FcPatternAddBool(pattern.get(), FC_COLOR, FcFalse);
    if (code != 0) {
        const CharSet characters(FcCharSetCreate());
        FcCharSetAddChar(characters.get(), code);
        FcPatternAddCharSet(pattern.get(), FC_CHARSET, characters.get());
    }
    FcConfigSubstitute(nullptr, pattern.get(), FcMatchPattern);
    FcDefaultSubstitute(pattern.get());
    return pattern;
}

bool has_character(const FcPattern* font, char32_t code) {
    FcCharSet* characters = nullptr;
    return FcPatternGetCharSet(font, FC_CHARSET, 0, &characters) == FcResultMatch && FcCharSetHasChar(characters, code);
}

bool is_requested(const FcPattern* font, const FontRequest& request) {
    for (const std::string& family : request.families) {
        if (is_generic(family)) return true;
        for (int i = 0;; ++i) {
            const std::string own = string_in(font, FC_FAMILY, i);
            if (own.empty()) break;
            if (FcStrCmpIgnoreCase(text_of(own), text_of(family)) == 0) return true;
        }
    }
    return request.families.empty();
}

}  // namespace

bool FontRequest::operator<(const FontRequest& o) const {
    return std::tie(families, weight, italic, width) < std::tie(o.families, o.weight, o.italic, o.width);
}

InstalledFont find_font(const FontRequest& request, char32_t code) {
    static std::mutex one_at_a_time;  // fontconfig's default configuration is made on the first call
    const std::lock_guard lock(one_at_a_time);
    if (!FcInit()) return {};
    const Pattern pattern = pattern_of(request, code);
    FcResult result = FcResultMatch;
    const FontSet sorted(FcFontSort(nullptr, pattern.get(), FcTrue, nullptr, &result));
    if (!sorted) return {};
    for (int i = 0; i < sorted->nfont; ++i) {
        const FcPattern* font = sorted->fonts[i];
        FcBool outline = FcFalse;
        if (FcPatternGetBool(font, FC_OUTLINE, 0, &outline) != FcResultMatch || !outline) continue;
        if (code != 0 && !has_character(font, code)) continue;
        InstalledFont found{.file = string_in(font, FC_FILE), .family = string_in(font, FC_FAMILY)};
        FcPatternGetInteger(font, FC_INDEX, 0, &found.face);
        found.requested = is_requested(font, request);
        return found;
    }
    return {};
}

}  // namespace tuft::io
