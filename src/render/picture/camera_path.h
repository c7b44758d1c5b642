#pragma once

#include <vector>

#include "render/picture/camera.h"

/// \file
/// Camera of a film as a function of the part of it that has passed. Called by `tuft film`.
namespace tuft::render {

/// Where the camera is at a part of the film.
struct CameraKey {
    double at = 0;  ///< 0 begin … 1 end
    View view;
};

/// Keys ascending by `at`; at least one.
using CameraPath = std::vector<CameraKey>;

/// One turn about z that ends at `view`.
CameraPath turntable_path(const View& view);

/// A path that stands at each view for equal times and moves between two of them during `moving` (0 … 1) of that time.
CameraPath standing_path(const std::vector<View>& views, double moving = 0.25);

/// Returns the view at part `at` of the film, for a picture of `width` × `height` pixels that shows `points` (metres).
/// Before the first and after the last key the camera stands. Between two keys azimuth, elevation, margin, field of
/// view, logarithm of the distance and target are mixed. The weight of the second key is 3 s² − 2 s³, with s the part
/// of the time between them; along a turntable it is s. The target of a view that fits the object is the point of its
/// sight line beside the middle of the object. At a key, and between equal ones, the view is the key's own. Throws as
/// `make_camera`.
View view_at(const CameraPath& path, double at, int width, int height, std::span<const Vec3f> points);

}  // namespace tuft::render
