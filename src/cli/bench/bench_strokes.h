#pragma once

#include <span>
#include <string>
#include <vector>

#include "core/system/progress.h"
#include "stroke/document/document.h"
#include "stroke/surface/model.h"

/// \file
/// What `tuft bench` measures strokes with: models, paths over them and clocks.
namespace tuft::cli {

double wall_seconds();  ///< since some start
/// The value below which a part q of the values lies; 0 without values.
double quantile_of(std::vector<double> values, double q);

/// A model to measure on, and how long preparing it took.
struct MeasuredModel {
    std::string name;
    stroke::Model model;
    double atlas_seconds = 0, map_seconds = 0, graph_seconds = 0;  ///< wall time
    double repair_seconds = 0, all_seconds = 0;
};

/// Returns a sphere of 50 mm with rings of equal height; 4 n² triangles.
mesh::PolygonSoup sphere(int n);

/// Prepares a model whose surface is scaled to that of a sphere of 50 mm, so that texels and brushes are about as large
/// on every model.
MeasuredModel prepare_measured(std::string name, mesh::PolygonSoup soup, stroke::ModelOptions options);

/// Deposit alone: planning, evaluating and inking discs one after the other along a path. Median of repeats, CPU time.
double microseconds_per_stamp(const stroke::Model& model, int texels, int stamps, footprint::Isa isa,
                              std::span<const char* const> inks);

/// Texels of a disc of `texels` across.
double footprint_texels(int texels);

/// A stroke that is measured.
struct Drag {
    int texels = 64;                     ///< width of the line, about
    const char* brush = "mixed-medium";  ///< preset, scaled to that width
    double turn = 0, height = 0;         ///< radians about z and over the equator: where on the model it begins
    int samples = 401;                   ///< of the hand, at 1 kHz, a texel apart
};

/// Returns a preset named "bench": `drag.brush`, as thick as makes lines of that width.
brush::Preset dragged_brush(const stroke::Model& model, const Drag& drag);
/// Returns a stroke of that brush along a path over the model, a stamp per texel.
stroke::PaintStroke dragged(const stroke::Model& model, const Drag& drag);

/// The whole path: contact, bending and deposit of that stroke. Median of repeats, CPU time. With `wiped` of its ink
/// gone the tuft no longer closes: every one of its bristles is drawn and inked by itself.
double stamps_per_second(const stroke::Model& model, int texels, double wiped = 0, const char* brush = "mixed-medium",
                         int repeats = 5);

/// From the sample at which the tuft first touches to ink on the texels, in a painting that has just been opened: wall
/// time of all that is computed between.
double first_ink_milliseconds(const stroke::Model& model, int texels);

/// How long the ink of a hand that paints is behind it: wall time from samples, which come as many at once as a screen
/// shows in a sixtieth of a second, to all of their ink on the texels. Median of a stroke.
double hand_seconds(const stroke::Model& model, const Drag& drag);

}  // namespace tuft::cli
