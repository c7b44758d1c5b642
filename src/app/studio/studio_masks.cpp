#include <algorithm>
#include <cmath>

#include "app/panels/panels.h"
#include "app/studio/studio.h"

/// Making masks on the model; the eyedropper.
namespace tuft::app {
namespace {

constexpr double kLassoStep = 3;  // pixels between two of its corners

}  // namespace

void Studio::pick_press(const Event& e) {
    const auto hit = aim_at(*session_.paint_thread->model().query, aim_of(e));
    if (hit)
        session_.paint_thread->post(PickInk{hit->position});
    else
        show_message(session_.status, "Click on the model: the ink that lies there is picked up.");
}

void Studio::mask_press(const Event& e) {
    Session& s = session_;
    stroke::Mask mask;
    mask.kind = s.masks.choice.kind;
    if (mask.kind == stroke::MaskKind::lasso) {
        s.masks.lasso = {Vec2(e.x, e.y)};
        return;
    }
    const stroke::Model& model = s.paint_thread->model();
    const auto hit = aim_at(*model.query, aim_of(e));
    if (!hit) return;
    if (mask.kind == stroke::MaskKind::angle) {
        mask.direction = hit->normal;
        mask.within = s.masks.choice.within;
        mask.soft = s.masks.choice.soft;
    } else if (mask.kind == stroke::MaskKind::chart) {
        mask.points = {hit->position};
    } else {
        if (model.mesh->triangle_groups.empty()) return;
        s.masks.choice.group = model.mesh->group_names[model.mesh->triangle_groups[hit->triangle]];
        mask.groups = {s.masks.choice.group};
    }
    make_mask(s, std::move(mask));
}

void Studio::lasso_move(const Event& e) {
    std::vector<Vec2>& lasso = session_.masks.lasso;
    if (std::hypot(e.x - lasso.back().x, e.y - lasso.back().y) >= kLassoStep) lasso.emplace_back(e.x, e.y);
}

void Studio::lasso_release() {
    Session& s = session_;
    const std::vector<Vec2> pixels = std::exchange(s.masks.lasso, {});
    if (pixels.size() < 3) return;
    const render::GlCamera c = camera();
    stroke::Mask mask;
    mask.kind = stroke::MaskKind::lasso;
    mask.view = {.origin = c.eye,
                 .right = c.right,
                 .up = c.up,
                 .perspective = c.parallel_height == 0,
                 .through = s.masks.choice.through};
    for (const Vec2& p : pixels) {
        const render::GlRay ray = render::ray_at(c, p.x - s.view.area.x, p.y - s.view.area.y);
        const Vec3 d = mask.view.perspective ? ray.direction / glm::dot(ray.direction, c.forward) : ray.origin - c.eye;
        mask.polygon.emplace_back(glm::dot(d, c.right), glm::dot(d, c.up));
    }
    make_mask(s, std::move(mask));
}

}  // namespace tuft::app
