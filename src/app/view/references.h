#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/project/attachments.h"

/// \file
/// Reference images pinned over the view, stored in the project. Window thread.
namespace tuft::app {

inline constexpr std::size_t kMostReferenceBytes = std::size_t{24} << 20;  ///< of an image file
inline constexpr double kLeastReference = 0.05, kMostReference = 1;        ///< width over the view's width

/// A pinned image.
struct ReferenceImage {
    std::string id;           ///< name of its attachment
    std::string name;         ///< of the file, as shown
    std::vector<char> bytes;  ///< of the file
    Vec2 at{0.03};            ///< upper left corner, fractions of the view's width and height
    double width = 0.3;       ///< fraction of the view's width
    double opacity = 1;       ///< 0–1
    bool shown = true;
    int pixels_across = 0, pixels_down = 0;  ///< size of the picture; 0: not decoded yet
    unsigned texture = 0;                    ///< OpenGL name; 0: none yet
    bool broken = false;                     ///< it could not be decoded
};

/// All pinned images.
struct References {
    std::vector<ReferenceImage> images;
    bool hidden = false;              ///< hides all
    std::optional<std::size_t> held;  ///< index of the image that the mouse moves or resizes
    bool sizing = false;
};

/// Converts an image to its attachment and back. `from_attachment` ignores unknown fields.
io::Attachment to_attachment(const ReferenceImage& image);
ReferenceImage from_attachment(const io::Attachment& attachment);

/// Reads an image file. Throws `Error` for one that is too large or cannot be decoded.
ReferenceImage read_reference(const std::filesystem::path& file);

}  // namespace tuft::app
