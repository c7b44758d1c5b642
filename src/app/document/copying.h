#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/document/pictures/small_picture.h"
#include "io/project/attachments.h"
#include "writer/text/text.h"

/// \file
/// A character copied from a picture, while a person corrects its strokes. Part of a text that is written
/// (lettering.h). Window thread.
namespace tuft::app {

/// What a click on a stroke does.
enum class CopyEdit { reverse, join, split, remove };

/// The strokes that are shown and edited.
struct CopyInWork {
    std::optional<writer::CopiedPicture> shown;  ///< as it was read last, with the edits since
    writer::CopyCorrection shown_for;            ///< that `shown` follows from
    SmallPicture picture;
    unsigned texture = 0;                         ///< OpenGL name of the picture; 0: none yet
    bool fresh = false;                           ///< the texture is to be made anew
    std::vector<writer::CopyCorrection> earlier;  ///< corrections before each step, the last one last
    CopyEdit edit = CopyEdit::reverse;
    std::optional<std::size_t> joined;   ///< stroke that another one is to be joined to
    std::optional<std::size_t> dragged;  ///< stroke that is moved in the order
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
/// strokes does nothing; the last stroke is not removed.
void edit_stroke(const CopyToEdit& c, const Vec2& at);
/// Moves a stroke in the order. `begins`: with a step of its own to go back.
void move_stroke(const CopyToEdit& c, std::size_t stroke, std::size_t to, bool begins);
/// Goes one step back. Returns false when there is none.
bool step_back(const CopyToEdit& c);
/// Sets the correction; the picture is taken apart anew.
void correct(const CopyToEdit& c, writer::CopyCorrection correction);

/// A copied character that a project keeps: the picture's file and its correction.
struct KeptCopy {
    std::string id;              ///< of the picture's bytes
    std::filesystem::path file;  ///< where the picture was
    std::vector<char> bytes;     ///< of the picture's file
    std::string name;            ///< the character, or empty
    writer::CopyCorrection correction;
};

/// Converts a kept copy to its attachment and back. `kept_copy` ignores unknown fields; of a damaged line it keeps the
/// picture.
io::Attachment to_attachment(const KeptCopy& copy);
KeptCopy kept_copy(const io::Attachment& attachment);

/// Returns the copy of a request, to be kept; nothing where the picture's file cannot be read or is larger than 24 MB.
std::optional<KeptCopy> copy_to_keep(const writer::TextRequest& request);
/// Returns a file with the picture: where it was, if the same bytes are there, else one in the state folder that is
/// written now. Throws `Error` where it cannot be written.
std::filesystem::path picture_of(const KeptCopy& copy);

/// Returns the options of `tuft write` that make the same copy.
std::string copy_words(const writer::TextRequest& request);

}  // namespace tuft::app
