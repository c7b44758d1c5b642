#pragma once

#include <memory>
#include <optional>

#include "writer/layout/text_layout.h"

/// \file
/// Lines that the shape of a model has: borders, edges, creases. Called by `tuft paint --along edge` and by the
/// studio.
namespace tuft::writer {

/// What a feature line is.
enum class LineKind : std::uint8_t {
    border,        ///< of the surface
    sharp_edge,    ///< edges bent by 30° and more
    group_border,  ///< between groups of the model's file
    crease,        ///< a rounded edge, as the character line of a car's flank
};

/// A line along a feature of the model.
struct FeatureLine {
    ModelPath path;
    LineKind kind = LineKind::border;
    double away = 0;   ///< metres from the place that was asked for
    double angle = 0;  ///< radians, by which the surface bends there; 0: a border
    double over = 0;   ///< metres across a crease within which it does; 0: an edge of the mesh
};

/// Returns the feature line nearest to `through`, at most `reach` metres away; an edge is preferred to a crease that is
/// not nearer by a tenth of the reach. Edges are followed to the next with the least turn, up to where every next one
/// turns by more than 60°; their points lie a thousandth of the reach beside them, on the face that is on the side of
/// `through`. A reader outside sees the line run to the right, one above a level surface towards +x or, where it runs
/// more along y, +y; a closed line above a level surface does so at the place.
///
/// A crease is where the surface bends by at least 12° within 4, 8, 16 or 32 mm, and by 2.5 times as much as within the
/// same length beside it. The shortest such length counts, at most a tenth of the model's size. Its line is the middle
/// of the bend, Σ x Δφ / Σ Δφ over two such lengths of a section across it, φ the direction of the faces. It is
/// followed in half of those steps to where the bend falls below 7°.
///
/// Throws `Error` where no line is within reach. Cost: one pass over the triangles.
FeatureLine feature_line(const mesh::SurfaceQuery& query, const Vec3& through, double reach);

/// The same for one place after the other: the edges of the model are found once. Parts that the query leaves out have
/// none; their neighbours end in a border there.
class FeatureLines {
  public:
    explicit FeatureLines(const mesh::SurfaceQuery& query);
    ~FeatureLines();
    FeatureLine nearest(const Vec3& through, double reach);

  private:
    class Edges;
    const mesh::SurfaceQuery& query_;
    std::unique_ptr<Edges> edges_;
};

/// Returns how far from a place a feature line is looked for: 50 mm, at most a tenth of the model's diagonal. Metres.
double feature_reach(const Box& model);

/// A crease near a place, as `feature_line` follows it; nothing where there is none within reach.
std::optional<FeatureLine> crease_line(const mesh::SurfaceQuery& query, const Vec3& through, double reach);

}  // namespace tuft::writer
