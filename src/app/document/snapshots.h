#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/gl/gl_scene.h"

/// Named states of the journal, to go back to and to compare with.
namespace tuft::app {

struct SnapshotLine {
    std::string id;  ///< name of its attachment
    std::string name;
    std::int64_t made = 0;  ///< seconds since 1970
    std::size_t strokes = 0;
};

/// A snapshot's picture, for the window.
struct SnapshotPicture {
    std::string id;
    render::MapPixels pixels;
};

/// What the window shows of them.
struct SnapshotState {
    std::vector<SnapshotLine> lines;          ///< the oldest first
    std::string chosen;                       ///< id
    std::string compared;                     ///< id of the one beside the work; "": none
    bool swipe = false;                       ///< one over the other with a line between them; else side by side
    double line_at = 0.5;                     ///< part of the view's width that shows the snapshot
    std::optional<SnapshotPicture> picture;   ///< just arrived
    bool ready = false;                       ///< the picture is on the graphics card
    unsigned texture = 0;                     ///< OpenGL name of its part of a swiped view
    int x = 0, y = 0, width = 0, height = 0;  ///< pixels of the window that show it side by side
};

}  // namespace tuft::app
