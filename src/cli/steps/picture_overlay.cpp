#include "cli/steps/picture_overlay.h"

#include <algorithm>
#include <cmath>

#include "core/text/units.h"
#include "decal/stroke_font.h"
#include "ink/spectra/srgb.h"

namespace tuft::cli {
namespace {

constexpr double kLift = 1e-4;  // metres, of lines above the surface when they are looked at

}  // namespace

render::Camera camera_of(const View& view, const mesh::TriangleMesh& mesh) {
    return render::make_camera(picture_view(view, mesh), view.width, view.height, mesh.positions);
}

PictureOverlay::PictureOverlay(const render::Image& image, const render::Camera& camera,
                               const mesh::SurfaceQuery& query)
    : canvas_(image.width, image.height, Vec3(0)), camera_(camera), query_(query) {
    for (std::size_t i = 0; i < image.rgb.size(); ++i) canvas_.rgb[i] = ink::linear_of_code()[image.rgb[i]];
}

void PictureOverlay::draw(const SurfacePath& path, double width, const Vec3& colour) {
    std::vector<Vec2> run;
    const auto flush = [&] {
        if (run.size() > 1) line(run, width, colour);
        run.clear();
    };
    for (std::size_t i = 0; i < path.points.size(); ++i) {
        const std::optional<Vec2> at = seen(path.points[i], path.normals[i]);
        if (at)
            run.push_back(*at);
        else
            flush();
    }
    flush();
}

void PictureOverlay::draw_arrow(const SurfacePath& arrow, double width, const Vec3& colour) {
    if (arrow.points.size() < 2) return;
    const auto tail = seen(arrow.points.front(), arrow.normals.front());
    const auto tip = seen(arrow.points.back(), arrow.normals.back());
    if (!tail || !tip || glm::length(*tip - *tail) < 4) return;
    const Vec2 along = *tip - *tail, across = 0.3 * Vec2(-along.y, along.x);
    line({*tail, *tip}, width, colour);
    line({*tip - 0.4 * along + across, *tip, *tip - 0.4 * along - across}, width, colour);
}

void PictureOverlay::draw_number(int number, const Vec3& p, const Vec3& normal, double size, const Vec3& colour) {
    const std::optional<Vec2> at = seen(p, normal);
    if (!at) return;
    const std::string text = std::to_string(number);
    draw_text(text, *at - Vec2(decal::text_width(text, size) + 0.5 * size, -0.5 * size), size, colour);
}

void PictureOverlay::draw_text(const std::string& text, const Vec2& corner, double size, const Vec3& colour) {
    for (const double halo : {1.0, 0.0})
        for (const std::vector<Vec2>& l : decal::text_lines(text, Vec2(0), size)) {
            std::vector<Vec2> points;
            points.reserve(l.size());
            for (const Vec2& q : l) points.push_back(corner + Vec2(q.x, -q.y));
            stroke(points, halo > 0 ? 0.3 * size : 0.13 * size, halo > 0 ? Vec3(1) : colour);
        }
}

void PictureOverlay::fill(const Vec2& low, const Vec2& high, const Vec3& colour) {
    render::fill_polygon(canvas_, std::vector<Vec2>{low, {high.x, low.y}, high, {low.x, high.y}}, colour);
}

/// Position in the picture of a point that nothing hides.
std::optional<Vec2> PictureOverlay::seen(const Vec3& p, const Vec3& normal) const {
    const Vec3 lifted = p + kLift * normal, to_eye = camera_.eye - lifted;
    const double distance = glm::length(to_eye);
    if (glm::dot(to_eye, normal) <= 0 || query_.occluded(lifted, to_eye / distance, 0, distance)) return std::nullopt;
    const std::optional<Vec3> at = render::project(camera_, p);
    if (!at) return std::nullopt;
    return Vec2(at->x, at->y);
}

void PictureOverlay::line(const std::vector<Vec2>& points, double width, const Vec3& colour) {
    stroke(points, width + 2, Vec3(1));
    stroke(points, width, colour);
}

void PictureOverlay::stroke(const std::vector<Vec2>& points, double width, const Vec3& colour) {
    const double widths[] = {width};
    render::stroke_line(canvas_, points, widths, colour);
}

}  // namespace tuft::cli
