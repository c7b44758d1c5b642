#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/gtx/quaternion.hpp>
#include <numbers>
#include <span>

#include "app/panels/panels.h"
#include "app/view/visibility.h"
#include "stroke/placement/surface_mapping.h"

namespace tuft::app {
namespace {

ImVec2 on_screen(const MarkParts& s, const render::GlCamera& c, const Vec3& p) {
    const Vec3 at = render::picture_point(c, p);
    return {static_cast<float>(at.x + s.view.area.x), static_cast<float>(at.y + s.view.area.y)};
}

// Outline of the hair that presses on the surface, laid onto it.
void contact_outline(const MarkParts& s, const render::GlCamera& c, ImDrawList* draw) {
    const mesh::SurfaceQuery& query = s.surface;
    for (const brush::Branch& branch : s.view.tuft.state.branches) {
        std::vector<ImVec2> left, right;
        for (const brush::Section& section : branch.sections) {
            if (section.pressure <= 0) continue;
            const Vec3 across =
                std::abs(section.a) > std::abs(section.b) ? section.a * section.e : section.b * section.m;
            for (const double side : {1.0, -1.0}) {
                const auto on = query.closest_point(section.centre + side * across, 0.02);
                if (on) (side > 0 ? left : right).push_back(on_screen(s, c, on->position));
            }
        }
        if (left.size() < 2) continue;
        left.insert(left.end(), right.rbegin(), right.rend());
        draw->AddPolyline(left.data(), static_cast<int>(left.size()), IM_COL32(255, 176, 32, 200), ImDrawFlags_Closed,
                          s.ui.px(1.5f));
    }
}

// Ring on the surface below a hovering tuft, as wide as its belly; of a wide ferrule the outline of its mouth.
void hover_ring(const MarkParts& s, const render::GlCamera& c, ImDrawList* draw) {
    const brush::Section &tip = s.view.tuft.state.branches.front().sections.front(),
                         &root = s.view.tuft.state.branches.front().sections.back();
    const TuftView& tuft = s.view.tuft;
    const bool wide = !tuft.mouth.empty();
    const Vec3 from = wide ? tuft.pose.position : root.centre,
               axis = wide ? tuft.pose.axis() : glm::normalize(tip.centre - root.centre);
    const auto hit = s.surface.ray(from, axis, 0, 0.2);
    if (!hit) return;
    Frame f = make_frame(hit->position, hit->normal);
    if (wide) {
        const stroke::Axes axes =
            stroke::axes_across(f.n, tuft.pose.rotation * Vec3(1, 0, 0), tuft.pose.rotation * Vec3(0, 1, 0));
        f.t = axes.right;
        f.b = axes.down;
    }
    const double radius = 0.5 * std::max(root.a, root.b);
    std::vector<Vec2> outline = tuft.mouth;
    for (int i = 0; i < 40 && !wide; ++i) {
        const double a = 2 * std::numbers::pi * i / 40;
        outline.push_back(radius * Vec2(std::cos(a), std::sin(a)));
    }
    std::vector<ImVec2> ring;
    for (const Vec2& p : outline) ring.push_back(on_screen(s, c, f.origin + p.x * f.t + p.y * f.b));
    draw->AddPolyline(ring.data(), static_cast<int>(ring.size()), IM_COL32(255, 255, 255, 190), ImDrawFlags_Closed,
                      s.ui.px(3));
    draw->AddPolyline(ring.data(), static_cast<int>(ring.size()), IM_COL32(30, 30, 30, 220), ImDrawFlags_Closed,
                      s.ui.px(1.3f));
}

// Where the symmetric copies of the brush would touch: a dot on the surface, faint where it is not seen.
void copy_dots(const MarkParts& s, const render::GlCamera& c, ImDrawList* draw) {
    const std::vector<stroke::PoseMap> copies = stroke::symmetry_copies(s.tools.symmetry);
    if (copies.empty()) return;
    const brush::Section &tip = s.view.tuft.state.branches.front().sections.front(),
                         &root = s.view.tuft.state.branches.front().sections.back();
    const mesh::SurfaceQuery& query = s.surface;
    for (const stroke::PoseMap& map : copies) {
        const Vec3 from = map.point(root.centre), to = map.point(tip.centre), direction = glm::normalize(to - from);
        const auto ahead = query.ray(from, direction, 0, 2 * glm::distance(from, to));
        const auto on = ahead ? ahead : query.closest_point(to, glm::distance(from, to));
        if (!on) continue;  // the model has nothing there
        const Vec3 eye = c.parallel_height > 0 ? -c.forward : glm::normalize(c.eye - on->position);
        const bool seen = !query.ray(on->position + 1e-4 * eye, eye, 0);
        draw->AddCircleFilled(on_screen(s, c, on->position), s.ui.px(4), IM_COL32(255, 255, 255, seen ? 220 : 60), 16);
        draw->AddCircleFilled(on_screen(s, c, on->position), s.ui.px(2.6f), IM_COL32(255, 150, 30, seen ? 255 : 70),
                              16);
    }
}

void axis_cross(const MarkParts& s, const render::GlCamera& c, ImDrawList* draw) {
    const float size = s.ui.px(26);
    const ImVec2 origin(static_cast<float>(s.view.area.x + s.view.area.width) - s.ui.px(44),
                        static_cast<float>(s.view.area.y) + s.ui.px(44));
    struct Arm {
        Vec3 direction;
        unsigned colour;
        const char* name;
    };
    Arm arms[] = {{{1, 0, 0}, IM_COL32(226, 92, 84, 255), "X"},
                  {{0, 1, 0}, IM_COL32(118, 178, 72, 255), "Y"},
                  {{0, 0, 1}, IM_COL32(86, 140, 226, 255), "Z"}};
    std::sort(std::begin(arms), std::end(arms), [&](const Arm& a, const Arm& b) {
        return glm::dot(a.direction, c.forward) > glm::dot(b.direction, c.forward);
    });
    for (const Arm& arm : arms) {
        const ImVec2 end(origin.x + size * static_cast<float>(glm::dot(arm.direction, c.right)),
                         origin.y - size * static_cast<float>(glm::dot(arm.direction, c.up)));
        draw->AddLine(origin, end, arm.colour, s.ui.px(2));
        draw->AddCircleFilled(end, s.ui.px(8), arm.colour);
        const ImVec2 text = ImGui::CalcTextSize(arm.name);
        draw->AddText(ImGui::GetFont(), ImGui::GetFontSize() * 0.8f,
                      ImVec2(end.x - 0.4f * text.x, end.y - 0.4f * text.y), IM_COL32(20, 20, 20, 255), arm.name);
    }
}

void lasso_marks(const MarkParts& s, ImDrawList* draw) {
    if (s.masks.lasso.empty()) return;
    std::vector<ImVec2> line;
    for (const Vec2& p : s.masks.lasso) line.emplace_back(static_cast<float>(p.x), static_cast<float>(p.y));
    draw->AddPolyline(line.data(), static_cast<int>(line.size()), IM_COL32(20, 20, 24, 200), ImDrawFlags_Closed,
                      s.ui.px(3.5f));
    draw->AddPolyline(line.data(), static_cast<int>(line.size()), IM_COL32(255, 196, 64, 255), ImDrawFlags_Closed,
                      s.ui.px(1.5f));
}

// A bar of a round length for the scale at the model's middle.
void scale_bar(const MarkParts& s, const render::GlCamera& c, ImDrawList* draw) {
    const double pixel = render::metres_per_pixel(c, s.view.orbit.target);
    const double want = 110.0 * static_cast<double>(s.ui.settings().scale) * pixel * 1e3;  // mm
    const double power = std::pow(10, std::floor(std::log10(want)));
    const double length = want / power >= 5 ? 5 * power : want / power >= 2 ? 2 * power : power;
    const auto width = static_cast<float>(length * 1e-3 / pixel);
    const float right = static_cast<float>(s.view.area.x + s.view.area.width) - s.ui.px(20),
                y = static_cast<float>(s.view.area.y + s.view.area.height) - s.ui.px(20);
    // Light with a dark rim: to be read on any colour.
    constexpr unsigned rim = IM_COL32(24, 24, 26, 210), light = IM_COL32(245, 245, 245, 255);
    for (const auto& [colour, more] : {std::pair{rim, 1.0f}, std::pair{light, 0.0f}}) {
        const float w = s.ui.px(2 + 2 * more), end = s.ui.px(4 + more);
        draw->AddLine(ImVec2(right - width - s.ui.px(more), y), ImVec2(right + s.ui.px(more), y), colour, w);
        for (const float x : {right - width, right}) draw->AddLine(ImVec2(x, y - end), ImVec2(x, y + end), colour, w);
    }
    char text[32];
    std::snprintf(text, sizeof text, length >= 1000 ? "%.0f m" : "%g mm", length >= 1000 ? length / 1000 : length);
    const ImVec2 at(right - width, y - s.ui.px(25)), size = ImGui::CalcTextSize(text);
    draw->AddRectFilled(ImVec2(at.x - s.ui.px(5), at.y - s.ui.px(1)),
                        ImVec2(at.x + size.x + s.ui.px(5), at.y + size.y + s.ui.px(1)), IM_COL32(24, 24, 26, 190),
                        s.ui.px(4));
    draw->AddText(at, light, text);
}

// Control points and the curve through them, as it lies on the model.
void curve_marks(const MarkParts& s, const render::GlCamera& c, ImDrawList* draw) {
    const auto& points = s.tools.curve.points;
    if (points.empty()) return;
    const std::vector<CurveSample> places = project_curve(s.surface, points, 32);
    for (const auto& [colour, width] :
         {std::pair{IM_COL32(20, 20, 24, 170), 4.0f}, std::pair{IM_COL32(255, 196, 64, 255), 1.8f}})
        for (std::size_t i = 1; i < places.size(); ++i)
            if (places[i].on && places[i - 1].on)
                draw->AddLine(on_screen(s, c, places[i - 1].position), on_screen(s, c, places[i].position), colour,
                              s.ui.px(width));
    for (std::size_t i = 0; i < points.size(); ++i) {
        const bool held = static_cast<int>(i) == s.tools.curve.grabbed || static_cast<int>(i) == s.tools.curve.over;
        const ImVec2 at = on_screen(s, c, points[i].position);
        const float radius = s.ui.px(3.5f + 2.5f * static_cast<float>(points[i].pressure));
        draw->AddCircleFilled(at, radius, held ? IM_COL32(255, 224, 130, 255) : IM_COL32(255, 255, 255, 255), 24);
        draw->AddCircle(at, radius, IM_COL32(30, 30, 34, 255), 24, s.ui.px(1.6f));
    }
}

// The curve that a text runs along.
void lettering_curve(const MarkParts& s, const render::GlCamera& c, ImDrawList* draw) {
    const Lettering& l = s.tools.lettering;
    if (s.tools.active != Tool::text || l.direction != writer::Direction::curve) return;
    const std::vector<CurveSample> places = project_curve(s.surface, l.curve, 32);
    for (std::size_t i = 1; i < places.size(); ++i)
        if (places[i].on && places[i - 1].on)
            draw->AddLine(on_screen(s, c, places[i - 1].position), on_screen(s, c, places[i].position),
                          IM_COL32(90, 210, 255, 200), s.ui.px(1.6f));
}

// Where the drawing or the text would lie, as far as it is seen.
void writing_marks(const MarkParts& s, const render::GlCamera& c, ImDrawList* draw) {
    if (s.tools.active != Tool::writing && s.tools.active != Tool::text) return;
    for (const std::vector<Vec3>& guide : s.tools.place.guides)
        for (std::size_t i = 1; i < guide.size(); ++i) {
            const ImVec2 from = on_screen(s, c, guide[i - 1]), to = on_screen(s, c, guide[i]);
            draw->AddLine(from, to, IM_COL32(30, 30, 34, 160), s.ui.px(3));
            if (i % 2) draw->AddLine(from, to, IM_COL32(90, 210, 255, 255), s.ui.px(1.6f));
        }
    for (const auto& line : s.tools.place.preview)
        for (std::size_t i = 1; i < line.size(); ++i)
            if (line[i - 1].seen && line[i].seen)
                draw->AddLine(on_screen(s, c, line[i - 1].position), on_screen(s, c, line[i].position),
                              IM_COL32(255, 150, 30, 230), s.ui.px(1.6f));
}

// Where the chosen ink would lie while it is moved: dots round it.
void shift_marks(const MarkParts& s, const render::GlCamera& c, ImDrawList* draw) {
    const JournalState& j = s.journal;
    if (!j.from || !j.to) return;
    const mesh::SurfaceQuery& query = s.surface;
    const RigidMove m = shift_between(*j.from, *j.to);
    const Vec4f section = section_plane(s.view, s.model.mesh->bounds);
    const double tolerance = 2e-3 * s.model.mesh->bounds.diagonal();
    for (const OutlinePoint& p : j.outline) {
        const auto on = query.closest_point(m.to + m.rotation * (Vec3(p.position) - m.from));
        if (on && is_seen(query, c, section, on->position, tolerance))
            draw->AddCircleFilled(on_screen(s, c, on->position), s.ui.px(1.6f), IM_COL32(0, 190, 255, 255), 6);
    }
}

struct Stop {
    unsigned colour;
    float at;
};

// Colours from left to right with a text at each end, in the lower right above the scale.
void legend(const MarkParts& s, ImDrawList* draw, std::span<const Stop> stops, const char* low, const char* high) {
    const float width = s.ui.px(190), height = s.ui.px(10);
    // In a narrow view the tuft's inset takes the room below.
    const bool narrow = static_cast<float>(s.view.area.width) < s.ui.px(460);
    const ImVec2 at(narrow ? static_cast<float>(s.view.area.x) + s.ui.px(20)
                           : static_cast<float>(s.view.area.x + s.view.area.width) - s.ui.px(20) - width,
                    narrow ? static_cast<float>(s.view.area.y) + s.ui.px(20)
                           : static_cast<float>(s.view.area.y + s.view.area.height) - s.ui.px(98));
    draw->AddRectFilled(ImVec2(at.x - s.ui.px(10), at.y - s.ui.px(10)),
                        ImVec2(at.x + width + s.ui.px(10), at.y + height + s.ui.px(28)), IM_COL32(24, 24, 26, 190),
                        s.ui.px(5));
    for (std::size_t i = 1; i < stops.size(); ++i)
        draw->AddRectFilledMultiColor(ImVec2(at.x + stops[i - 1].at * width, at.y),
                                      ImVec2(at.x + stops[i].at * width, at.y + height), stops[i - 1].colour,
                                      stops[i].colour, stops[i].colour, stops[i - 1].colour);
    const unsigned text = IM_COL32(240, 240, 240, 255);
    draw->AddText(ImVec2(at.x, at.y + height + s.ui.px(4)), text, low);
    draw->AddText(ImVec2(at.x + width - ImGui::CalcTextSize(high).x, at.y + height + s.ui.px(4)), text, high);
}

void legends(const MarkParts& s, ImDrawList* draw) {
    if (s.view.shading == ModelView::height || s.view.shading == ModelView::wetness) {
        // As `ramp` in mesh.frag.
        static constexpr Stop stops[] = {{IM_COL32(33, 31, 77, 255), 0},
                                         {IM_COL32(46, 94, 140, 255), 0.25f},
                                         {IM_COL32(41, 153, 140, 255), 0.5f},
                                         {IM_COL32(140, 201, 82, 255), 0.75f},
                                         {IM_COL32(252, 232, 102, 255), 1}};
        char high[32];
        std::snprintf(high, sizeof high, "%g \xce\xbcm", height_range(s.view.max_ink_height));
        legend(s, draw, stops, "0", high);
    } else if (s.view.shading == ModelView::stretch) {
        // As `stretch_colours`.
        static constexpr Stop stops[] = {
            {IM_COL32(36, 87, 214, 255), 0}, {IM_COL32(184, 184, 184, 255), 0.5f}, {IM_COL32(219, 51, 31, 255), 1}};
        legend(s, draw, stops, s.ui.tr("coarser \xc3\x97 1.5"), s.ui.tr("finer \xc3\x97 1.5"));
    }
}

}  // namespace

RigidMove shift_between(const mesh::SurfacePoint& from, const mesh::SurfacePoint& to) {
    return {.from = from.position, .to = to.position, .rotation = glm::rotation(from.normal, to.normal)};
}

double height_range(double max_height) {
    const double most = std::max(0.5, max_height), power = std::pow(10, std::floor(std::log10(most)));
    return most <= power ? power : most <= 2 * power ? 2 * power : most <= 5 * power ? 5 * power : 10 * power;
}

void view_marks(const MarkParts& s, const render::GlCamera& c) {
    ImDrawList* draw = ImGui::GetBackgroundDrawList();
    draw->PushClipRect(ImVec2(static_cast<float>(s.view.area.x), static_cast<float>(s.view.area.y)),
                       ImVec2(static_cast<float>(s.view.area.x + s.view.area.width),
                              static_cast<float>(s.view.area.y + s.view.area.height)),
                       true);
    if (!s.view.tuft.state.branches.empty()) s.view.tuft.pressed ? contact_outline(s, c, draw) : hover_ring(s, c, draw);
    if (!s.view.tuft.state.branches.empty()) copy_dots(s, c, draw);
    curve_marks(s, c, draw);
    lettering_curve(s, c, draw);
    writing_marks(s, c, draw);
    shift_marks(s, c, draw);
    lasso_marks(s, draw);
    axis_cross(s, c, draw);
    scale_bar(s, c, draw);
    legends(s, draw);
    draw->PopClipRect();
}

}  // namespace tuft::app
