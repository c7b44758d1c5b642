#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <future>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "app/document/pictures/small_picture.h"
#include "core/message.h"
#include "io/project/attachments.h"
#include "writer/text/text.h"

/// \file
/// A character copied from a picture, while a person corrects its strokes. Part of a text that is written
/// (lettering.h). Window thread.
namespace tuft::app {

/// What a click on a stroke does.
enum class CopyEdit { reverse, join, split, remove };

/// A stroke while it is dragged to another place in the order.
struct StrokeDrag {
    std::size_t stroke = 0;  ///< where it is now
    bool moved = false;      ///< there is a step to take back
};

/// The strokes that are shown and edited.
struct CopyInWork {
    std::optional<writer::CopiedPicture> shown;  ///< as it was read last, with the edits since
    writer::CopyCorrection shown_for;            ///< that `shown` follows from
    SmallPicture picture;
    unsigned texture = 0;                         ///< OpenGL name of the picture; 0: none yet
    bool fresh = false;                           ///< the texture is to be made anew
    std::vector<writer::CopyCorrection> earlier;  ///< corrections before each step, the last one last
    bool slides = false;                          ///< the last step is a slide of the threshold that goes on
    CopyEdit edit = CopyEdit::reverse;
    std::optional<std::size_t> joined;  ///< stroke of `shown` that another one is to be joined to
    std::optional<StrokeDrag> dragged;  ///< stroke of `shown` that is moved in the order

    /// Lets go of strokes: their numbers mean others from now on.
    void let_go() { joined.reset(), dragged.reset(), slides = false; }
    /// Takes what a correction was read as. Strokes in the hand stay there where it shows the same.
    void take(std::optional<writer::CopiedPicture> read, const writer::CopyCorrection& correction);
};

/// A copy and the request that says it.
struct CopyToEdit {
    CopyInWork& copy;
    writer::TextRequest& request;

    /// Whether what is shown is what the request says; else it is being read.
    bool ready() const { return copy.shown && copy.shown_for == request.correction; }
};

/// Edits do nothing while the copy is not `ready`.
/// Does what `copy.edit` says at a point of the character's square, units. A click farther than 60 units from all
/// strokes does nothing, nor does a split within `writer::kJointReach` of a stroke's end; the last stroke is not
/// removed.
void edit_stroke(const CopyToEdit& c, const Vec2& at);
/// Moves the dragged stroke to a place in the order; all moves of a drag are one step. A stroke that is not there is
/// let go.
void drag_stroke(const CopyToEdit& c, std::size_t to);
/// Goes one step back. Returns false when there is none.
bool step_back(const CopyToEdit& c);
/// Sets the correction, as a step of its own where it differs; the picture is taken apart anew.
void correct(const CopyToEdit& c, writer::CopyCorrection correction);
/// Sets the threshold, rounded as `copy_words` states it, and drops what corrected the strokes of another one. One step
/// until `copy.slides` is reset.
void slide_threshold(const CopyToEdit& c, double threshold);

/// A copied character that a project keeps: the picture's file and its correction.
struct KeptCopy {
    std::string id;              ///< of the picture's bytes
    std::filesystem::path file;  ///< where the picture was
    std::vector<char> bytes;     ///< of the picture's file
    std::string name;            ///< the character, or empty
    writer::CopyCorrection correction;
    std::optional<std::filesystem::file_time_type> read_at;  ///< when `file` was written, where `bytes` are of it

    /// Whether a project that keeps this one keeps that one.
    bool has_same_content(const KeptCopy& other) const {
        return id == other.id && file == other.file && name == other.name && correction == other.correction;
    }
};

/// Converts a kept copy to its attachment and back. `kept_copy` ignores unknown fields; of a damaged line it keeps the
/// picture.
io::Attachment to_attachment(const KeptCopy& copy);
KeptCopy kept_copy(const io::Attachment& attachment);

/// Returns the copy of a request, to be kept. Throws `Error` where the picture's file cannot be read or is larger than
/// 24 MB. Cost: reads the file.
KeptCopy read_copy(const writer::TextRequest& request);
/// Returns a file with the picture: where it was, if the same bytes are there, else one of the same name in the state
/// folder that is written now. Throws `Error` where it cannot be written.
std::filesystem::path picture_of(const KeptCopy& copy);

/// Reads pictures that a project is to keep, on a thread of its own. Window thread.
class CopyReader {
  public:
    struct Read {
        std::optional<KeptCopy> copy;
        io::Attachment attachment;  ///< of it
        Message fault;              ///< why there is none
    };
    /// Reads the copy of a request, except where the last one asked for is the same and is being read, or nothing is
    /// read and `kept` has it; in both cases as its file is now.
    void read(const writer::TextRequest& request, std::span<const KeptCopy> kept);
    /// Returns what was read, once each; nothing where there is none yet.
    std::optional<Read> poll();
    void wait() const;
    bool busy() const { return reading_.valid(); }

  private:
    struct CopyRequest {
        writer::TextRequest request;
        std::optional<std::filesystem::file_time_type> time;  ///< of the picture's file when it was asked for
        bool operator==(const CopyRequest&) const = default;
    };
    void begin();

    std::deque<CopyRequest> wanted_;
    CopyRequest asked_;  ///< the last one
    std::future<Read> reading_;
};

/// Returns the options of `tuft write` that make the same copy.
std::string copy_words(const writer::TextRequest& request);

}  // namespace tuft::app
