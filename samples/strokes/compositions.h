#pragma once

#include <vector>

#include "stroke/journal/recorded_stroke.h"

/// The sample decorations: strokes with their places on the models of `models/`.
namespace tuft::samples {

/// 七上八下 on the inside of the bowl, two rows of two.
std::vector<stroke::RecordedStroke> bowl_inside();
/// 漫步人生 around the outside of the bowl.
std::vector<stroke::RecordedStroke> bowl_outside();
/// Leaves on a winding stem around the plate's rim.
std::vector<stroke::RecordedStroke> plate_ornament();
/// The strokes of three brushes, and what a tilted, a split and a dry tuft does, on the flat sheet.
std::vector<stroke::RecordedStroke> stroke_sheet();
/// Petals from a brush with two inks, glazes, a clean brush through wet ink, dry sweeps; on the flat sheet.
std::vector<stroke::RecordedStroke> wet_sheet();
/// Drops of three inks into water, and one of water into them, on the outside of the bowl.
std::vector<stroke::RecordedStroke> wet_bowl();
/// Clean water dropped into a half-dry wash, on the flat sheet.
std::vector<stroke::RecordedStroke> backrun();
/// A dripping stroke round the shoulder of the vase.
std::vector<stroke::RecordedStroke> wet_vase();
/// A plum branch in blossom, a rock and bamboo on the belly of the vase, in eight pigments.
std::vector<stroke::RecordedStroke> vase_plum();
/// A peony in underglaze blue on the belly of the vase, outlines and washes.
std::vector<stroke::RecordedStroke> blue_and_white();
/// A flower of thick paint on thick paint, on the flat sheet.
std::vector<stroke::RecordedStroke> impasto();
/// Pinstripes along the right flank of the car.
std::vector<stroke::RecordedStroke> car_pinstripe();

}  // namespace tuft::samples
