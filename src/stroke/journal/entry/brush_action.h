#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "brush/preset/preset.h"
#include "stroke/journal/entry/settings.h"

/// \file
/// What is done to a brush between two strokes.
namespace tuft::stroke {

inline constexpr double kLongestWait = 86400;  ///< s, of ink in a dish or drying

/// Fills a tuft with ink; what it holds stays and mixes.
struct Dip {
    double depth = 1;   ///< part of the tuft's length, from the tip, 0–1
    double amount = 1;  ///< part of the hair's capacity that is filled, 0–1.5; what is above 1 drips onto the surface
                        ///< with wet ink
    double side = 0;  ///< part of the tuft's width, −1–1, from the right flank (> 0) or the left one (< 0); 0: all
                      ///< of it. Right is the ferrule's +x: the right edge of a stroke drawn away from the hand
    double time = 0;  ///< s in the dish, upright, at most `kLongestWait`, in which ink rises in the hair over its level
                      ///< (ink/exchange/uptake.h)

    bool operator==(const Dip&) const = default;
};

/// Removes part of the ink of a tuft, as a rag does.
struct Wipe {
    double depth = 1;   ///< as in `Dip`
    double amount = 1;  ///< part of the ink that is removed, 0–1
    double side = 0;    ///< as in `Dip`

    bool operator==(const Wipe&) const = default;
};

/// Removes all ink; the hair is straight and closed.
struct Rinse {
    bool operator==(const Rinse&) const = default;
};

/// Straightens and closes the hair; the ink stays.
struct Reshape {
    bool operator==(const Reshape&) const = default;
};

using BrushChange = std::variant<Dip, Wipe, Rinse, Reshape>;

/// A change of a brush, as an entry of the journal.
struct BrushAction {
    BrushChange what;
    std::string brush;       ///< name of a preset; empty in a file: that of the next stroke
    std::string ink;         ///< to dip into, and that a fresh brush holds; empty in a file: that of the next stroke
    std::uint64_t seed = 0;  ///< of the hair of a fresh brush
    DipMode dip = DipMode::each;                         ///< whether the action begins with a fresh brush
    brush::SpineMethod spine = brush::SpineMethod::rod;  ///< of a fresh brush, as in `StrokeSettings`
};

/// A number of a change, as files name it.
struct ChangeNumber {
    const char* name;
    double value;
    double usual;  ///< that a file need not state
};

/// Returns the numbers of a change: `depth`, `amount` and `side` of a dip or a wipe, then `time` of a dip.
std::vector<ChangeNumber> numbers_of(const BrushChange& change);
/// Sets the number of this name. Returns false, without effect, where the change has none of that name.
bool set_number(BrushChange& change, std::string_view name, double value);
/// Throws `Error` for a number out of its range.
void check_change(const BrushChange& change);

}  // namespace tuft::stroke
