#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/document/colours.h"
#include "app/document/curve.h"
#include "app/document/help_state.h"
#include "app/document/journal_state.h"
#include "app/document/layer_list.h"
#include "app/document/opening.h"
#include "app/document/paint_thread.h"
#include "app/document/pictures.h"
#include "app/document/references.h"
#include "app/document/snapshots.h"
#include "app/document/state_folder.h"
#include "app/document/writing.h"
#include "app/input/keys.h"
#include "app/input/pointer_input.h"
#include "app/panels/file_dialog.h"
#include "app/panels/ui.h"
#include "app/view/viewport.h"
#include "render/gl/gl_scene.h"

namespace tuft::app {

enum class ModelView { glaze, clay, flat, height, wetness, texels, charts, stretch };
inline constexpr int kModelViews = 8;

enum class Tool { brush, line, curve, writing, eraser, fill, pick, mask };
enum class Keymap { blender, maya };

/// How the model is looked at.
struct ViewState {
    Orbit orbit;
    ModelView shown = ModelView::glaze;
    render::LightRig rig = render::LightRig::studio;
    bool section = false;      ///< cut open
    int section_axis = 1;      ///< 0 x, 1 y, 2 z
    double section_at = 0.5;   ///< part of the model's size that stays
    bool see_through = false;  ///< tuft
    bool inset = true;         ///< side view of the tuft
    bool atlas = false;        ///< the atlas beside the model
    Vec2 atlas_centre{0.5};    ///< uv in the middle of it
    double atlas_zoom = 1;     ///< 1: all of it is seen
};

enum class PaletteTool { brush, pour, pick };

/// The palette's panel.
struct PaletteState {
    bool shown = false;
    PaletteTool tool = PaletteTool::brush;
    double radius = 0.008;  ///< metres, of a pool that is poured
    stroke::PalettePicture picture;
    bool fresh = false;                          ///< the picture changed
    unsigned texture = 0;                        ///< OpenGL name; 0: none yet
    double x = 0, y = 0, width = 0, height = 0;  ///< pixels: where its picture is; width 0: nowhere
    brush::TuftState tuft;                       ///< pressed on it
};

/// The mask that is made next.
struct MaskChoice {
    stroke::MaskKind kind = stroke::MaskKind::angle;
    double within = 0.7853981634, soft = 0;  ///< radians
    bool through = false;                    ///< a lasso takes what lies behind too
    std::string group;
    int with = 0;  ///< the chosen mask: 0 as it is, 1 united with it, 2 only within it
};

/// How a SpaceMouse is used.
struct CapSettings {
    double speed = 1;
    bool level = true;       ///< the horizon stays as it is
    bool moves_eye = false;  ///< else the model goes where the cap goes
    bool seen = false;       ///< there is one
};

/// Which part of the window the model has, pixels.
struct Area {
    int x = 0, y = 0, width = 1, height = 1;
};

struct ExportChoice {
    std::string preset = "Blender";
    bool relief = true, roughness = true;
    bool pigments = false;     ///< their amounts, with EXR maps
    std::uint32_t size = 0;    ///< texels per side; 0: as painted
    int picture = 0;           ///< 0: none, 1: a still, else that many pictures all round
    int picture_width = 1280;  ///< pixels
};

/// What is to be done once work that is not on disk is given up or written.
struct Leaving {
    enum class To { quit, close, open } to = To::quit;
    std::filesystem::path file;  ///< to be opened
};

/// Everything the window knows, as plain data; panels read and change it.
struct Session {
    Ui ui;
    UiSettings wanted;  ///< taken over between two frames
    bool restyle = false;
    Keymap keymap = Keymap::blender;

