#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/disk_cache.h"
#include "core/system/progress.h"
#include "stroke/journal/entries.h"
#include "writer/copy/correction.h"
#include "writer/gesture/style.h"
#include "writer/glyphs/glyph_source.h"
#include "writer/layout/text_layout.h"

/// \file
/// From a text to entries of the journal. Called by `tuft write` and by the studio: the same text at the same place
/// gives the same entries in both.
namespace tuft::writer {

/// What is to be written.
struct TextRequest {
    std::string text;              ///< UTF-8; `lines_of` divides it
    std::filesystem::path glyphs;  ///< source of characters before the bundled ones, or empty
    std::string style = "kaishu";  ///< name or .toml
    std::filesystem::path like;    ///< picture of one character that is copied, whose name is `text`; or empty
    CopyCorrection correction;     ///< of the copy
    bool fit = false;              ///< to the outlines of the source; filled areas of fonts become strokes of a brush

    bool operator==(const TextRequest&) const = default;
};

/// A text with its glyphs, before it is put anywhere.
struct Text {
    Style style;
    std::vector<std::vector<Glyph>> lines;
    LayoutOptions layout;         ///< spacings of the style, unless they are set
    std::string group;            ///< name of its group of strokes
    std::size_t kept_filled = 0;  ///< characters of a font that were to be strokes of a brush and are not

    bool blank() const;  ///< no glyph has a stroke or an area
};

/// Reads texts. From one text to the next sources of characters stay open, and characters of a font that became strokes
/// are kept. Not shared by threads.
class TextReader {
  public:
    /// Throws `Error` that names all missing characters, for an unknown style or source, and for a picture that cannot
    /// be copied, or whose name is more than one character. Cost of a font that is fitted: about 0.05 s for each
    /// character that was not in the texts before, with `progress`.
    Text read(const TextRequest& request, const ProgressFn& progress = {});
    /// The picture of the last request taken apart; nothing where it had none.
    const std::optional<CopiedPicture>& copied() const { return copied_; }
    /// The picture itself. Precondition: `copied`.
    const io::Image8& picture() const { return picture_; }

  private:
    Glyph copy(const TextRequest& request);
    void make_strokes(Text& text, const ProgressFn& progress);

    std::filesystem::path path_, picture_path_;
    std::optional<std::filesystem::file_time_type> picture_time_;
    io::Image8 picture_;
    std::optional<CopiedPicture> copied_;
    std::unique_ptr<GlyphSource> own_, bundled_;
    /// Characters of `own_` as strokes, by the hash of their area; without strokes: it stays filled.
    std::map<std::uint64_t, std::vector<GlyphStroke>> made_;
};

/// Returns the name of the group of a text's strokes: its lines (`lines_of`) beside each other, without slashes
/// (`stroke::group_name`).
std::string group_of(std::string_view text);

/// Returns width and height of the text's squares at a side of 1.
Vec2 extent_of(const Text& text);

/// Returns the length of a text of one line along a path, parts of the side.
double length_of(const Text& text);

/// Returns the size of a brush that draws the text's strokes, where the brush itself is too coarse or too fine for them
/// (`size_that_fits`). None for texts without strokes of a pointed brush.
std::optional<std::string> size_for(const Text& text, const std::string& brush);

/// How a text's strokes are made.
struct TextHand {
    stroke::EntryOptions options;  ///< `brush`: preset; empty: the style's, in the size that suits the characters
    bool fit = false;              ///< to the outlines of the source
    DiskCache cache;               ///< of fitted strokes
};

/// Appends the strokes of a text in lines or columns, as flat entries without a placement, in one group with id 1.
/// Frame: metres, y down. Throws `Error` as `Writer::write`, `Cancelled` where `progress` returns false. Cost: about
/// 0.2 s for each stroke that is not in the cache.
void append_lines(std::vector<stroke::JournalEntry>& entries, const Text& text, const TextHand& hand,
                  const ProgressFn& progress);

/// Appends the strokes of the text's first line along a path, each character with a placement of its own
/// (`places_along`). Else as `append_lines`.
void append_along(std::vector<stroke::JournalEntry>& entries, const Text& text, const ModelPath& path, double middle,
                  const TextHand& hand, const ProgressFn& progress);

/// Returns the placement of each character of the first line, whose origin is the middle of its square. `middle`:
/// metres on the path, of the text's middle. Throws `Error` for a text of several lines and for one longer than the
/// path.
std::vector<stroke::Placement> places_along(const Text& text, const ModelPath& path, double middle);

/// Returns the centre lines of a text's strokes and the outlines of its areas, for a preview, in the frame of
/// `append_lines`.
std::vector<std::vector<Vec2>> outlined_lines(const Text& text);

/// Returns a line through the middles of the characters of each row, for the preview of a long text.
std::vector<std::vector<Vec2>> middle_lines(const Text& text);

/// The outlines of each character of the first line, about the middle of its square. [character]
std::vector<std::vector<std::vector<Vec2>>> outlined_characters(const Text& text);

}  // namespace tuft::writer
