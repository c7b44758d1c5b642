#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/message.h"
#include "stroke/journal/journal.h"

/// \file
/// Attachments of a project: reference images and snapshots, the named states of the journal. Called by the studio's
/// paint thread and by `cli`.
namespace tuft::io {

inline constexpr const char* kReferences = "reference";     ///< kind: `about` is JSON, `bytes` an image file
inline constexpr const char* kSnapshots = "snapshot";       ///< kind: `about` is JSON, `bytes` of `pack_entries`
inline constexpr const char* kCopies = "copied character";  ///< kind: `about` is JSON, `bytes` an image file
inline constexpr std::size_t kMostAttachments = 200;        ///< of a kind
inline constexpr std::size_t kMostAttachmentBytes = std::size_t{256} << 20;  ///< of one

/// Named bytes in a project.
struct Attachment {
    std::string name;   ///< unique within its kind; attachments of a kind are sorted by name
    std::string about;  ///< a line of text, at most 64 KiB
    std::vector<char> bytes;

    bool operator==(const Attachment&) const = default;
};

/// Compresses journal entries, and reads them back bit by bit. Any thread. `unpack_entries` checks sizes before it
/// takes memory. It throws `Error` naming `what` for damaged bytes.
std::vector<char> pack_entries(std::span<const stroke::JournalEntry> entries);
std::vector<stroke::JournalEntry> unpack_entries(std::span<const char> bytes, const Message& what);

}  // namespace tuft::io
