#include "render/picture/camera_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/ease.h"
#include "core/geometry/bounds.h"

namespace tuft::render {
namespace {

Vec3 middle_of(std::span<const Vec3f> points) {
    Box box;
    for (const Vec3f& p : points) box.add(Vec3(p));
    return points.empty() ? Vec3{0} : box.centre();
}

/// The same camera with a target and a distance of its own.
View with_target(View view, int width, int height, std::span<const Vec3f> points) {
    const Camera camera = make_camera(view, width, height, points);
    const Vec3 aim = view.target.value_or(middle_of(points));
    view.distance = glm::dot(aim - camera.eye, camera.forward);
    view.target = camera.eye + view.distance * camera.forward;
    return view;
}

/// Fitted views that only turn stay fitted: the object keeps its size in the picture.
bool only_turns(const View& a, const View& b) {
    View turned = a;
    turned.azimuth = b.azimuth;
    turned.elevation = b.elevation;
    return !a.target && turned == b;
}

View mix(const View& a, const View& b, double part) {
    View view = a;
    view.azimuth = std::lerp(a.azimuth, b.azimuth, part);
    view.elevation = std::lerp(a.elevation, b.elevation, part);
    view.field_of_view = std::lerp(a.field_of_view, b.field_of_view, part);
    view.margin = std::lerp(a.margin, b.margin, part);
    if (a.target && b.target) {
        view.target = glm::mix(*a.target, *b.target, part);
        view.distance = std::exp(std::lerp(std::log(a.distance), std::log(b.distance), part));
    }
    return view;
}

}  // namespace

CameraPath turntable_path(const View& view) {
    View begin = view;
    begin.azimuth += 2 * std::numbers::pi;
    return {{0, begin}, {1, view}};
}

CameraPath standing_path(const std::vector<View>& views, double moving) {
    CameraPath path;
    const double n = static_cast<double>(views.size());
    for (std::size_t i = 0; i < views.size(); ++i) {
        const double k = static_cast<double>(i);
        path.push_back({i == 0 ? 0 : (k + 0.5 * moving) / n, views[i]});
        path.push_back({i + 1 == views.size() ? 1 : (k + 1 - 0.5 * moving) / n, views[i]});
    }
    return path;
}

View view_at(const CameraPath& path, double at, int width, int height, std::span<const Vec3f> points) {
    const auto after = std::find_if(path.begin(), path.end(), [at](const CameraKey& key) { return key.at >= at; });
    if (after == path.end()) return path.back().view;
    if (after == path.begin() || after->at == at || after->view == (after - 1)->view) return after->view;
    const CameraKey &a = *(after - 1), &b = *after;
    const double s = (at - a.at) / (b.at - a.at);
    const bool turns = only_turns(a.view, b.view);
    const double whole = std::abs(b.view.azimuth - a.view.azimuth) - 2 * std::numbers::pi;
    if (turns && std::abs(whole) < 1e-9) return mix(a.view, b.view, s);
    if (turns) return mix(a.view, b.view, smooth_step(s));
    return mix(with_target(a.view, width, height, points), with_target(b.view, width, height, points), smooth_step(s));
}

}  // namespace tuft::render
