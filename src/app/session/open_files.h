#pragma once

#include <filesystem>
#include <string>

#include "app/session/session.h"

/// \file
/// Files that are taken into the work besides its model: drawings, inks, reference images. The status bar reports
/// what fails.
namespace tuft::app {

/// Takes writing into the hand to be placed.
void open_writing(Session& s, const std::filesystem::path& path);
/// Takes an ink into the work.
void open_ink(PaintThread* work, StatusMessage& status, const std::filesystem::path& path);
/// Writes an ink to a file, under the file's name.
void save_ink(const ColourState& colours, const std::string& name, StatusMessage& status,
              const std::filesystem::path& path);
/// Pins an image over the view.
void pin_reference(References& references, PaintThread* work, StatusMessage& status, const std::filesystem::path& path);

}  // namespace tuft::app
