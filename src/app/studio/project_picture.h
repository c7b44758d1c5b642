#pragma once

#include <cstddef>
#include <filesystem>

#include "app/session/session.h"

namespace tuft::app {

/// Stores a small picture of the project when nothing was painted for a while.
class ProjectPicture {
  public:
    explicit ProjectPicture(Session& session) : session_(session) {}

    /// Another model is open: it has the picture that it had.
    void reset();
    /// Looks whether the work changed.
    void watch(double now);
    /// The stored one is older than the strokes.
    bool outdated() const;
    /// Stores what is on the screen when it is due, or `at_once`.
    void store(double now, bool at_once = false);

  private:
    Session& session_;
    double due_ = 0;  ///< seconds; 0: not at all
    std::size_t strokes_seen_ = 0;
    std::filesystem::path project_;  ///< whose picture is due, or stored
};

}  // namespace tuft::app
