#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "stroke/journal/layers.h"
#include "stroke/journal/mask.h"
#include "stroke/journal/trace.h"

/// The document: what the hand did, in order. Texels are made from it.
namespace tuft::stroke {

/// How strokes become texels. Part of the journal, so that a replay is the same.
struct Settings {
    std::string spine = "rod";          ///< rod | table
    std::string footprint = "surface";  ///< surface | plane
    std::string contact = "exact";      ///< exact | vertices
    double spacing = 1.0;               ///< texels between two stamps
    bool compensate_tip_lag = true;     ///< flat traces: the hand runs ahead so that the ink lies on them
    std::string dip = "each";           ///< each: every stroke with a fresh full brush | carry: with
                                        ///< the hair and ink that the last one with it left
    bool endless = false;               ///< the ink that leaves the tuft is replaced at once, and what it takes up from
                                        ///< the surface is gone: it paints as full as it began
    std::string pressure = "none";      ///< flat traces: none (as sampled) | speed | dwell | speed+dwell
    double smooth = 0;                  ///< strength of the hand's filter; 0: off, 1: its defaults
    std::string film = "still";         ///< still: ink stays where it is put | wet: it flows, soaks in
                                        ///< and dries, and goes both ways between brush and surface
    Vec3 down{0, 0, -1};                ///< towards the ground, for wet ink; zero: no weight
    double stabilise = 0;               ///< metres of the string that pulls the tip; 0: off

    bool operator==(const Settings&) const = default;
};

/// Settings as one line of JSON, and back; unknown keys are ignored, wrong types and values
/// throw `Error`.
std::string to_json(const Settings& settings);
Settings settings_from_json(const std::string& json);
/// Throws `Error` for a word or a number that means nothing.
void check_settings(const Settings& settings);
/// Throws `Error` for a time that ink cannot dry for.
void check_seconds(double seconds);
void check_extent(const Extent& extent, Action action);
/// Throws `Error` for samples, a placement or stencil edge that no hand can have made: numbers that are not finite,
/// places beyond `kFarthest`, times beyond three years, pressures and tilts out of range, rotations and directions that
/// are none.
void check_trace(const Trace& trace);

/// Entries that belong together, such as the strokes of one drawing: they are listed, hidden, moved, changed and
/// deleted as one.
struct EntryGroup {
    std::uint64_t id = 0;  ///< of no other group in its journal; 0: none
    std::string name;      ///< for people, such as the drawing's file; the same in all entries of the group

    bool operator==(const EntryGroup&) const = default;
};
/// A file's name as a name of a group: UTF-8 of at most `kMaxNameBytes`, what is no readable text replaced by '?'.
std::string group_name(const std::filesystem::path& file);

/// An entry of the journal: a stroke, or an action between strokes. An action has no samples;
/// it names a brush, and for a dip the ink. Drying, fills and changes of layers and masks leave the brush
/// as it is and need not name one.
struct Stroke {
    std::uint64_t id = 0;  ///< unique in its journal, never used again
    Trace trace;           ///< with the names of its brush and ink filled in
    Settings settings;
    bool hidden = false;  ///< kept, but not painted
    Action action = Action::stroke;
    double seconds = 0;                 ///< of `Action::dry`; 0: until all is dry
    std::uint32_t layer = kFirstLayer;  ///< that is painted on, or `kPaletteLayer`
    std::uint32_t mask = 0;             ///< that a stroke or fill keeps to; 0: none
    LayerEdit edit = {};                ///< of `Action::layer`
    MaskEdit mask_edit = {};            ///< of `Action::mask`
    Fill fill = {};                     ///< of `Action::fill`, which names its first ink as strokes do
    Extent extent = {};                 ///< of a dip or a wipe
    EntryGroup group = {};              ///< that it belongs to
};

/// The settings of an entry as above, with the entry's action, seconds and extent as more keys.
std::string entry_json(const Stroke& entry);
void read_entry_json(const std::string& json, Stroke& entry);

/// "stroke", "dip", "rinse", "reshape", "dry", "layer", "mask", "fill", "wipe", "wash"; and back, throwing `Error`
/// for any other word.
std::string name_of(Action action);
Action action_of(const std::string& name);

/// Whether an entry with this action has a brush in it.
bool has_brush(Action action);
/// Whether an entry with this action leaves all texels as they are.
bool keeps_texels(Action action);
/// Names of the inks that an entry uses.
std::vector<std::string> inks_of(const Stroke& entry);

/// An action to be appended to these entries: with an id that none of them has.
Stroke action_after(const std::vector<Stroke>& entries, Action action);

/// Strokes in the order in which they are painted, with undo and redo.
class Journal {
  public:
    /// Appends a stroke (its id is set here); what could be redone is gone.
    const Stroke& append(Stroke stroke);
    /// Puts a stroke back as it was stored, id kept.
    void restore(Stroke stroke);
    /// Takes the last stroke off, to be put back by `redo`; false when there is none.
    bool undo();
    bool redo();
    /// Entries that `redo` shall bring back, the next one last; of a journal that this one takes the place of.
    void restore_undone(std::vector<Stroke> undone) { undone_ = std::move(undone); }
    const std::vector<Stroke>& undone() const { return undone_; }
    bool can_undo() const { return !strokes_.empty(); }
    bool can_redo() const { return !undone_.empty(); }

    /// The id that the next appended entry gets.
    std::uint64_t next_id() const { return next_id_; }
    /// An id that no group of this journal has.
    std::uint64_t next_group_id() const;

    const std::vector<Stroke>& strokes() const { return strokes_; }
    bool empty() const { return strokes_.empty(); }

  private:
    std::vector<Stroke> strokes_;
    std::vector<Stroke> undone_;  ///< last undone at the back
    std::uint64_t next_id_ = 1;
};

}  // namespace tuft::stroke
