#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/message.h"
#include "mesh/read/polygon_soup.h"

/// \file
/// Materials of a model file: MTL libraries and pictures in the model's folder. Called by the model readers. Any
/// thread.
namespace tuft::io {

/// Limits on the bytes of a picture or library, and on the pixels of a picture.
inline constexpr std::size_t kMaxPictureBytes = std::size_t{1} << 29;
inline constexpr std::size_t kMaxPicturePixels = std::size_t{1} << 28;
/// Limits on the pictures of one model on UDIM tiles: number, and pixels together.
inline constexpr std::size_t kMostPictureTiles = 100;
inline constexpr std::size_t kMaxTilePixels = std::size_t{1} << 30;

/// Decodes the bytes of a PNG, JPEG or TIFF file into 8-bit RGB. Grey pictures get three equal channels. Alpha is
/// dropped. Throws `Error` naming the picture, also for more than `most_pixels`.
std::shared_ptr<const mesh::Picture> decode_picture(std::string name, std::vector<char> bytes,
                                                    std::size_t most_pixels = kMaxPicturePixels);

/// Returns true when `file` lies in `folder` or below it, symbolic links resolved.
bool lies_within(const std::filesystem::path& folder, const std::filesystem::path& file);

/// Returns the picture of that name in the folder, found as by `read_materials`. Null with a warning where it is
/// missing or cannot be read.
std::shared_ptr<const mesh::Picture> read_picture_beside(const std::filesystem::path& folder, const std::string& name,
                                                         std::vector<Message>& warnings);

/// Fills `soup.materials` from the libraries and pictures that its reader has named. They are read from the folder of
/// `model` only. Of a path that leads elsewhere only the file name counts: exporters write paths of their own machine.
/// Of an MTL entry `Kd` (taken as sRGB) or `map_Kd` without its options is read. `<UDIM>` in its name stands for the
/// numbers of the tiles that faces lie on, 1001 to 2000: `Material::tiles`. Missing and unreadable files become
/// warnings, never errors.
void read_materials(mesh::PolygonSoup& soup, const std::filesystem::path& model);

/// Drops the materials when all are the same grey without a picture: they carry no information.
void drop_plain_materials(mesh::PolygonSoup& soup);

}  // namespace tuft::io
