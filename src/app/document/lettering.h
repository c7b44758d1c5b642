#pragma once

#include <atomic>
#include <future>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "app/document/copying.h"
#include "app/document/curve.h"
#include "app/document/writing.h"
#include "core/message.h"
#include "writer/text/text.h"

/// \file
/// A text before it is written on the model. Called by tools/lettering_tool.h. Window thread.
namespace tuft::app {

/// Spacing of a text; 0: the style's.
struct TextSpacing {
    double characters = 0, lines = 0;  ///< sides of a character, as `writer` has them
};

/// A text, how it is written, and how the user places it.
struct Lettering {
    writer::TextRequest wanted;
    int setting = 0;  ///< number of times that the text was set elsewhere than in its field
    writer::Direction direction = writer::Direction::horizontal;
    double side = 0;  ///< metres, of a character's square; 0: chosen by the model (`usual_side`)
    TextSpacing spacing;
    double turn = 0;                ///< radians, clockwise in the view; of lines and columns
    bool style_brush = true;        ///< the style's brush in the size that suits; false: the chosen brush
    CopyInWork copy;                ///< of the picture `wanted.like`
    bool reread = false;            ///< the picture is to be read, also where nothing else is wanted
    std::vector<KeptCopy> kept;     ///< of the project
    std::vector<CurvePoint> curve;  ///< of the curve tool when it was left last; the text runs along it

    std::optional<writer::Text> text;  ///< as it was read; nothing: there is nothing to write
    Message fault;                     ///< why there is none; empty: no text is typed
    std::uint64_t revision = 0;        ///< changes with `text`

    bool empty() const { return !text; }
    bool fitted() const { return wanted.fit || !wanted.like.empty(); }  ///< to outlines; copies always are
};

/// Copies a character from a picture from now on, as its file is now; an empty path: writes the text again.
void copy_picture(Lettering& lettering, const std::filesystem::path& picture);
inline CopyToEdit copy_to_edit(Lettering& lettering) {
    return {lettering.copy, lettering.wanted};
}

/// Sets the text elsewhere than in its field.
inline void set_text(Lettering& lettering, const std::string& text) {
    lettering.wanted.text = text;
    ++lettering.setting;
}

/// Returns the side of characters for a model of which none is known, metres: a tenth of its diagonal, two digits.
double usual_side(const Box& model);

/// Sets the layout of the text to direction, side and spacings, rounded as `place_words` states them.
void lay_out(Lettering& lettering);

/// Reads the characters of a text on a thread of its own: sources may be large.
class LetteringReader {
  public:
    ~LetteringReader() { stop_ = true; }

    /// Takes what was read, lays it out, and begins to read when `wanted` has changed; stops what is being read then.
    /// Returns at once.
    void update(Lettering& lettering);
    /// Returns true while the text of `lettering` is not what its `wanted` says.
    bool busy(const Lettering& lettering) const {
        return reading_.valid() || lettering.reread || !(lettering.wanted == asked_);
    }

  private:
    struct Read {
        std::optional<writer::Text> text;
        Message fault;
        std::optional<writer::CopiedPicture> copy;
        SmallPicture picture;  ///< where it is another one than before; else empty
        bool stopped = false;  ///< nothing was read
    };
    Read read(const writer::TextRequest& request);
    void take(Lettering& lettering, Read read);

    writer::TextRequest asked_;    // of the last reading
    writer::TextReader reader_;    // used by one thread at a time
    std::filesystem::path shown_;  // picture that was given last; likewise
    std::optional<std::filesystem::file_time_type> shown_time_;
    std::atomic<bool> stop_ = false;
    std::future<Read> reading_;  // last: it waits for its thread
};

/// A path on the model, and the length on it at which the middle of the text stands, metres.
struct LetteringPath {
    writer::ModelPath path;
    double middle = 0;
    Vec3 at{0};  ///< metres, point of the surface through which a rim goes

    bool operator==(const LetteringPath& other) const;
};
/// Where a text lies: in lines or columns, or along a path.
using LetteringPlace = std::variant<stroke::Placement, LetteringPath>;

/// Returns the place of a text at the surface point `at`: its middle is there, or on the curve nearest to there.
/// Arguments and rounding as of `place_writing`. Throws `Error` where the path is missing. Precondition for this and
/// what follows: the text is not empty, and laid out.
LetteringPlace place_lettering(const Lettering& lettering, const mesh::SurfaceQuery& query, const Vec3& at,
                               const Vec3& normal, const Vec3& right, const Vec3& eye);

/// Returns centre lines and outlines of the text on the surface, as of a drawing. The ink lies about them; its middle
/// differs from theirs by the small part of a character that a brush adds. Of long texts it is a line through the
/// characters of each row. Throws `Error` where the text does not fit its path.
std::vector<std::vector<PreviewPoint>> preview_lines(const mesh::SurfaceQuery& query, const Lettering& lettering,
                                                     const LetteringPlace& place, std::size_t most = 3000);

/// Returns the options of `tuft write` that write the same at the same place; for a curve without its line.
/// `brush`: preset; used where the style's is not wanted.
std::string place_words(const Lettering& lettering, const LetteringPlace& place, const std::string& brush);

/// Adds the strokes of a text at its place, with brush sizes and pressures as `stroke::choose_brushes` and
/// `stroke::press_to_widths` set them. Any thread.
std::vector<stroke::JournalEntry> lettering_entries(const writer::Text& text, const LetteringPlace& place,
                                                    const writer::TextHand& hand, stroke::BrushFit fit,
                                                    stroke::WidthTables& widths, const ProgressFn& progress);

}  // namespace tuft::app
