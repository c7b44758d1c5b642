#pragma once

#include <cstdint>
#include <optional>

#include "app/input/events.h"
#include "app/session/session.h"
#include "app/tools/placing.h"

/// \file
/// The tool that writes a text on the model. Window thread.
namespace tuft::app {

/// Places a text with the mouse. `cursor`: over the model; null where it is not.
class LetteringTool {
  public:
    explicit LetteringTool(Session& session) : session_(session) {}

    /// Updates the preview of the text at the cursor, and writes it where a place was typed. Only while the tool is
    /// active.
    void watch(const Event* cursor);
    /// Sizes the characters; with Shift, turns the text.
    void wheel(const Event& e);
    /// Writes the text at the cursor.
    void place(const Event* cursor);

  private:
    /// What a preview depends on.
    struct PreviewKey {
        Vec3 at{0}, normal{0}, eye{0};
        render::GlCamera camera;
        Vec4f section{0};
        writer::LayoutOptions layout;
        double turn = 0;
        std::uint64_t revision = 0;
        std::size_t curve = 0;  ///< number of its points
        bool operator==(const PreviewKey&) const = default;
    };
    LetteringPlace place_at(const PlacingSpot& spot) const;
    void preview(const PlacingSpot& spot);
    void drop_preview();
    void place(const PlacingSpot& spot);
    void follow_brush();

    Session& session_;
    std::optional<PreviewKey> shown_;
    std::string preset_;  ///< chosen when the tool was last seen
};

}  // namespace tuft::app
