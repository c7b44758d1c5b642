#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "stroke/journal/entry.h"

/// \file
/// Entries as files store them: some columns of their own, everything else as one line of JSON. Readers throw `Error`
/// for wrong types and values.
namespace tuft::stroke {

/// What a file stores of an entry beside its JSON.
struct EntryColumns {
    std::uint64_t id = 0;
    bool hidden = false;
    std::string brush, ink, label;
    std::uint64_t seed = 0;
    StrokeSamples trace;  ///< without stencil, which is in the JSON
};

/// The keys of `StrokeSettings`, which all kinds write, and those of the kind.
std::string entry_json(const JournalEntry& entry);
JournalEntry entry_of(EntryColumns columns, const std::string& json);

/// Three numbers.
nlohmann::json json_of(const Vec3& v);
Vec3 vector_of(const nlohmann::json& json);

/// A whole number from 0 to `kNone` - 1, the number `name` of a thing. nlohmann's own conversion from 1e300 is
/// undefined.
std::uint32_t number_of(const nlohmann::json& json, const char* name);

nlohmann::json json_of(const StrokeSettings& settings);
StrokeSettings settings_of(const nlohmann::json& json);

nlohmann::json json_of(const LayerEdit& edit);
LayerEdit layer_edit_of(const nlohmann::json& json);

nlohmann::json json_of(const Fill& fill);
Fill fill_of(const nlohmann::json& json);

nlohmann::json json_of(const MaskEdit& edit);
MaskEdit mask_edit_of(const nlohmann::json& json);

}  // namespace tuft::stroke
