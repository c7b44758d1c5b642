#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "app/document/writing_band.h"
#include "app/input/events.h"
#include "app/session/session.h"
#include "app/tools/placing.h"

/// \file
/// The tool for drawings and handwriting. Window thread.
namespace tuft::app {

/// Places a drawing with the mouse. `cursor`: over the model; null where it is not.
class WritingTool {
  public:
    explicit WritingTool(Session& session) : session_(session) {}

    /// Updates the preview of the drawing at the cursor, and places it where a place was typed. Only while the tool is
    /// active.
    void watch(const Event* cursor);
    /// Scales the drawing; with Shift, turns it.
    void wheel(const Event& e);
    /// Paints the drawing at the cursor.
    void place(const Event* cursor);

  private:
    /// What a preview depends on.
    struct PreviewKey {
        stroke::Placement placement;  ///< of one copy
        Vec3 at{0};                   ///< of a band
        double scale = 0;
        BandLine along = BandLine::none;
        int repeats = 0;
        std::vector<CurvePoint> curve;
        std::filesystem::path file;
        std::array<Vec3, 2> box{};  ///< of the drawing
        std::shared_ptr<const mesh::SurfaceQuery> surface;
        bool mirrored = false, own_ink = false;
        stroke::SurfaceMapping mapping = stroke::SurfaceMapping::drape;
        bool operator==(const PreviewKey&) const = default;
    };
    /// From where it is seen.
    struct Seen {
        render::GlCamera camera;
        Vec4f section{0};
        bool operator==(const Seen&) const = default;
    };
    stroke::Placement placement_at(const PlacingSpot& spot) const;
    WritingBand band_at(const PlacingSpot& spot) const;
    PreviewKey key_at(const PlacingSpot& spot) const;
    void preview(const PlacingSpot& spot);
    void show_band(const PlacingSpot& spot);
    void drop_preview();
    void place(const PlacingSpot& spot);

    Session& session_;
    std::optional<PreviewKey> shown_;  ///< of the last preview
    Seen seen_;
};

}  // namespace tuft::app
