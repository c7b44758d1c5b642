#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "ink/colour/pigments.h"

/// \file
/// State of a model's parts: visibility, lock and substrate. A part is a named group of the mesh, that is an object or
/// material of its file. Stored by name, which holds for any atlas and any revised mesh; `PartSet` applies it.
namespace tuft::stroke {

/// State of one part. The defaults are those of a part that no table names.
struct Part {
    std::string name;     ///< of a group of the mesh
    bool hidden = false;  ///< as if it were not there: it is not seen, not touched and gets no ink
    bool locked = false;  ///< it is touched, but its ink stays as it is
    std::optional<ink::Substrate> substrate = {};  ///< nothing: the document's

    /// Whether its state is that of a part that no table names.
    bool is_plain() const { return !hidden && !locked && !substrate; }
    bool operator==(const Part& other) const;
};

/// States of the model's parts.
struct PartTable {
    std::vector<Part> parts;  ///< those that are not plain, ascending by name

    const Part* find(std::string_view name) const;
    /// Returns the state of a part: that of the table, or a plain one.
    Part state_of(const std::string& name) const;
    bool operator==(const PartTable&) const = default;
};

/// New states of parts. Parts that it does not name stay as they are.
struct PartEdit {
    std::vector<Part> parts;

    bool operator==(const PartEdit&) const = default;
};

/// Carries the edit out. Throws `Error` and changes nothing for an edit without parts, a name that is empty, too long
/// or stated twice, and more than `kMaxParts` parts in the table.
void apply(PartTable& table, const PartEdit& edit);

inline constexpr std::size_t kMaxParts = 100000;
inline constexpr std::size_t kMaxPartSubstrates = 64;  ///< different substrates of the parts of one model

/// Return the edit that gives these parts a state, else as `table` says.
PartEdit hidden_parts(const PartTable& table, const std::vector<std::string>& names, bool hidden);
PartEdit locked_parts(const PartTable& table, const std::vector<std::string>& names, bool locked);
/// Nothing: the document's substrate.
PartEdit parts_of_substrate(const PartTable& table, const std::vector<std::string>& names,
                            const std::optional<ink::Substrate>& substrate);
/// Returns the edit that shows `names` and hides all other parts of `all`.
PartEdit isolated_parts(const PartTable& table, const std::vector<std::string>& all,
                        const std::vector<std::string>& names);

/// Whether all parts have the same substrates in two tables.
bool have_same_substrates(const PartTable& a, const PartTable& b);

/// Returns the edit without parts whose state is that of `table` already.
PartEdit changes_only(const PartTable& table, PartEdit edit);

}  // namespace tuft::stroke
