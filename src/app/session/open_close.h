#pragma once

#include <filesystem>
#include <string>

#include "app/session/session.h"

/// \file
/// Opening and closing models and projects.
namespace tuft::app {

/// Opens a model or a project; the work in hand is saved where it is, and asked about where it is in memory only.
void open_path(Session& s, const std::filesystem::path& path);
/// Opens a shipped model: its unit is known and it is sound, so nothing is asked.
void open_sample(Session& s, const std::filesystem::path& path);
/// Opens a project that another program has, to look at it or to go on in a copy.
void open_in_use(Session& s, OpenAs as);
/// Goes on from the dialog of a model that was looked at.
void accept_inspected(Session& s);
/// Takes over what the opening thread has finished; true when another model or project is open by it.
bool poll_opening(Session& s);

/// Looks at a model that shall take the place of the open one, with its strokes.
void revise_with(Session& s, const std::filesystem::path& path);
/// Opens the project that the strokes of the revised model came from.
void open_previous(Session& s);

/// Some of the work is in memory only.
bool has_unsaved_work(const Session& s);
/// Quits, closes or opens; where some work is in memory only, asks first.
void request_close(Session& s, CloseRequest request);
/// Does so without asking.
void close_now(Session& s, const CloseRequest& request);
void close_model(Session& s);
void save_as(Session& s, const std::filesystem::path& path);

/// What the window's title and status say about the project; `work` is null without a model.
std::string project_name(const PaintThread* work, const std::filesystem::path& project);

}  // namespace tuft::app
