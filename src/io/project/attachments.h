#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/message.h"
#include "stroke/journal/journal.h"

/// What a project carries besides the model and its journal: reference images, named states of the journal.
namespace tuft::io {

inline constexpr const char* kReferences = "reference";  ///< kind: `about` is JSON, `bytes` an image file
inline constexpr const char* kSnapshots = "snapshot";    ///< kind: `about` is JSON, `bytes` of `pack_entries`
inline constexpr std::size_t kMostAttachments = 200;     ///< of a kind
inline constexpr std::size_t kMostAttachmentBytes = std::size_t{256} << 20;

struct Attachment {
    std::string name;   ///< of no other one of its kind; the order of a kind is that of names
    std::string about;  ///< a line of text, at most 64 KiB
    std::vector<char> bytes;

    bool operator==(const Attachment&) const = default;
};

/// Entries of a journal as compressed bytes, and back, every number to the bit. `unpack_entries` throws `Error` naming
/// `what` for bytes that are damaged, before it takes memory for them.
std::vector<char> pack_entries(std::span<const stroke::JournalEntry> entries);
std::vector<stroke::JournalEntry> unpack_entries(std::span<const char> bytes, const Message& what);

}  // namespace tuft::io
