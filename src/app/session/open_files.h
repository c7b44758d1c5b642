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
/// Stores the copied character that is written in the project, in place of an earlier copy of the picture. Returns at
/// once.
void keep_copy(Session& s);
/// Stores the copies that were read in the project; says why one is not kept.
void store_read_copies(Session& s);
/// Waits for them, before the project is closed.
void finish_storing_copies(Session& s);
/// Copies a character that the project keeps.
void take_kept_copy(Session& s, const KeptCopy& copy);
/// Writes the copied character as JSON (hanzi-writer-data), which is a source of characters.
void save_copy(Session& s, const std::filesystem::path& path);
/// Takes a brush from a TOML file; says why not.
void open_brush(Session& s, const std::filesystem::path& path);
/// Opens a TOML file as what it is.
void open_brush_or_ink(Session& s, const std::filesystem::path& path);
/// Adds an ink to the project.
void open_ink(PaintThread* work, StatusMessage& status, const std::filesystem::path& path);
/// Writes an ink to a file; the file's name becomes its name.
void save_ink(const ColourState& colours, const std::string& name, StatusMessage& status,
              const std::filesystem::path& path);
/// Pins an image over the view; not while a project is only looked at.
void pin_reference(Session& s, const std::filesystem::path& path);

}  // namespace tuft::app
