#pragma once

#include <string>

#include "sheet.h"

/// Strokes of a tuft that was wiped, shared by the tests of flying white.
namespace tuft::stroke {

inline const std::string kBrush = "mixed-small";

inline BrushAction wipe(double amount, std::uint64_t seed) {
    return {.what = Wipe{.amount = amount}, .brush = kBrush, .ink = "carbon", .seed = seed};
}

inline PaintStroke drag(std::uint64_t seed, double speed = 0.06, int rate = 200) {
    PaintStroke s = line(kBrush, 5e-3, {}, speed, rate);
    s.seed = seed;
    s.settings.spacing = 2;  // coarse is enough here, and quick
    return s;
}

/// A brush wiped to `left` of its ink draws one stroke.
struct DryStroke : Document {
    DryStroke(const Model& model, double left, std::uint64_t seed, const DocumentOptions& options = {},
              PaintStroke s = {})
        : Document(model, options) {
        if (s.trace.samples.empty()) s = drag(seed);
        if (left < 1) {
            paint(wipe(1 - left, seed));
            s.settings.dip = DipMode::persistent;
        }
        paint(s);
    }
};

}  // namespace tuft::stroke
