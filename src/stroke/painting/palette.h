#pragma once

#include "ink/film/film.h"
#include "stroke/journal/layers.h"
#include "stroke/surface/model.h"

/// The palette: a plate of glazed porcelain beside the model, on which brushes mix. It is painted
/// on like the model, with wet ink, by entries of the same journal whose layer is `kPaletteLayer`.
namespace tuft::stroke {

inline constexpr double kPaletteWidth = 0.12, kPaletteHeight = 0.09;  ///< metres
inline constexpr std::uint32_t kPaletteTexels = 512;                  ///< of its atlas, a side
inline constexpr double kPaletteTexel = 0.25e-3;                      ///< metres a side, of each of them

/// The plate: x to the right, y up, its middle at the origin, its face z = 0 upwards. The texel
/// (i, j) of its atlas has its middle at ((i + ½, j + ½) 0.25 mm − (64, 49) mm). Always the
/// same, so that a replay is. About 50 ms.
Model make_palette();

/// What it is made of: nothing soaks in, and puddles stay on it.
ink::Substrate palette_substrate();

/// How ink behaves on it: it lies level, and it is kept from drying.
ink::FilmParams palette_film();

/// What it looks like, a pixel for each texel, the highest row first.
struct PalettePicture {
    int width = 480, height = 360;
    std::vector<std::uint8_t> rgb;  ///< [3 width height] sRGB; empty: never drawn
};

/// What a painting keeps of it.
struct Palette {
    Model model;
    ink::Substrate substrate;
    ink::FilmParams params;
    ink::Canvas canvas;
    atlas::SeamLinks seams;
    std::unique_ptr<ink::WetFilm> film;

    Palette();
};

}  // namespace tuft::stroke
