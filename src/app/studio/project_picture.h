#pragma once

#include <cstddef>
#include <filesystem>

#include "app/session/session.h"

/// \file
/// The project's small picture. Window thread.
namespace tuft::app {

/// Stores a small picture of the project after a pause in painting.
class ProjectPicture {
  public:
    explicit ProjectPicture(Session& session) : session_(session) {}

    /// Forgets the pending picture, because another model was opened.
    void reset();
    /// Checks whether the work changed. `now`: seconds on the window's clock.
    void watch(double now);
    /// Returns true when the stored picture is older than the strokes.
    bool outdated() const;
    /// Stores the picture on the screen when it is due, or `at_once`.
    void store(double now, bool at_once = false);

  private:
    Session& session_;
    double due_ = 0;  ///< seconds; 0: none is due
    std::size_t strokes_seen_ = 0;
    std::filesystem::path project_;  ///< whose picture is due or stored
};

}  // namespace tuft::app
