#pragma once

#include <filesystem>
#include <string>

#include "app/session/session.h"

/// \file
/// Opening and closing of models and projects. Window thread.
namespace tuft::app {

/// Opens a model or a project. The present work is saved first; where that fails, the user is asked.
void open_path(Session& s, const std::filesystem::path& path);
/// Opens a shipped model. Its unit is known and it has no defects, so the user is not asked.
void open_sample(Session& s, const std::filesystem::path& path);
/// Opens a project that another program holds, read-only or in a copy.
void open_in_use(Session& s, OpenAs as);
/// Continues after the dialog of an inspected model.
void accept_inspected(Session& s);
/// Takes finished results of `Opening`. Returns true when that opened another model or project.
bool poll_opening(Session& s);

/// Inspects a model that shall replace the open one and get its strokes.
void revise_with(Session& s, const std::filesystem::path& path);
/// Opens the project whose strokes the revised model got.
void open_previous(Session& s);

/// Returns true when some of the work is in memory only.
bool has_unsaved_work(const Session& s);
/// Quits, closes or opens. Asks first where some of the work is in memory only.
void request_close(Session& s, CloseRequest request);
/// Quits, closes or opens without asking.
void close_now(Session& s, const CloseRequest& request);
void close_model(Session& s);
void save_as(Session& s, const std::filesystem::path& path);

/// Returns the project's name for the window's title and the status bar. `work` is null without a model.
std::string project_name(const PaintThread* work, const std::filesystem::path& project);

}  // namespace tuft::app