    Opening opening;
    std::unique_ptr<PaintThread> painter;
    std::optional<Inspected> inspected;  ///< waits for the person's yes
    OpenOptions open_options;
    std::filesystem::path revises;                   ///< project whose strokes what is being opened shall carry
    std::filesystem::path former;                    ///< project that the revised model's strokes came from
    std::vector<stroke::StrokeMismatch> mismatches;  ///< strokes that do not fit a revised model any more
    std::vector<std::string> fit;                    ///< how all strokes lie on it, a sentence each
    bool show_mismatches = false;
    bool is_sample = false;     ///< what is being opened; nothing is asked then
    bool model_is_new = false;  ///< the scene must take it over
    bool keeps_view = false;    ///< it is looked at as the one before
    SessionNote note;
    std::vector<LostWork> lost;
    std::optional<InUse> in_use;     ///< a project that another program has: asked what to do
    std::optional<Leaving> leaving;  ///< asked about, while some work is in memory only
    std::string left_behind;         ///< what became of work that could not be kept when it was closed, "" if all was
    bool sure_to_delete = false;     ///< the first of them: that is asked once more
    std::vector<std::filesystem::path> samples, recent;
    Pictures pictures;

    ViewState view;
    Area area, atlas_area;
    Tool tool = Tool::brush;
    std::vector<std::string> brushes, inks, substrates;
    std::string brush = "wolf-medium", ink = "carbon";
    PointerSettings hand;
    stroke::Symmetry symmetry;
    CurveInWork curve;
    Writing writing;
    std::vector<std::vector<GhostPoint>> ghost;  ///< where the writing would lie now
    CurveSettings curve_settings;
    bool tools_shown = true, journal_shown = true;  ///< panels that are not folded away
    bool more_hand = false;                         ///< all settings of the hand are shown
    double highest = 0;                             ///< micrometres, of the ink seen so far
    bool carry = false;                             ///< ink lasts from stroke to stroke
    bool wet = false;                               ///< ink flows, mixes and dries
    bool two_inks = false;                          ///< the tip has another ink than the belly
    std::string tip_ink = "carbon";
    double tip_depth = 0.3;  ///< part of the tuft's length
    double dip_depth = 1;    ///< likewise, of Dip and Wipe
    double dip_side = 0;     ///< of the tuft's width, from the right flank (> 0) or the left; 0: all
    PaletteState palette;
    std::vector<ink::Ink> own_inks;  ///< of this work
    ColourChoice colour;             ///< chosen on the wheel, and the mix found for it
    LayerList layer_list;            ///< how the layers are listed
    std::string brush_remembered;    ///< for this model
    Appearance looks;
    bool show_colours = false;
    bool journal_fits = true, show_journal = false;  ///< beside the model; else in place of the tools, when asked for
    std::string recipe_of;                           ///< ink whose recipe is open there
    ink::Ink recipe;                                 ///< as its sliders stand
    bool hand_down = false;

    double pen_pressure = -1;  ///< of the pen now; below 0: no pen
    int pen_handle = 1;        ///< of its curve, in the hand
    KeyTable keys;
    CapSettings cap;
    std::optional<Act> key_asked;  ///< action that the next key is given to

    std::uint32_t layer =
        stroke::kFirstLayer;  ///< painted on; `kNewestLayer` while one that was asked for is not there yet
    std::vector<std::uint32_t> layers_before;  ///< painted on before one was added, the newest at the back
    std::uint32_t layer_gone = 0;              ///< painted on when it was removed; 0: none
    std::uint32_t layers_seen = 0;             ///< `LayerTable::next_id` at the last look; 0: none yet
    std::uint32_t mask = 0;                    ///< kept to; 0: none
    std::uint32_t veiled = 0;                  ///< the mask whose veil is asked for
    std::uint32_t masks_seen = 0;              ///< `MaskTable::next_id` at the last look; 0: none yet
    MaskChoice mask_choice;
    std::vector<Vec2> lasso;  ///< pixels, while it is drawn
    stroke::Fill fill;
    bool erasing = false;       ///< the stroke in the hand takes ink off
    double layer_opacity = -1;  ///< while its slider is in the hand
    bool layer_details = false;
    std::vector<StrokeLine> strokes;
    JournalState journal;
    Update last;            ///< without tiles and messages
    brush::TuftState tuft;  ///< drawn: pressed, or hovering
    double depth = 0;       ///< metres of the unbent tip below the surface
    bool pressed = false;

    References references;
    SnapshotState snapshots;
    HelpState help;

