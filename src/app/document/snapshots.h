#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "io/project/attachments.h"
#include "render/gl/gl_scene.h"

/// \file
/// Named states of the journal, to restore and to compare. Each is an attachment of the project.
namespace tuft::app {

/// A snapshot in the list.
struct SnapshotLine {
    std::string id;  ///< name of its attachment
    std::string name;
    std::int64_t made = 0;  ///< seconds since 1970
    std::size_t strokes = 0;
};

/// Converts between a line and the `about` text of its attachment. The journal is not read. Any thread.
SnapshotLine line_of(const io::Attachment& attachment);
std::string about_text(const SnapshotLine& line);

/// Rendered texels of a snapshot, for the window.
struct SnapshotPicture {
    std::string id;
    render::MapPixels pixels;
};

/// State of the snapshots panel and of the comparison. Window thread.
struct SnapshotState {
    std::vector<SnapshotLine> lines;          ///< oldest first
    std::string chosen;                       ///< id
    std::string compared;                     ///< id of the snapshot shown beside the work; "": none
    bool swipe = false;                       ///< both share one view with a dividing line; else side by side
    double line_at = 0.5;                     ///< fraction of the view's width that shows the snapshot
    std::optional<SnapshotPicture> picture;   ///< just arrived, to be uploaded
    bool ready = false;                       ///< the picture is on the graphics card
    unsigned texture = 0;                     ///< OpenGL name of its part of a divided view
    int x = 0, y = 0, width = 0, height = 0;  ///< pixels, its view when side by side
};

}  // namespace tuft::app
