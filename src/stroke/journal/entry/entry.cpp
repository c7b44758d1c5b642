#include "stroke/journal/entry/entry.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "core/error.h"
#include "core/overloaded.h"
#include "core/text/text.h"
#include "ink/exchange/reservoir.h"

namespace tuft::stroke {
namespace {

constexpr const char* kEntryKinds[] = {"stroke", "dip",  "rinse", "reshape", "dry", "layer",
                                       "mask",   "fill", "wipe",  "wash",    "part"};
const std::string kNoName;
const StrokeSamples kNoSamples{.flat = false};

// By reference to the member where a kind has it, else null.
template <class Entry>
auto* brush_in(Entry& entry) {
    using Name = decltype(&entry.template as<PaintStroke>()->brush);
    return std::visit(Overloaded{[](auto& named) -> Name
                                     requires requires { named.brush;
}
{ return &named.brush; }
, [](const Dry&) -> Name { return nullptr; }, [](const WashPalette&) -> Name { return nullptr; },
    [](const Fill&) -> Name { return nullptr; }, [](const LayerEdit&) -> Name { return nullptr; },
    [](const MaskEdit&) -> Name { return nullptr; }, [](const PartEdit&) -> Name { return nullptr; }
}  // namespace
,
                      entry.content);
}  // namespace tuft::stroke

template <class Entry>
auto* ink_in(Entry& entry) {
    using Name = decltype(&entry.template as<PaintStroke>()->ink);
    return std::visit(Overloaded{[](auto& named) -> Name
                                     requires requires { named.ink;
}
{ return &named.ink; }
, [](const Dry&) -> Name { return nullptr; }, [](const WashPalette&) -> Name { return nullptr; },
    [](const LayerEdit&) -> Name { return nullptr; }, [](const MaskEdit&) -> Name { return nullptr; },
    [](const PartEdit&) -> Name { return nullptr; }
},
                      entry.content);
}

}  // namespace

EntryKind kind_of(const EntryContent& content) {
    return std::visit(
        Overloaded{[](const PaintStroke&) { return EntryKind::stroke; },
                   [](const BrushAction& action) { return entry_kind_of(action.what); },
                   [](const Dry&) { return EntryKind::dry; }, [](const WashPalette&) { return EntryKind::wash; },
                   [](const Fill&) { return EntryKind::fill; }, [](const LayerEdit&) { return EntryKind::layer; },
                   [](const MaskEdit&) { return EntryKind::mask; }, [](const PartEdit&) { return EntryKind::part; }},
        content);
}

std::string name_of(EntryKind kind) {
    return kEntryKinds[static_cast<std::size_t>(kind)];
}

EntryKind entry_kind_of(const std::string& name) {
    const auto at = std::find(std::begin(kEntryKinds), std::end(kEntryKinds), name);
    if (at != std::end(kEntryKinds)) return static_cast<EntryKind>(at - std::begin(kEntryKinds));
    throw Error(
        Message("'{}' is no action of a brush; there are stroke, dip, rinse, reshape, dry, layer, mask, fill, wipe, "
                "wash and part",
                excerpt(name)));
}

EntryKind entry_kind_of(const BrushChange& change) {
    return std::visit(
        Overloaded{[](const Dip&) { return EntryKind::dip; }, [](const Wipe&) { return EntryKind::wipe; },
                   [](const Rinse&) { return EntryKind::rinse; }, [](const Reshape&) { return EntryKind::reshape; }},
        change);
}

BrushChange change_of(EntryKind kind) {
    for (const BrushChange& change :
         {BrushChange(Dip{}), BrushChange(Wipe{}), BrushChange(Rinse{}), BrushChange(Reshape{})})
        if (entry_kind_of(change) == kind) return change;
    throw Error(Message("'{}' is nothing that is done with a brush alone", name_of(kind)));
}

bool has_brush(EntryKind kind) {
    return kind == EntryKind::stroke || kind == EntryKind::dip || kind == EntryKind::wipe || kind == EntryKind::rinse ||
           kind == EntryKind::reshape;
}

bool keeps_texels(EntryKind kind) {
    return kind == EntryKind::layer || kind == EntryKind::mask || kind == EntryKind::part;
}

const std::string& brush_of(const JournalEntry& entry) {
    const std::string* brush = brush_in(entry);
    return brush ? *brush : kNoName;
}

const std::string& ink_of(const JournalEntry& entry) {
    const std::string* ink = ink_in(entry);
    return ink ? *ink : kNoName;
}

void set_brush(JournalEntry& entry, const std::string& brush) {
    if (std::string* own = brush_in(entry)) *own = brush;
}

void set_ink(JournalEntry& entry, const std::string& ink) {
    if (std::string* own = ink_in(entry)) *own = ink;
    if (Fill* fill = entry.as<Fill>(); fill && fill->area)
        for (AreaStop& stop : fill->area->stops) stop.ink = ink;
}

std::uint64_t seed_of(const JournalEntry& entry) {
    if (const PaintStroke* stroke = entry.as<PaintStroke>()) return stroke->seed;
    if (const BrushAction* action = entry.as<BrushAction>()) return action->seed;
    return 0;
}

std::uint32_t layer_of(const JournalEntry& entry) {
    if (const PaintStroke* stroke = entry.as<PaintStroke>()) return stroke->layer;
    if (const Fill* fill = entry.as<Fill>()) return fill->layer;
    return kFirstLayer;
}

std::uint32_t mask_of(const JournalEntry& entry) {
    if (const PaintStroke* stroke = entry.as<PaintStroke>()) return stroke->mask;
    if (const Fill* fill = entry.as<Fill>()) return fill->mask;
    return 0;
}

const StrokeSamples& samples_of(const JournalEntry& entry) {
    const PaintStroke* stroke = entry.as<PaintStroke>();
    return stroke ? stroke->trace : kNoSamples;
}

std::vector<std::string> inks_of(const JournalEntry& entry) {
    std::vector<std::string> inks;
    const PaintStroke* stroke = entry.as<PaintStroke>();
    if (const std::string& ink = ink_of(entry); !ink.empty() && !(stroke && stroke->erases())) inks.push_back(ink);
    const Fill* fill = entry.as<Fill>();
    if (fill && !fill->to_ink.empty()) inks.push_back(fill->to_ink);
    if (fill && fill->area)
        for (std::size_t i = 1; i < fill->area->stops.size(); ++i) inks.push_back(fill->area->stops[i].ink);
    return inks;
}

void check_seconds(double seconds) {
    if (!(seconds >= 0 && seconds <= kLongestWait))
        throw Error(Message("ink dries for 0 to {} seconds", static_cast<int>(kLongestWait)));
}

std::string group_name(const std::filesystem::path& file) {
    std::string name = file.filename().string();
    const auto readable = [](const std::string& text) {
        try {
            check_name(text, "group");
            return true;
        } catch (const Error&) {
            return false;
        }
    };
    if (name.size() > kMaxNameBytes) {
        name.resize(kMaxNameBytes);
        for (int i = 0; i < 4 && !readable(name); ++i) name.pop_back();  // the rest of a character
    }
    if (readable(name)) return name;
    for (char& c : name)
        if (static_cast<unsigned char>(c) < 0x20 || static_cast<unsigned char>(c) >= 0x7f) c = '?';
    return name.empty() ? "?" : name;
}

JournalEntry entry_after(std::span<const JournalEntry> entries, EntryContent content) {
    JournalEntry entry;
    for (const JournalEntry& e : entries) entry.id = std::max(entry.id, e.id);
    ++entry.id;
    entry.content = std::move(content);
    return entry;
}

}  // namespace tuft::stroke
