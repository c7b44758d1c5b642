#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "io/svg/style/svg_page.h"
#include "stroke/journal/entry/flat_area.h"

/// \file
/// Pictures that an SVG drawing refers to (SVG 1.1, 5.7) as stencils. Called by svg_scene.cpp and svg_areas.cpp. Any
/// thread.
namespace tuft::io {

/// A picture in a drawing.
struct SvgPicture {
    std::shared_ptr<const stroke::AreaImage> pixels;
    SvgMatrix to_unit{1};  ///< metres to the unit square, (0, 0) the picture's upper left corner
};
using SvgPicturePtr = std::shared_ptr<const SvgPicture>;

/// Where a picture lies.
struct SvgPictureFrame {
    SvgViewport port;     ///< user units
    SvgMatrix matrix{1};  ///< user units to metres
};
/// A picture and its corners, user units.
struct SvgPlacedPicture {
    SvgPicturePtr picture;
    SvgLine rectangle;
};
/// Returns a picture in its viewport by `preserveAspectRatio` of its element. Nothing where it has no extent.
std::optional<SvgPlacedPicture> svg_place_picture(std::shared_ptr<const stroke::AreaImage> pixels,
                                                  const pugi::xml_node& node, const SvgPictureFrame& frame,
                                                  const std::string& source);

/// Pictures of one drawing, each read once.
class SvgPictures {
  public:
    /// `folder`: that of the drawing; empty: no file is read.
    explicit SvgPictures(std::filesystem::path folder) : folder_(std::move(folder)) {}

    /// Returns the darkness of the picture of a `data:` URI or of a file in the drawing's folder, 1 − Y' with Y' the
    /// luma of its sRGB values (ITU-R BT.709), times its alpha. Larger ones are reduced to `stroke::kMaxAreaSide`
    /// pixels by means over squares. Throws `Error`: it lies outside the folder, it is missing, too large, no picture.
    std::shared_ptr<const stroke::AreaImage> read(const std::string& href);

  private:
    std::filesystem::path folder_;
    std::map<std::string, std::shared_ptr<const stroke::AreaImage>> known_;
};

}  // namespace tuft::io
