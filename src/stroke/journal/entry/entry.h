#pragma once

#include <concepts>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "stroke/journal/entry/brush_action.h"
#include "stroke/journal/entry/fill.h"
#include "stroke/journal/entry/layers.h"
#include "stroke/journal/entry/mask.h"
#include "stroke/journal/entry/parts.h"
#include "stroke/journal/entry/samples.h"
#include "stroke/journal/entry/settings.h"

/// \file
/// Entries of the journal: a common header, and one plain struct per kind. `Document` performs them; projects and
/// stroke files store them. `std::visit` with `Overloaded` (core/overloaded.h) does not compile where a kind is
/// forgotten.
namespace tuft::stroke {

/// What a stroke does to the ink.
enum class Tool {
    brush,
    eraser,  ///< removes ink, wet and dry, where a brush would leave some
};

/// A stroke over the model or the palette.
struct PaintStroke {
    StrokeSamples trace;
    std::string brush, ink;  ///< names of presets
    std::uint64_t seed = 0;  ///< of the hair of a fresh brush
    Tool tool = Tool::brush;
    std::uint32_t layer = kFirstLayer;  ///< id of the layer painted on, or `kPaletteLayer`
    std::uint32_t mask = 0;             ///< id of the mask it stays within; 0: none
    StrokeSettings settings;
    PlaceNames names;  ///< of a stroke file, until `layer` and `mask` are set

    bool erases() const { return tool == Tool::eraser; }
};

/// All layers flow and dry for a while.
struct Dry {
    double seconds = 0;   ///< 0: until everything is dry
    Vec3 down{0, 0, -1};  ///< direction of gravity, any length; zero: no weight
};

/// Removes all ink from the palette.
struct WashPalette {};

using EntryContent = std::variant<PaintStroke, BrushAction, Dry, WashPalette, Fill, LayerEdit, MaskEdit, PartEdit>;

template <class T, class Variant>
inline constexpr bool kIsAlternative = false;
template <class T, class... Kinds>
inline constexpr bool kIsAlternative<T, std::variant<Kinds...>> = (std::same_as<T, Kinds> || ...);

template <class T>
concept IsEntryContent = kIsAlternative<T, EntryContent>;

/// Entries that belong together, such as the strokes of one drawing. The studio lists, hides, moves, changes and
/// deletes them as one.
struct EntryGroup {
    std::uint64_t id = 0;  ///< unique among the groups of its journal; 0: no group
    std::string name;      ///< for people, such as the name of the drawing's file; the same in all entries of the group

    bool operator==(const EntryGroup&) const = default;
};

/// An entry: header and content.
struct JournalEntry {
    std::uint64_t id = 0;  ///< unique in its journal, never reused; set by `Journal::append`
    bool hidden = false;   ///< stored, but not performed
    std::string label;     ///< free text for people
    EntryGroup group;
    EntryContent content;

    JournalEntry() = default;
    template <IsEntryContent Content>
    JournalEntry(Content what, std::string text = {}) : label(std::move(text)), content(std::move(what)) {}

    /// Returns the content where it is of this kind, else null.
    template <IsEntryContent Content>
    Content* as() {
        return std::get_if<Content>(&content);
    }
    template <IsEntryContent Content>
    const Content* as() const {
        return std::get_if<Content>(&content);
    }
    /// Returns the content, which must be of this kind.
    template <IsEntryContent Content>
    Content& get() {
        return std::get<Content>(content);
    }
    template <IsEntryContent Content>
    const Content& get() const {
        return std::get<Content>(content);
    }
};

/// Kind of an entry as files, lists and the command line name it.
enum class EntryKind { stroke, dip, rinse, reshape, dry, layer, mask, fill, wipe, wash, part };

/// Return the kind of a content and of an entry.
EntryKind kind_of(const EntryContent& content);
inline EntryKind kind_of(const JournalEntry& entry) {
    return kind_of(entry.content);
}
/// Returns the kind as a word, the name of its constant, and back. Back throws `Error` for any other word.
std::string name_of(EntryKind kind);
EntryKind entry_kind_of(const std::string& name);
EntryKind entry_kind_of(const BrushChange& change);
/// Returns the change of this kind with its usual numbers; throws `Error` for a kind that is none.
BrushChange change_of(EntryKind kind);

/// Whether entries of this kind name a brush.
bool has_brush(EntryKind kind);
/// Whether entries of this kind change no texel.
bool keeps_texels(EntryKind kind);

/// Return the brush, ink or seed of an entry; empty, or 0, for kinds without.
const std::string& brush_of(const JournalEntry& entry);
const std::string& ink_of(const JournalEntry& entry);
std::uint64_t seed_of(const JournalEntry& entry);
/// Set another brush or ink; no effect on kinds without.
void set_brush(JournalEntry& entry, const std::string& brush);
void set_ink(JournalEntry& entry, const std::string& ink);
/// Return the id of the layer (or `kPaletteLayer`) and of the mask of a stroke or fill; for other kinds `kFirstLayer`
/// and 0.
std::uint32_t layer_of(const JournalEntry& entry);
std::uint32_t mask_of(const JournalEntry& entry);
inline bool on_palette(const JournalEntry& entry) {
    return layer_of(entry) == kPaletteLayer;
}
/// Returns the samples of a stroke; no samples, in space, for other kinds.
const StrokeSamples& samples_of(const JournalEntry& entry);
/// Returns the names of all inks that an entry uses.
std::vector<std::string> inks_of(const JournalEntry& entry);

/// Throws `Error` for a drying time that is negative, not finite or too long.
void check_seconds(double seconds);

/// Returns a file's name as the name of a group: UTF-8 of at most `kMaxNameBytes`, with '?' for bytes that are no text.
std::string group_name(const std::filesystem::path& file);

/// Returns an entry with an id that none of these has.
JournalEntry entry_after(std::span<const JournalEntry> entries, EntryContent content);

}  // namespace tuft::stroke