    FileDialog files;
    ExportChoice export_choice;
    bool show_export = false, show_settings = false, show_keys = false, show_about = false;
    std::string message;
    double message_time = 0;
    bool quit = false;
};

void say(Session& s, std::string message);

/// Some of the work is in memory only.
bool has_unkept_work(const Session& s);
/// Quits, closes or opens; where some work is in memory only, asks first.
void leave(Session& s, Leaving leaving);
/// Does so without asking.
void leave_at_once(Session& s, const Leaving& leaving);
/// Opens a model or a project; the work in hand is kept where it is, and asked about where it is in memory only.
void open_path(Session& s, const std::filesystem::path& path);
/// Opens a project that another program has, to look at it or to go on in a copy.
void open_in_use(Session& s, OpenAs as);
/// Opens a shipped model: its unit is known and it is sound, so nothing is asked.
void open_sample(Session& s, const std::filesystem::path& path);
/// Closes the dialog that lies on top, as its Cancel does; false when there is none.
bool close_dialog(Session& s);
/// Takes writing into the hand to be placed.
void open_writing(Session& s, const std::filesystem::path& path);
/// Takes an ink from a file; writes the one in hand to a file.
void open_ink(Session& s, const std::filesystem::path& path);
void save_ink(Session& s, const std::filesystem::path& path);
/// An ink of this work, or a shipped one; nullptr when it cannot be read.
const ink::Ink* find_ink(const Session& s, const std::string& name);
/// Adds a layer on top, which is painted on from now on.
void add_layer(Session& s, const std::string& name);
/// Pigments that strokes of the work have, as far as their inks are known.
std::vector<ink::Pigment> pigments_in_use(const Session& s);
/// Takes a mix into the hand. It becomes part of the work when something is painted with it.
void take_mix(Session& s, ink::Ink ink);
/// Makes the ink in hand part of the work, if it is a mix that is not yet.
void bring_in_colour(Session& s);
/// Chooses a colour by its hex code; the mix found for it comes into the hand.
void set_colour(Session& s, const std::string& hex);
/// Takes over a mix that was found.
void poll_colour(Session& s);
/// Metres: how wide a line a model's first brush shall draw, and the brush of that hair that does at a pressure.
double first_line_width(const Box& box);
std::string first_brush(const std::vector<std::string>& brushes, const std::string& hair_of, double pressure,
                        double width);
/// Takes the brush that a person last had in hand for this model, else one in the size of the model
/// (session_brush.cpp).
void choose_brush(Session& s);
/// Remembers the brush in hand for the next time with this model, where a person chose it.
void remember_brush(Session& s);
/// Shows the palette or puts it away. With it out, the brush keeps what is in it.
void show_palette(Session& s, bool on);
/// Takes the brush in hand in another size, times that of its make, within what there is.
void size_brush(Session& s, double factor);
/// Chooses these entries of the journal, and none else; their ink is highlighted.
void select_entries(Session& s, std::set<std::uint64_t> ids);
/// Keeps strokes to a mask and veils what it leaves out; 0: none.
void choose_mask(Session& s, std::uint32_t id);
/// Appearance at a model that shall take the place of the one in work, with its strokes.
void revise_with(Session& s, const std::filesystem::path& path);
/// Back to the project that was revised.
void open_former(Session& s);
/// Goes on from the dialog of a model that was looked at.
void accept_inspected(Session& s);
/// Takes over what threads have finished.
void poll_session(Session& s);
/// The painter's part of that.
void poll_painter(Session& s);
/// Nothing runs in the background and nothing waits.
bool settled(const Session& s);
void close_model(Session& s);
void save_as(Session& s, const std::filesystem::path& path);
/// Where the model's cut plane lies; zero when it is not cut.
Vec4f section_plane(const Session& s);
/// What the window's title and status say about the project.
std::string project_name(const Session& s);

/// Pins an image file over the view.
void pin_reference(Session& s, const std::filesystem::path& path);
/// Shows a snapshot beside the work; "": none.
void compare_with(Session& s, const std::string& snapshot);
/// Begins the guided first minute.
void start_guide(Session& s);
/// Folds both panels away, or brings them back when both are.
void fold_panels(Session& s);

void load_settings(Session& s);
void store_settings(const Session& s);

}  // namespace tuft::app
