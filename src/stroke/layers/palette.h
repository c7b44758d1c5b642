#pragma once

#include <memory>
#include <span>
#include <vector>

#include "atlas/texels/seam_links.h"
#include "ink/film/film.h"
#include "stroke/journal/entry/layers.h"
#include "stroke/surface/model.h"

/// \file
/// The palette: a plate of glazed porcelain beside the model, on which brushes mix. It is painted on like the model,
/// with wet ink, by entries of the same journal whose layer is `kPaletteLayer`.
namespace tuft::stroke {

inline constexpr double kPaletteWidth = 0.12, kPaletteHeight = 0.09;  ///< metres
inline constexpr std::uint32_t kPaletteTexels = 512;                  ///< per side of its atlas
inline constexpr double kPaletteTexel = 0.25e-3;                      ///< side of a texel, metres

/// Builds the plate. Frame: x to the right, y up, origin in its middle, face z = 0 upwards. Texel (i, j) of its atlas
/// has its centre at ((i + ½, j + ½) 0.25 mm − (64, 49) mm). Always the same, so that a replay is. Cost: about 50 ms.
Model make_palette();

/// Returns the plate's material: nothing soaks in, and puddles stay on it.
ink::Substrate palette_substrate();

/// Returns how ink flows on it: it lies level and does not dry.
ink::FilmParams palette_film();

/// The palette of a document. It costs nothing until it is used. Not safe in several threads: reading makes the plate.
class Palette {
  public:
    /// The plate with its texels and what flows on it.
    struct Plate {
        Model model;
        ink::Substrate substrate;
        ink::FilmParams params;
        ink::Canvas canvas;
        atlas::SeamLinks seams;
        std::unique_ptr<ink::WetFilm> film;

        Plate();
    };

    /// The plate, made at the first call.
    Plate& plate();
    const Model& model() const { return made().model; }
    /// The texels; null while nothing was put on it.
    const ink::Canvas* canvas() const { return plate_ ? &plate_->canvas : nullptr; }
    /// Returns the texels to be written to, with these pigments in these planes.
    ink::Canvas& canvas_with(const std::vector<ink::Pigment>& pigments);

    /// Removes all ink; pigments stay.
    void clear();
    /// Removes pigments from the last one until `n` are left, as far as they have no amounts.
    void forget_pigments(std::size_t n);
    /// Returns the slots that changed since the last call, ascending.
    std::vector<std::uint32_t> take_dirty();

  private:
    Plate& made() const;

    mutable std::unique_ptr<Plate> plate_;
};

/// A picture of the palette, one pixel per texel, the highest row first.
struct PalettePicture {
    int width = 480, height = 360;
    std::vector<std::uint8_t> rgb;  ///< [3 width height] sRGB; empty: never drawn
};

/// Draws the whole palette, or only these slots anew.
void refresh(PalettePicture& picture, const Palette& palette);
void refresh(PalettePicture& picture, const Palette& palette, std::span<const std::uint32_t> slots);

}  // namespace tuft::stroke
