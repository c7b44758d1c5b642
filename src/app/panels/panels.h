#pragma once

#include "app/panels/panel_over.h"
#include "app/session/open_close.h"
#include "app/session/open_files.h"
#include "app/session/session.h"
#include "app/session/settings_file.h"

/// \file
/// The panels round and over the model. Each function draws one panel and writes the user's changes into the session.
/// Window thread, between Dear ImGui's NewFrame and Render.
namespace tuft::app {

/// Sizes in pixels at scale 1.
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
    ArmState& arm;
};
/// What the undo buttons read and change.
struct HistoryParts {
    Ui& ui;
    PaintThread& work;
    const PaintStatus& reported;
    const KeyTable& keys;
};
/// What the layers' section reads and changes.
struct LayerParts {
    Ui& ui;
    LayerState& layers;
    PaintThread& work;
    const stroke::LayerTable& table;
    StatusMessage& status;
    bool viewing = false;  ///< the project is only looked at
};
/// What the journal's section reads and changes.
struct JournalParts {
    Ui& ui;
    JournalState& journal;
    PaintThread& work;
    const ColourState& colours;
    const std::vector<std::string>& brushes;  ///< names of the shipped ones
    const KeyTable& keys;
    Orbit& orbit;
    bool viewing = false;  ///< the project is only looked at
};
/// What the ink's section reads and changes.
struct InkParts {
    Ui& ui;
    BrushSettings& brush;
    ColourState& colours;
    PaintThread& work;
    const PaintStatus& reported;
    FileDialog& files;
};
/// What the options of the chosen tool read and change.
struct OptionParts {
    Ui& ui;
    ToolState& tools;
    BrushSettings& brush;
    StatusMessage& status;
};
/// What is read for the marks over the model.
struct MarkParts {
    const Ui& ui;
    const ViewState& view;
    const ToolState& tools;
    const JournalState& journal;
    const MaskState& masks;
    const stroke::Model& model;
    const mesh::SurfaceQuery& surface;  ///< of the visible parts
};
/// What the section of the model's parts reads and changes.
struct PartParts {
    Ui& ui;
    PartState& parts;
    PaintThread& work;
    const PaintStatus& reported;
    const ColourState& colours;
};

/// What a menu asks for beyond its parts.
enum class MenuChoice { none, close_model, quit, former_model, fold_panels, store_settings, other_language };
MenuChoice menu_bar(const MenuParts& s);
/// The settings that a hand needs all the time, in rows over the view: size, pressure, and those of the tool.
void tool_options(const OptionParts& s, float left, float top, float width);
/// The column of tools at the window's edge.
void tool_strip(Session& s, float top, float bottom, float left);
/// Fields for the place of a drawing or a text.
void place_fields(Ui& ui, ToolState& tools);
/// The text that is written, over the view, while its tool is active.
void lettering_panel(Session& s);
/// The strokes of a character copied from a picture, over the view, while they are corrected.
void copied_strokes_panel(Session& s);
/// Settings of the active tool, the brush and the ink.
void tool_panel(Session& s, float top, float bottom, float left);
/// In place of the tools: recolouring of inks and the shown substrate.
void colours_panel(Session& s, float top, float bottom, float left);
/// Undo and redo, and how far long work is.
void history_buttons(const HistoryParts& s);
void layers_section(const LayerParts& s);
/// The parts of the model: eye, lock, substrate. Nothing for a model whose file names fewer than two.
void parts_section(const PartParts& s);
void journal_section(const JournalParts& s);
/// Pixels that a section saves in less room.
struct Savings {
    float compact = 0, tight = 0;
};
/// The brushes in their families, and a stroke of the chosen one.
Savings brush_rack(Session& s, ToolDensity room);
/// All brushes with a stroke of each, over the view, when shown.
void brush_browser(Session& s);
Savings ink_section(const InkParts& s, ToolDensity room);
/// Chooses a colour by its hex code. Its match becomes the ink.
void set_colour(Session& s, const std::string& hex);
/// The colour window over the view, when shown.
void colour_panel(Session& s);
void mask_section(Session& s);
void status_bar(Session& s, float top);
/// The guide, a box over the view.
void guide(Session& s);
/// Reference images over the view, and their list.
void references_over_view(Session& s);
void references_section(Session& s);
/// The list of snapshots, the bar of a comparison, and the dividing line between work and snapshot.
void snapshots_section(Session& s);
void comparison_bar(Session& s);
void swipe_line(Session& s);
/// The palette over the view, when shown.
void palette_panel(Session& s);
/// The force-feedback arm over the view, when shown: its device, its state, its forces, its space.
void arm_panel(Session& s);
/// The reach of the connected arm, a box in the view.
void arm_marks(const Session& s, const render::GlCamera& camera);
/// The tuft in side view with the surface below it, and the contact force.
void tuft_inset(Session& s);
/// Marks on the model: contact of the tuft and of its symmetric copies, and the curve being edited.
void view_marks(const MarkParts& s, const render::GlCamera& camera);

/// Marks on the atlas: its frame, figures, and the cursor's UV.
void atlas_marks(const Ui& ui, const AtlasView& atlas, PaintThread& work, const std::optional<Vec2>& cursor);
/// Creates a mask under an unused name, combined with the active one by `MaskChoice::with`.
void make_mask(Session& s, stroke::Mask mask);
/// Returns the rigid motion that maps a surface point with its normal to another.
RigidMove shift_between(const mesh::SurfacePoint& from, const mesh::SurfacePoint& to);

/// Returns the upper end of the height view's colour scale, micrometres: 1, 2 or 5 times a power of ten.
double height_range(double max_height);

/// A column of the window.
struct SidePanel {
    float left = 0, top = 0, bottom = 0;  ///< pixels, top < bottom
    float width = kToolWidth;             ///< at scale 1, > 0
    bool scrolls = true;                  ///< false: its content always fits
};
/// Begins a column of the window; end it with ImGui::End. Its content keeps its width when a scrollbar appears.
void begin_side_panel(Ui& ui, const char* name, const SidePanel& panel);
/// Handles at the view's edges that hide or show the panels.
void panel_handles(Session& s);
/// Returns the sRGB colour (ImU32) of a dry film of an ink, as thick as a full brush leaves it, on the substrate shown.
/// An ink named by a hex code has that colour.
unsigned ink_colour(const ColourState& colours, const std::string& ink);
unsigned ink_colour(const ColourState& colours, const ink::Ink& ink);
/// Returns the colour of the ink that the next stroke deposits.
unsigned colour_in_tuft(const BrushSettings& brush, const ColourState& colours, const BrushStatus& painting);

}  // namespace tuft::app
