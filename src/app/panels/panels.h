#pragma once

#include "app/session.h"

/// What is drawn round and over the model. Each function draws one panel and writes what
/// the person changed into the session.
struct ImVec2;

namespace tuft::app {

/// Heights and widths in pixels for a scale of 1.
inline constexpr float kToolWidth = 256, kJournalWidth = 256, kStatusHeight = 30;

void menu_bar(Session& s);
void tool_panel(Session& s, float top, float bottom, float left);
/// In place of the tools: what is painted with which ink is shown as, and on which material.
void colours_panel(Session& s, float top, float bottom, float left);
void journal_panel(Session& s, float top, float bottom, float left);
void layers_section(Session& s);
void ink_section(Session& s);
void mask_section(Session& s);
void status_bar(Session& s, float top);
void welcome(Session& s);
void open_dialog(Session& s);
void opening_progress(Session& s);
void recovery_dialog(Session& s);
/// Another program has the project: look at it, or go on in a copy?
void in_use_dialog(Session& s);
/// Some work is in memory only: leave it?
void leave_dialog(Session& s);
void export_dialog(Session& s);
void settings_dialog(Session& s);
void keys_dialog(Session& s);
void about_dialog(Session& s);
/// The palette over the view, where it is shown.
void palette_panel(Session& s);
/// The tuft from the side with the surface under it, and what the hand feels.
void tuft_inset(Session& s);
/// Marks on the model: where the tuft touches, where symmetric copies would, the line being drawn.
void view_marks(const Session& s, const render::GlCamera& camera);

/// The export as the dialog says it.
ExportModel export_command(const Session& s, const std::filesystem::path& path);
/// Marks on the atlas: its frame, figures, and where the cursor over the model is in it.
void atlas_marks(const Session& s, const std::optional<Vec2>& cursor);
/// Makes a mask under a name that is free, with the chosen one if that is asked for.
void make_mask(Session& s, stroke::Mask mask);
/// Strokes that do not touch the revised model.
void misfit_dialog(Session& s);
/// The movement that takes a place of the surface with its normal to another.
RigidMove shift_between(const mesh::SurfacePoint& from, const mesh::SurfacePoint& to);

/// Micrometres at the end of the height view's colours: 1, 2 or 5 times a power of ten.
double height_range(const Session& s);

/// sRGB colour (ImU32) of a full film of this ink on porcelain.
/// A column of the window between two heights, `width` in units of the display scale; ends with ImGui::End.
void begin_side_panel(Session& s, const char* name, float left, float top, float width, float bottom);
/// The triangle of what can be folded: down when it is open, to the right else.
void draw_fold_arrow(const Ui& ui, const ImVec2& centre, bool open);
unsigned ink_colour(const Session& s, const std::string& ink);
unsigned ink_colour(const ink::Ink& ink);
/// Of the ink that the next stroke lays down.
unsigned colour_in_tuft(const Session& s);
/// Linear colour of hair at a place between the tip (0) and the root (1) of a tuft dipped into `ink`.
Vec3f hair_colour(double from_tip, unsigned ink);

/// Modal window in the middle; true while it is drawn. Close it with `end_dialog`.
bool begin_dialog(Session& s, const char* title, float width);
void end_dialog(Session& s);

}  // namespace tuft::app
