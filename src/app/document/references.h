#pragma once

#include <optional>
#include <string>
#include <vector>

#include "io/project/attachments.h"

/// Images that are pinned over the view to paint after; kept with the project.
namespace tuft::app {

inline constexpr std::size_t kMostReferenceBytes = std::size_t{24} << 20;  ///< of an image's file
inline constexpr double kLeastReference = 0.05, kMostReference = 1;        ///< of the view's width

struct ReferenceImage {
    std::string id;           ///< name of its attachment
    std::string name;         ///< of the file, for people
    std::vector<char> bytes;  ///< of the file
    Vec2 at{0.03};            ///< upper left corner, parts of the view's width and height
    double width = 0.3;       ///< part of the view's width
    double opacity = 1;
    bool shown = true;
    int pixels_across = 0, pixels_down = 0;  ///< of the picture; 0: not decoded yet
    unsigned texture = 0;                    ///< OpenGL name; 0: none yet
    bool broken = false;                     ///< it cannot be decoded
};

/// What is pinned.
struct References {
    std::vector<ReferenceImage> images;
    bool hidden = false;              ///< all of them, for a look at the model
    std::optional<std::size_t> held;  ///< the one that the mouse moves or sizes
    bool sizing = false;
};

/// As the project carries it, and back; `from_attachment` forgives what it does not know.
io::Attachment to_attachment(const ReferenceImage& image);
ReferenceImage from_attachment(const io::Attachment& attachment);

/// Reads an image file; throws `Error` for one that is too large or cannot be decoded.
ReferenceImage read_reference(const std::filesystem::path& file);

}  // namespace tuft::app
