#pragma once

#include "app/session/open_close.h"
#include "app/session/open_files.h"
#include "app/session/session.h"
#include "app/session/settings_file.h"

/// \file
/// The dialogs of the window, each of which draws itself while its flag in the session is set, and the commands for
/// the paint thread that they end with. Window thread, between Dear ImGui's NewFrame and Render.
namespace tuft::app {

void welcome(Session& s);
void open_dialog(Session& s);
void opening_progress(Session& s);
void recovery_dialog(Session& s);
/// Asks how to open a project that another program holds.
void in_use_dialog(Session& s);
/// Asks before work in memory is left.
void unsaved_work_dialog(Session& s);
void export_dialog(Session& s);
void decals_dialog(Session& s);
void film_dialog(Session& s);
void settings_dialog(Session& s);
void keys_dialog(Session& s);
void about_dialog(Ui& ui, DialogState& dialogs);
/// The built-in manual.
void manual_dialog(Ui& ui, HelpState& help, DialogState& dialogs, const KeyTable& keys);
/// Strokes that do not fit the revised model.
void mismatch_dialog(Session& s);

/// Returns the export command for the dialog's settings.
ExportModel export_command(const ExportSettings& settings, const Orbit& seen_from, const std::filesystem::path& path);
/// The same of the dialogs for decal sheets and films.
ExportSheets sheets_command(const DecalSettings& settings, const stroke::MaskTable& masks,
                            const std::filesystem::path& path);
ExportFilm film_command(const FilmSettings& settings, const Orbit& seen_from, const std::filesystem::path& path);

/// Begins a modal window in the centre. Returns true while it is drawn; then call `end_dialog`.
bool begin_dialog(Ui& ui, const char* title, float width);
void end_dialog(Ui& ui);
/// Ends the dialog `shown` by its buttons: "Cancel", and one that lets a file be chosen for `purpose`, named after the
/// project with `extension`. Either closes it.
void end_dialog_with_file(Session& s, bool& shown, FileDialog::Purpose purpose, const std::string& extension);
/// Starts a row of a dialog with a name before its widget.
void dialog_row(Ui& ui, const char* name);

}  // namespace tuft::app
