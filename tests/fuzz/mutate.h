#pragma once

#include <cstdint>
#include <vector>

namespace tuft::fuzz {

/// An input made from one of `seeds` by a few edits: bytes and bits changed, parts cut out, doubled
/// or taken from another seed, words of file formats and numbers at the edge put in, and, for
/// `text`, numbers replaced. The same for the same `number` on every machine. Never longer than 64
/// KiB.
std::vector<std::uint8_t> mutated(const std::vector<std::vector<std::uint8_t>>& seeds, std::uint64_t number, bool text);

}  // namespace tuft::fuzz
