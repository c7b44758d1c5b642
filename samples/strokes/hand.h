#pragma once

#include <string>
#include <vector>

#include "brush/preset/preset.h"
#include "core/geometry/types.h"
#include "stroke/journal/trace.h"

/// A written stroke as a list of key points, and the motion of the hand made from it.
namespace tuft::samples {

/// Where the hand is and how wide the line is there. Position and width in thousandths
/// of the character square, x to the right, y down.
struct Key {
    double x = 0, y = 0;
    double width = 0;  ///< of the line that is wanted; 0 lifts off
    double pace = 1;   ///< speed here, 1 is the stroke's own
    double rest = -1;  ///< seconds to stop here; the path may turn sharply. -1: go on
};

struct Stroke {
    std::string name;  ///< such as "heng"
    std::vector<Key> keys;
};

struct Glyph {
    std::string name;
    std::vector<Stroke> strokes;  ///< in the order in which they are written
};

/// Pressure for each line width of one brush, from its steady strokes.
class WidthTable {
  public:
    explicit WidthTable(const brush::Preset& preset);
    double pressure(double width) const;  ///< metres → 0–1
    double widest() const { return widths_.back(); }

  private:
    std::vector<double> widths_, pressures_;
};

struct WriteOptions {
    double size = 0.03;           ///< metres of the character square
    Vec2 centre{500, 500};        ///< what becomes the trace's origin, thousandths
    double speed = 0.045;         ///< m/s where the pace is 1 and the path is straight
    double turn_radius = 0.0015;  ///< metres: bends tighter than this slow the hand down
    double acceleration = 1.2;    ///< m/s², from rest and into rest
    double sample_rate = 200;     ///< Hz
    Vec2 tilt{0.015, 0.025};      ///< radians: upright, but for a little to the right and to the writer
};

/// The motion: a centripetal Catmull–Rom curve through the keys (from rest to rest, corners
/// at the rests), widths by monotone cubics (Fritsch and Carlson 1980), speed after pace and
/// bend with bounded acceleration.
stroke::Trace write(const Stroke& stroke, const WidthTable& table, const WriteOptions& options);

/// Strokes one after the other, their keys in millimetres from a place on a model.
struct Series {
    stroke::Placement place;
    std::vector<stroke::Trace> out = {};

    void add(const Stroke& stroke, const char* brush, const char* ink, double speed,
             std::vector<stroke::BrushAction> before = {}, const Vec2& tilt = WriteOptions{}.tilt);
};

}  // namespace tuft::samples
