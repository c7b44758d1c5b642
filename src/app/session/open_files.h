#pragma once

#include <filesystem>
#include <string>

#include "app/session/session.h"

/// \file
/// Opening and saving of files besides the model: drawings, inks, reference images. The status bar reports faults.
/// Window thread.
namespace tuft::app {

/// Loads a drawing, to be placed on the model.
void open_writing(Session& s, const std::filesystem::path& path);
/// Returns the source of characters that a file belongs to: the folder of a file of one character (hanzi-writer-data,
/// KanjiVG), else the file.
std::filesystem::path glyphs_beside(const std::filesystem::path& file);
/// Adds an ink to the project.
void open_ink(PaintThread* work, StatusMessage& status, const std::filesystem::path& path);
/// Writes an ink to a file; the file's name becomes its name.
void save_ink(const ColourState& colours, const std::string& name, StatusMessage& status,
              const std::filesystem::path& path);
/// Pins an image over the view; not while a project is only looked at.
void pin_reference(Session& s, const std::filesystem::path& path);

}  // namespace tuft::app
