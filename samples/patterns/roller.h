#pragma once

#include <functional>
#include <vector>

#include "ink/canvas/canvas.h"
#include "stroke/surface/model.h"

/// A pattern rolled over a model, as an engraved wheel prints it: row by row, each laid out along
/// the surface by the log map, so that nothing in it knows of charts.
namespace tuft::samples {

/// Where the wheel touches.
struct Contact {
    Frame frame;                     ///< t: direction of motion
    std::uint32_t triangle = kNone;  ///< kNone: the wheel spans a gap, nothing is printed
};

/// Straight on from the surface near `from` towards `heading`, `n` places `step` metres apart: where
/// a wheel of 2.5 mm touches that rolls without turning. It goes round edges and over shut lines.
std::vector<Contact> straight_track(const stroke::Model& model, const Vec3& from, const Vec3& heading, double step,
                                    int n);

/// Round the z axis at `radius` metres on the surface that lies under `height`, closed.
std::vector<Contact> ring(const stroke::Model& model, double radius, double height, int n);

/// Black or white after `x` metres of the path and `v` metres to the left of it.
using Pattern = std::function<bool(double x, double v)>;

/// Prints `film` film units of the canvas's pigment along the path, `width` metres wide.
void roll(const stroke::Model& model, ink::Canvas& canvas, int pigment, float film, const std::vector<Contact>& track,
          double step, double width, const Pattern& pattern);

}  // namespace tuft::samples
