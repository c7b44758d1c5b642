#pragma once

#include <string>

#include "sheet.h"

/// Strokes of a tuft that was wiped, shared by the tests of flying white.
namespace tuft::stroke {

inline const std::string kBrush = "mixed-small";

inline Stroke wipe(double amount, std::uint64_t seed) {
    Stroke s{.action = Action::wipe, .extent = {.amount = amount}};
    s.trace.flat = false;
    s.trace.brush = kBrush;
    s.trace.ink = "carbon";
    s.trace.seed = seed;
    return s;
}

inline Stroke drag(std::uint64_t seed, double speed = 0.06, int rate = 200) {
    Stroke s = line(kBrush, 5e-3, {}, speed, rate);
    s.trace.seed = seed;
    s.settings.spacing = 2;  // coarse is enough here, and quick
    return s;
}

/// A brush wiped to `left` of its ink draws one stroke.
inline Document dry_stroke(const Model& model, double left, std::uint64_t seed, const DocumentOptions& options = {},
                           Stroke s = {}) {
    Document painting(model, options);
    if (s.trace.samples.empty()) s = drag(seed);
    if (left < 1) {
        painting.paint(wipe(1 - left, seed));
        s.settings.dip = "carry";
    }
    painting.paint(s);
    return painting;
}

}  // namespace tuft::stroke
