#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/files/disk_cache.h"
#include "core/system/progress.h"
#include "writer/fit/ink_fit.h"
#include "writer/gesture/side_table.h"
#include "writer/gesture/style.h"

/// \file
/// From characters to motions of a brush. Called by `tuft write`.
namespace tuft::writer {

/// Options of `Writer`.
struct WriterOptions {
    Style style;
    std::string brush;   ///< preset; empty: the style's, in the size that suits the character
    double side = 0.05;  ///< metres, of a character's square
    bool fit = false;    ///< to the source's outlines where it states them; else to predicted sides
    DiskCache cache;     ///< of fitted strokes
};

/// A motion of the hand for one stroke of a character.
struct WrittenStroke {
    stroke::StrokeSamples trace;  ///< metres, y down, origin at the lower left corner of the character's square
    std::string brush;            ///< preset
    std::string label;            ///< the character and the number of the stroke
    bool made_up = false;         ///< a line with a width, whose pressure `press_to_widths` sets
    double roll = 0;              ///< radians, of the holder, in the samples
};

/// Writes characters. Equal characters are fitted once.
class Writer {
  public:
    /// Throws `Error` for an unknown brush.
    explicit Writer(WriterOptions options);

    /// Returns the strokes of each glyph, in order. Strokes are fitted in parallel; the result does not depend on the
    /// number of threads. Throws `Error` where the brush's finest line is wider than a quarter of a character that it
    /// is to write, and for a filled character with more edges than `io::area_lines` takes. Cost: about 0.2 s a stroke;
    /// none for strokes in the cache.
    std::vector<std::vector<WrittenStroke>> write(const std::vector<Glyph>& glyphs, const ProgressFn& progress = {});

    const std::string& brush() const { return brush_; }
    double unit() const { return options_.side / kSide; }
    std::size_t fitted() const { return n_fitted_; }

  private:
    struct Job;
    BrushHand hand();
    Pace pace() const;
    Job job_of(const Glyph& glyph, std::size_t stroke) const;
    struct Fitted {
        std::vector<Station> stations;
        std::uint64_t key = 0;  // 0: drawn as it is
        bool made = false;      // now, not taken from a cache
    };
    std::uint64_t seed_of(const BrushHand& with, const Pace& at) const;
    Fitted fit_stroke(const Glyph& glyph, std::size_t stroke, const BrushHand& with, const Pace& at,
                      std::uint64_t seed) const;
    std::vector<WrittenStroke> strokes_of(const Glyph& glyph, const std::vector<std::vector<Station>>& fitted);
    std::vector<WrittenStroke> filled(const Glyph& glyph) const;
    WrittenStroke motion(const std::vector<Station>& stations, const Glyph& glyph, std::size_t stroke);
    std::optional<std::vector<Station>> cached(std::uint64_t key) const;
    void store(std::uint64_t key, const std::vector<Station>& stations) const;

    WriterOptions options_;
    std::string brush_;
    SideTable sides_;
    stroke::WidthTables tables_;
    std::map<std::uint64_t, std::vector<Station>> known_;
    std::size_t n_fitted_ = 0;
};

inline constexpr double kMedianStroke = 42;  ///< units, median width of strokes

/// Returns the name of the size of a brush that draws strokes of `kMedianStroke` of characters of `side` metres at a
/// middle pressure, where the brush itself is too coarse (it draws lines of more than three times the width then) or
/// too fine (its widest line is narrower than 4/3 of the width). None where it fits, and where no size in the range of
/// presets is nearer.
std::optional<std::string> size_that_fits(const std::string& brush, double side);

/// Rounds corners and joins consecutive strokes by curves that leave a stroke along its end and enter the next along
/// its head. With g the gap and θ the angle by which a link turns from one to the other, a link is drawn where
///
///     g ≤ link (1 − 0.35 θ / 2π),  g ≥ 20 units · θ if θ > π / 2,
///
/// and at most a quarter of it lies over the ink of other strokes. Elsewhere the brush is lifted. The link's half width
/// is 2.2 `link_half` at both ends, and falls to `link_half` (1 − g / 2 link) at 0.55 of its way by the square of the
/// distance from there. It takes the place of as much as 40 units of a head that lies more than 45° across its stroke.
std::vector<std::vector<Station>> linked(std::vector<std::vector<Station>> strokes, const Style& style);

}  // namespace tuft::writer
