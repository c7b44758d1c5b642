#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "cli/steps/steps.h"
#include "mesh/query/surface_query.h"
#include "render/brush/brush_canvas.h"
#include "render/picture/camera.h"
#include "render/picture/picture.h"

/// \file
/// Lines, arrows and numbers on the surface of a rendered model. Called by `tuft decals` for its placing guide and by
/// `tuft replay` for the picture of what moved.
namespace tuft::cli {

/// A line on a surface: points and unit normals, metres, model frame.
struct SurfacePath {
    std::vector<Vec3> points, normals;
};

/// Returns the camera with which `draw_picture` draws a model.
render::Camera camera_of(const View& view, const mesh::TriangleMesh& mesh);

/// Draws over a rendered picture; what the model hides is not drawn. Widths and sizes in pixels, colours linear. Camera
/// and query must outlive it.
class PictureOverlay {
  public:
    PictureOverlay(const render::Image& image, const render::Camera& camera, const mesh::SurfaceQuery& query);

    /// Whether a point of the surface is seen.
    bool shows(const Vec3& p, const Vec3& normal) const { return seen(p, normal).has_value(); }
    /// Draw what is seen of a path, an arrow or a number on the surface. Widths and sizes in pixels, linear colours.
    void draw(const SurfacePath& path, double width, const Vec3& colour);
    void draw_arrow(const SurfacePath& arrow, double width, const Vec3& colour);
    void draw_number(int number, const Vec3& p, const Vec3& normal, double size, const Vec3& colour);
    /// Draws a text whose lower left corner is `corner`, pixels from the top left of the picture.
    void draw_text(const std::string& text, const Vec2& corner, double size, const Vec3& colour);
    /// Fills a rectangle.
    void fill(const Vec2& low, const Vec2& high, const Vec3& colour);

    std::vector<std::uint8_t> rgb() const { return render::to_srgb(canvas_); }

  private:
    std::optional<Vec2> seen(const Vec3& p, const Vec3& normal) const;
    void line(const std::vector<Vec2>& points, double width, const Vec3& colour);
    void stroke(const std::vector<Vec2>& points, double width, const Vec3& colour);

    render::BrushCanvas canvas_;
    const render::Camera& camera_;
    const mesh::SurfaceQuery& query_;
};

}  // namespace tuft::cli
