#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/message.h"
#include "mesh/read/polygon_soup.h"

/// The colours that a model's file gives its faces: MTL libraries and pictures beside it.
namespace tuft::io {

/// Bytes of a picture or library at most, and pixels of a picture.
inline constexpr std::size_t kMaxPictureBytes = std::size_t{1} << 29;
inline constexpr std::size_t kMaxPicturePixels = std::size_t{1} << 28;

/// A PNG, JPEG or TIFF file's bytes as a picture; grey ones get three channels, alpha is left out.
/// Throws `Error` naming the picture.
std::shared_ptr<const mesh::Picture> decode_picture(std::string name, std::vector<char> bytes);

/// Whether `file` lies in `folder` or below it, links followed.
bool lies_within(const std::filesystem::path& folder, const std::filesystem::path& file);

/// The picture of that name in the folder, looked for as `read_materials` says; null with a warning where it is not
/// there or cannot be read.
std::shared_ptr<const mesh::Picture> read_picture_beside(const std::filesystem::path& folder, const std::string& name,
                                                         std::vector<Message>& warnings);

/// Fills `soup.materials` from the libraries and pictures its reader has named, which are looked
/// for in the folder of `model` only: a name that leads elsewhere is looked for there by its last
/// part, as exporters write paths of their own machine. MTL: `Kd` (taken as sRGB), or `map_Kd` with
/// its options left aside; other entries say nothing of the colour. What is missing or cannot be
/// read becomes a warning, never an error.
void read_materials(mesh::PolygonSoup& soup, const std::filesystem::path& model);

/// Drops materials that say nothing: all of them the same grey, without a picture.
void drop_plain_materials(mesh::PolygonSoup& soup);

}  // namespace tuft::io
