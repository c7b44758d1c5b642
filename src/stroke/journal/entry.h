#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "stroke/journal/fill.h"
#include "stroke/journal/layers.h"
#include "stroke/journal/mask.h"
#include "stroke/journal/samples.h"
#include "stroke/journal/settings.h"

/// \file
/// Entries of the journal: a common header, and one plain struct for each kind. `std::visit` with `Overloaded`
/// (core/overloaded.h) does not compile where a kind is forgotten.
namespace tuft::stroke {

enum class Tool {
    brush,
    eraser,  ///< takes ink away, wet and dry, where a brush would leave some
};

/// A stroke over the model or the palette.
struct PaintStroke {
    StrokeSamples trace;
    std::string brush, ink;  ///< presets
    std::uint64_t seed = 0;  ///< of the hair of a fresh brush
    Tool tool = Tool::brush;
    std::uint32_t layer = kFirstLayer;  ///< that is painted on, or `kPaletteLayer`
    std::uint32_t mask = 0;             ///< that it keeps to; 0: none
    StrokeSettings settings;
    PlaceNames names;  ///< as its file says, until it has a layer and a mask

    bool erases() const { return tool == Tool::eraser; }
};

enum class BrushActionKind {
    dip,      ///< fills the tuft up with ink; what is in it stays and mixes
    wipe,     ///< draws it over a rag: part of its ink goes
    rinse,    ///< washes it: no ink left, hair straight and together
    reshape,  ///< combs it: hair straight and together, ink stays
};

/// How far a brush is dipped, or wiped.
struct Extent {
    double depth = 1;   ///< part of the tuft's length, from the tip, 0–1
    double amount = 1;  ///< dip: part of its room up to which hair is filled, 0–1.5, above 1 dripping wet:
                        ///< the rest runs down onto what wet ink touches; wipe: part of its ink that goes, 0–1
    double side = 0;    ///< part of the tuft's width, from the right flank (> 0) or the left one (< 0), −1–1;
                        ///< 0: all of it. Right is the side of the ferrule's +x, of the stroke's right hand
                        ///< edge where that is drawn away from the hand

    bool operator==(const Extent&) const = default;
};

/// Something done with a brush between two strokes.
struct BrushAction {
    BrushActionKind kind = BrushActionKind::dip;
    std::string brush;                                   ///< preset; in a file empty: that of the stroke after it
    std::string ink;                                     ///< to dip into, and of a brush that is fresh; in a file
                                                         ///< empty: that of the stroke after it
    Extent extent;                                       ///< 1, 1, 0 for what is neither dipped nor wiped
    std::uint64_t seed = 0;                              ///< of the hair of a fresh brush
    DipMode dip = DipMode::each;                         ///< whether it begins with a fresh brush
    brush::SpineMethod spine = brush::SpineMethod::rod;  ///< of a fresh brush, as in `StrokeSettings`
};

/// The ink on all layers flows and dries.
struct Dry {
    double seconds = 0;   ///< 0: until all is dry
    Vec3 down{0, 0, -1};  ///< towards the ground; zero: no weight
};

/// The palette is washed clean.
struct WashPalette {};

using EntryContent = std::variant<PaintStroke, BrushAction, Dry, WashPalette, Fill, LayerEdit, MaskEdit>;

template <class T, class Variant>
inline constexpr bool kIsAlternative = false;
template <class T, class... Kinds>
inline constexpr bool kIsAlternative<T, std::variant<Kinds...>> = (std::same_as<T, Kinds> || ...);

template <class T>
concept IsEntryContent = kIsAlternative<T, EntryContent>;

/// Entries that belong together, such as the strokes of one drawing: they are listed, hidden, moved, changed and
/// deleted as one.
struct EntryGroup {
    std::uint64_t id = 0;  ///< of no other group in its journal; 0: none
    std::string name;      ///< for people, such as the drawing's file; the same in all entries of the group

    bool operator==(const EntryGroup&) const = default;
};

struct JournalEntry {
    std::uint64_t id = 0;  ///< unique in its journal, never used again
    bool hidden = false;   ///< kept, but not painted
    std::string label;     ///< free text for people: a character, a stroke's name
    EntryGroup group;      ///< that it belongs to
    EntryContent content;

    JournalEntry() = default;
    template <IsEntryContent Content>
    JournalEntry(Content what, std::string text = {}) : label(std::move(text)), content(std::move(what)) {}

    /// The content where it is of this kind, else null.
    template <IsEntryContent Content>
    Content* as() {
        return std::get_if<Content>(&content);
    }
    template <IsEntryContent Content>
    const Content* as() const {
        return std::get_if<Content>(&content);
    }
    /// The content, which must be of this kind.
    template <IsEntryContent Content>
    Content& get() {
        return std::get<Content>(content);
    }
    template <IsEntryContent Content>
    const Content& get() const {
        return std::get<Content>(content);
    }
};

/// What an entry is called in files, lists and on the command line.
enum class EntryKind { stroke, dip, rinse, reshape, dry, layer, mask, fill, wipe, wash };

EntryKind kind_of(const EntryContent& content);
inline EntryKind kind_of(const JournalEntry& entry) {
    return kind_of(entry.content);
}
/// "stroke", "dip", "rinse", "reshape", "dry", "layer", "mask", "fill", "wipe", "wash"; and back, throwing `Error`
/// for any other word.
std::string name_of(EntryKind kind);
EntryKind entry_kind_of(const std::string& name);
EntryKind entry_kind_of(BrushActionKind kind);
/// The action of this kind; throws `Error` for what is done with no brush.
BrushActionKind brush_action_of(EntryKind kind);

/// Whether an entry of this kind has a brush in it.
bool has_brush(EntryKind kind);
/// Whether an entry of this kind leaves all texels as they are.
bool keeps_texels(EntryKind kind);

/// The brush, ink or seed that an entry names; empty, or 0, for kinds that have none.
const std::string& brush_of(const JournalEntry& entry);
const std::string& ink_of(const JournalEntry& entry);
std::uint64_t seed_of(const JournalEntry& entry);
/// Gives it another one; nothing for kinds that have none.
void set_brush(JournalEntry& entry, const std::string& brush);
void set_ink(JournalEntry& entry, const std::string& ink);
/// Layer, or `kPaletteLayer`, that is painted on, and the mask kept to, of strokes and fills; else the first layer, 0.
std::uint32_t layer_of(const JournalEntry& entry);
std::uint32_t mask_of(const JournalEntry& entry);
inline bool on_palette(const JournalEntry& entry) {
    return layer_of(entry) == kPaletteLayer;
}
/// Of a stroke; empty samples in space for other kinds.
const StrokeSamples& samples_of(const JournalEntry& entry);
/// Names of the inks that an entry uses.
std::vector<std::string> inks_of(const JournalEntry& entry);

/// Throws `Error` for a time that ink cannot dry for.
void check_seconds(double seconds);
void check_extent(const Extent& extent, BrushActionKind kind);

/// A file's name as a name of a group: UTF-8 of at most `kMaxNameBytes`, what is no readable text replaced by '?'.
std::string group_name(const std::filesystem::path& file);

/// An entry to be appended to these: with an id that none of them has.
JournalEntry entry_after(std::span<const JournalEntry> entries, EntryContent content);

}  // namespace tuft::stroke
