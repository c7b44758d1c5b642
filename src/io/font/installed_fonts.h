#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

/// \file
/// Fonts installed on this machine, through fontconfig. Called for the text of drawings,
/// and by `writer` for a font that is named.
namespace tuft::io {

/// What a drawing asks for (CSS Fonts, W3C 2018).
struct FontRequest {
    std::vector<std::string> families;  ///< in order of preference; "serif", "sans-serif", "monospace" too
    int weight = 400;                   ///< 1–1000; 400 regular, 700 bold
    bool italic = false;                ///< or oblique
    int width = 100;                    ///< per cent; 75 condensed

    bool operator<(const FontRequest& other) const;
};

/// A face of an installed font.
struct InstalledFont {
    std::filesystem::path file;  ///< empty: no font is installed
    int face = 0;                ///< number of `Font`
    std::string family;
    bool requested = false;  ///< it is of one of the requested families, or of a generic one
};

/// Returns the installed face nearest to a request; with `code`, of those that have the character. Empty `file` when
/// there is none. Cost: about 1 ms; the first call reads fontconfig's cache.
InstalledFont find_font(const FontRequest& request, char32_t code = 0);

}  // namespace tuft::io
