#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>

#include "ink/exchange/deposit.h"
#include "stroke/contact/tuft_in_hand.h"
#include "stroke/journal/entry/settings.h"

/// \file
/// Brushes between strokes: each one with its hair and ink as the last entry with it left them. `Document` takes a
/// brush up at the beginning of an entry and puts it down at the end.
namespace tuft::stroke {

/// How an entry takes a brush up.
struct BrushStart {
    brush::Preset preset;    ///< with the spine method of the entry
    std::string name;        ///< by which the brush is held
    std::string ink;         ///< to dip a fresh brush into
    ink::Mix mix{};          ///< of that ink, by plane of the canvas
    std::uint64_t seed = 0;  ///< of the hair of a fresh brush
    DipMode dip = DipMode::each;
};

/// A brush before an entry used it.
struct BrushBackup {
    std::string name;
    std::optional<BrushInHand> brush;  ///< none: it was not held
};

/// The brushes held, by name.
class BrushesInHand {
  public:
    /// Returns the brush as the last entry with it left it; null when it is not held.
    const BrushInHand* find(const std::string& name) const;
    /// Returns the brush that an entry begins with: with `DipMode::persistent` the one held, if its spine is bent by
    /// the same method; else a fresh one, full of the ink.
    BrushInHand take_up(const BrushStart& start) const;
    /// The same for a stroke. The brush is washed and dipped anew where the stroke names another ink than the stroke
    /// before and the brush was not dipped into that one.
    BrushInHand take_up_for_stroke(const BrushStart& start) const;

    /// Holds the brush as it is now. Returns what was held before.
    BrushBackup put_down(const std::string& name, BrushInHand brush);
    void restore(BrushBackup before);
    void drop(const std::string& name) { held_.erase(name); }
    void clear() { held_.clear(); }

  private:
    std::map<std::string, BrushInHand> held_;
};

/// Returns a clean brush full of water: its hair lies together, and it leaves no ink. Erasing strokes take it.
BrushInHand clean_brush(const brush::Preset& preset);

}  // namespace tuft::stroke
