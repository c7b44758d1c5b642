#include "app/tools/model_clicks.h"

#include <algorithm>
#include <cmath>

#include "app/panels/panels.h"
#include "app/tools/aim.h"

namespace tuft::app {
namespace {

constexpr double kLassoStep = 3;  // pixels between two of its corners

}  // namespace

void press_fill(Session& s, const Event& e) {
    const auto hit = aim_at(s.paint_thread->surface(), aim_of(s, e));
    if (!hit) return;
    s.tools.fill.at = hit->position;
    s.paint_thread->post(FillModel{s.brush.ink, s.tools.fill, s.layers.active, s.masks.active});
}

void press_pick(Session& s, const Event& e) {
    const auto hit = aim_at(s.paint_thread->surface(), aim_of(s, e));
    if (hit)
        s.paint_thread->post(PickInk{hit->position});
    else
        show_message(s.status, "Click on the model: the ink that lies there is picked up.");
}

void press_mask(Session& s, const Event& e) {
    stroke::Mask mask;
    mask.kind = s.masks.choice.kind;
    if (mask.kind == stroke::MaskKind::lasso) {
        s.masks.lasso = {Vec2(e.x, e.y)};
        return;
    }
    const stroke::Model& model = s.paint_thread->model();
    const auto hit = aim_at(s.paint_thread->surface(), aim_of(s, e));
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

void move_lasso(Session& s, const Event& e) {
    std::vector<Vec2>& lasso = s.masks.lasso;
    if (std::hypot(e.x - lasso.back().x, e.y - lasso.back().y) >= kLassoStep) lasso.emplace_back(e.x, e.y);
}

void release_lasso(Session& s) {
    const std::vector<Vec2> pixels = std::exchange(s.masks.lasso, {});
    if (pixels.size() < 3) return;
    const render::GlCamera c = camera_of(s);
    stroke::Mask mask;
    mask.kind = stroke::MaskKind::lasso;
    mask.view = {.origin = c.eye,
                 .right = c.right,
                 .up = c.up,
                 .perspective = c.parallel_height == 0,
                 .through = s.masks.choice.through};
    for (const Vec2& p : pixels) {
        const Ray ray = render::ray_at(c, p.x - s.view.area.x, p.y - s.view.area.y);
        const Vec3 d = mask.view.perspective ? ray.direction / glm::dot(ray.direction, c.forward) : ray.origin - c.eye;
        mask.polygon.emplace_back(glm::dot(d, c.right), glm::dot(d, c.up));
    }
    make_mask(s, std::move(mask));
}

bool press_move(Session& s, const Event& e) {
    if (!s.journal.move_on_drag) return false;
    s.journal.from = s.journal.to = aim_at(s.paint_thread->surface(), aim_of(s, e));
    return true;
}

void drag_move(Session& s, const Event& e) {
    if (const auto to = aim_at(s.paint_thread->surface(), aim_of(s, e))) s.journal.to = to;
}

void release_move(Session& s, const Event& e) {
    JournalState& j = s.journal;
    if (const auto to = aim_at(s.paint_thread->surface(), aim_of(s, e))) j.to = to;
    if (glm::distance(j.from->position, j.to->position) > 1e-5)
        s.paint_thread->post(
            EditStrokes{.ids = {j.selected.begin(), j.selected.end()}, .move = shift_between(*j.from, *j.to)});
    j.from.reset();
    j.to.reset();
    j.move_on_drag = false;
}

}  // namespace tuft::app
