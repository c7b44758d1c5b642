#pragma once

#include "app/session/open_close.h"
#include "app/session/open_files.h"
#include "app/session/session.h"
#include "app/session/settings_file.h"

/// What is drawn round and over the model. Each function draws one panel and writes what
/// the person changed into the session.
namespace tuft::app {

/// Heights and widths in pixels for a scale of 1.
inline constexpr float kStripWidth = 58, kToolWidth = 226, kJournalWidth = 252, kStatusHeight = 30, kOptionsHeight = 62;

/// What each panel reads and changes.
struct MenuParts {
    Ui& ui;
    PanelLayout& panels;
    DialogState& dialogs;
    ViewState& view;
    PaletteState& palette;
    BrushSettings& brush;
    StatusMessage& status;
    const KeyTable& keys;
    PaintThread* work;  ///< nullptr: no model is open
    const PaintStatus& reported;
    bool has_former_model;  ///< the open one was revised from it
};
struct HistoryParts {
    Ui& ui;
    PaintThread& work;
    const PaintStatus& reported;
    const KeyTable& keys;
};
struct LayerParts {
    Ui& ui;
    LayerState& layers;
    PaintThread& work;
    const stroke::LayerTable& table;
    StatusMessage& status;
};
struct JournalParts {
    Ui& ui;
    JournalState& journal;
    PaintThread& work;
    const ColourState& colours;
    const std::vector<std::string>& brushes;  ///< names of the shipped ones
    const KeyTable& keys;
    Orbit& orbit;
};
struct InkParts {
    Ui& ui;
    BrushSettings& brush;
    ColourState& colours;
    PaintThread& work;
    const PaintStatus& reported;
    FileDialog& files;
};
struct OptionParts {
    Ui& ui;
    ToolState& tools;
    BrushSettings& brush;
    StatusMessage& status;
};
struct MarkParts {
    const Ui& ui;
    const ViewState& view;
    const ToolState& tools;
    const JournalState& journal;
    const MaskState& masks;
    const stroke::Model& model;
};

/// What a menu asks for beyond its parts.
enum class MenuChoice { none, close_model, quit, former_model, fold_panels, store_settings, other_language };
MenuChoice menu_bar(const MenuParts& s);
/// The settings that a hand needs all the time, in rows over the view: size, pressure, and those of the tool.
void tool_options(const OptionParts& s, float left, float top, float width);
/// The column of tools at the window's edge.
void tool_strip(Session& s, float top, float bottom, float left);
/// What the chosen tool, the brush and the ink are set to.
void tool_panel(Session& s, float top, float bottom, float left);
/// In place of the tools: what is painted with which ink is shown as, and on which material.
void colours_panel(Session& s, float top, float bottom, float left);
/// Undo and redo, and how far long work is.
void history_buttons(const HistoryParts& s);
void layers_section(const LayerParts& s);
void journal_section(const JournalParts& s);
/// Pixels that a section saves in less room.
struct Savings {
    float compact = 0, tight = 0;
};
Savings ink_section(const InkParts& s, ToolRoom room);
/// Chooses a colour by its hex code; the mix found for it comes into the hand.
void set_colour(Session& s, const std::string& hex);
/// The colour wheel over the view, where it is shown.
void colour_panel(Session& s);
void mask_section(Session& s);
void status_bar(Session& s, float top);
void welcome(Session& s);
void open_dialog(Session& s);
void opening_progress(Session& s);
void recovery_dialog(Session& s);
/// Another program has the project: look at it, or go on in a copy?
void in_use_dialog(Session& s);
/// Some work is in memory only: leave it?
void unsaved_work_dialog(Session& s);
void export_dialog(Session& s);
void settings_dialog(Session& s);
void keys_dialog(Session& s);
void about_dialog(Ui& ui, DialogState& dialogs);
/// The built-in manual.
void manual_dialog(Ui& ui, HelpState& help, DialogState& dialogs, const KeyTable& keys);
/// The guided first minute, a box over the view.
void guide(Session& s);
/// Reference images over the view; their list.
void references_over_view(Session& s);
void references_section(Session& s);
/// The list of snapshots; what is done with the one that the work is compared with; the line between the two.
void snapshots_section(Session& s);
void comparison_bar(Session& s);
void swipe_line(Session& s);
/// The palette over the view, where it is shown.
void palette_panel(Session& s);
/// The tuft from the side with the surface under it, and what the hand feels.
void tuft_inset(Session& s);
/// Marks on the model: where the tuft touches, where symmetric copies would, the line being drawn.
void view_marks(const MarkParts& s, const render::GlCamera& camera);

/// The export as the dialog says it.
ExportModel export_command(const ExportSettings& settings, const Orbit& seen_from, const std::filesystem::path& path);
/// Marks on the atlas: its frame, figures, and where the cursor over the model is in it.
void atlas_marks(const Ui& ui, const AtlasView& atlas, PaintThread& work, const std::optional<Vec2>& cursor);
/// Makes a mask under a name that is free, with the chosen one if that is asked for.
void make_mask(Session& s, stroke::Mask mask);
/// Strokes that do not touch the revised model.
void mismatch_dialog(Session& s);
/// The movement that takes a place of the surface with its normal to another.
RigidMove shift_between(const mesh::SurfacePoint& from, const mesh::SurfacePoint& to);

/// Micrometres at the end of the height view's colours: 1, 2 or 5 times a power of ten.
double height_range(double max_height);

/// A column of the window between two heights, `width` in units of the display scale; ends with ImGui::End.
/// What is in it keeps its width when a scrollbar comes. A panel that does not scroll fits what it holds.
void begin_side_panel(Ui& ui, const char* name, float left, float top, float width, float bottom, bool scrolls = true);
/// At the view's edges: fold away or bring back the panels beside it.
void panel_handles(Session& s);
/// sRGB colour (ImU32) of a full film of this ink on porcelain.
unsigned ink_colour(const ColourState& colours, const std::string& ink);
unsigned ink_colour(const ink::Ink& ink);
/// Of the ink that the next stroke lays down.
unsigned colour_in_tuft(const BrushSettings& brush, const ColourState& colours, const BrushStatus& painting);

/// Modal window in the middle; true while it is drawn. Close it with `end_dialog`.
bool begin_dialog(Ui& ui, const char* title, float width);
void end_dialog(Ui& ui);

}  // namespace tuft::app
