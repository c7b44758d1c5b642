#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "stroke/journal/entry/entry.h"

/// \file
/// Entries as projects store them: some columns, everything else as one line of JSON. Readers throw `Error` for wrong
/// types and values.
namespace tuft::stroke {

/// Columns of an entry beside its JSON.
struct EntryColumns {
    std::uint64_t id = 0;
    bool hidden = false;
    std::string brush, ink, label;
    std::uint64_t seed = 0;
    StrokeSamples trace;  ///< without its stencil, which is in the JSON
};

/// Returns the JSON of an entry: the keys of `StrokeSettings`, which every kind writes, and those of its kind.
/// `entry_of` is the inverse.
std::string entry_json(const JournalEntry& entry);
JournalEntry entry_of(EntryColumns columns, const std::string& json);

/// A vector as an array of three numbers.
nlohmann::json json_of(const Vec3& v);
Vec3 vector_of(const nlohmann::json& json);

/// Returns an integer from 0 to `kNone` − 1; errors call it `name`. nlohmann's own conversion of 1e300 is undefined.
std::uint32_t number_of(const nlohmann::json& json, const char* name);

/// Convert settings and edits to JSON and back. Missing keys have their defaults; unknown keys are ignored.
nlohmann::json json_of(const StrokeSettings& settings);
StrokeSettings settings_of(const nlohmann::json& json);

nlohmann::json json_of(const LayerEdit& edit);
LayerEdit layer_edit_of(const nlohmann::json& json);

nlohmann::json json_of(const Fill& fill);
Fill fill_of(const nlohmann::json& json);

nlohmann::json json_of(const MaskEdit& edit);
MaskEdit mask_edit_of(const nlohmann::json& json);

nlohmann::json json_of(const PartEdit& edit);
PartEdit part_edit_of(const nlohmann::json& json);

}  // namespace tuft::stroke
