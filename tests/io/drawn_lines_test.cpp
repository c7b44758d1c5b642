#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "core/text/units.h"
#include "io/svg/svg.h"
#include "mesh/read/polygon_soup.h"
#include "paths.h"
#include "stroke/document/document.h"
#include "stroke/document/pick.h"
#include "stroke/drawing/drawing.h"
#include "stroke/journal/entries.h"

/// Wide lines of a drawing as they lie painted, against their definition (SVG 1.1, 11.4).
namespace tuft::io {
namespace {

enum class Cap { butt, round, square };
enum class Join { miter, cut_miter, round, bevel };
constexpr const char* kCaps[] = {"butt", "round", "square"};
constexpr const char* kJoins[] = {"miter", "miter' stroke-miterlimit='2", "round", "bevel"};

/// A line with one corner, millimetres, y down.
struct Line {
    Vec2 from, corner, to;
    double width = 0;
    Cap cap = Cap::butt;
    Join join = Join::miter;

    double half() const { return 0.5 * width; }
    /// Whether the stroke covers a point, by the definition of its parts.
    bool covers(const Vec2& p) const {
        return along(p, from, corner) || along(p, to, corner) || at_corner(p) || (cap == Cap::round && at_end(p));
    }

  private:
    // From an end to the corner; a square end is half a width longer.
    bool along(const Vec2& p, const Vec2& end, const Vec2& inner) const {
        const Vec2 d = glm::normalize(inner - end), q = p - end;
        const double t = glm::dot(q, d), off = std::abs(d.x * q.y - d.y * q.x);
        return off <= half() && t >= (cap == Cap::square ? -half() : 0) && t <= glm::distance(end, inner);
    }
    bool at_end(const Vec2& p) const { return glm::distance(p, from) <= half() || glm::distance(p, to) <= half(); }
    bool at_corner(const Vec2& p) const {
        if (join == Join::round) return glm::distance(p, corner) <= half();
        const Vec2 in = glm::normalize(corner - from), on = glm::normalize(to - corner);
        const double turn = in.x * on.y - in.y * on.x, side = turn > 0 ? 1 : -1;
        if (std::abs(turn) < 1e-9) return false;  // straight on
        const Vec2 a = half() * side * Vec2(in.y, -in.x), b = half() * side * Vec2(on.y, -on.x), q = p - corner;
        // The wedge between both normals, cut by the chord, or by both outer edges.
        const double u = (q.x * b.y - q.y * b.x) / (a.x * b.y - a.y * b.x),
                     v = (a.x * q.y - a.y * q.x) / (a.x * b.y - a.y * b.x);
        if (u < 0 || v < 0) return false;
        if (join == Join::miter) return glm::dot(q, a) <= half() * half() && glm::dot(q, b) <= half() * half();
        return u + v <= 1;
    }
};

std::string text_of(const std::vector<Line>& lines, const std::string& more) {
    std::string svg = "<svg width='100mm' viewBox='0 0 100 100'>";
    for (const Line& l : lines) {
        const auto point = [](const Vec2& p) { return std::to_string(p.x) + " " + std::to_string(p.y); };
        svg += "<path d='M" + point(l.from) + " L" + point(l.corner) + " L" + point(l.to) +
               "' fill='none' stroke='black' stroke-width='" + std::to_string(l.width) + "' stroke-linecap='" +
               kCaps[static_cast<int>(l.cap)] + "' stroke-linejoin='" + kJoins[static_cast<int>(l.join)] + "' " + more +
               "/>";
    }
    return svg + "</svg>";
}

/// A drawing of 100 mm, its middle at a point of a model.
class DrawnLines : public testing::Test {
  protected:
    void draw(const std::string& name, const Vec3& near, const std::string& svg, double wide = stroke::kWideLine) {
        model_ = &shipped(name);
        entries_.clear();
        document_.emplace(*model_);
        stroke::append_entries(entries_, parse_svg(svg, "lines.svg", {.outlines = true}), {});
        const auto at = model_->query->closest_point(near);
        place_ = stroke::upright_placement(at->position, at->normal, 0);
        stroke::place_drawing(stroke::drawing_in(entries_, true), {.placement = place_, .centre = Vec2(0.05)});
        for (stroke::StrokeSamples* trace : stroke::drawing_in(entries_, true)) trace->placement = place_;
        stroke::fill_wide_lines(entries_, wide);
        for (const stroke::JournalEntry& entry : entries_)
            if (entry.as<stroke::Fill>()) document_->paint(entry);
    }

    /// Part of a full film at points of the drawing, millimetres.
    std::vector<double> films(const std::vector<Vec2>& points) const {
        stroke::StrokeSamples flat{.placement = place_};
        for (const Vec2& p : points) flat.samples.push_back({.position = Vec3(kMillimetre * p - Vec2(0.05), 0)});
        const double full = document_->materials().ink("carbon").strength() * document_->materials().ink("carbon").film;
        std::vector<double> out;
        for (const stroke::SurfaceSample& s : stroke::map_to_surface(*model_->query, flat).samples) {
            const auto amounts = stroke::pick(*document_, s.position).amounts;
            out.push_back(amounts[0] / full);
        }
        return out;
    }

    double texel_mm() const { return model_->texels.texel_size / kMillimetre; }

    void check(const std::vector<Line>& lines, double stretch = 0) const {
        for (const Line& line : lines) check(line, lines, stretch);
    }

    /// Checks points round a line of a drawing that lie farther from its outline than 5 % of the width. Of a texel,
    /// that is its centre's distance, 0.7 of it at most, and its coverage's half width and raster cell, 0.75. A line is
    /// as wide on the surface as it is drawn, so its ends' corners lie off the map's by `stretch` of their distance.
    void check(const Line& line, const std::vector<Line>& lines, double stretch) const {
        constexpr double kPart = 0.05;
        const double margin = std::max(kPart * line.width, 1.5 * texel_mm()) + stretch * line.width / std::sqrt(2),
                     step = 0.11 * line.width;
        const auto covered = [&](const Vec2& p) {
            return std::any_of(lines.begin(), lines.end(), [&](const Line& l) { return l.covers(p); });
        };
        std::vector<Vec2> points;
        std::vector<bool> inside;
        const Vec2 low = glm::min(line.from, glm::min(line.corner, line.to)) - 2.0 * line.width,
                   high = glm::max(line.from, glm::max(line.corner, line.to)) + 2.0 * line.width;
        for (double y = low.y; y < high.y; y += step)
            for (double x = low.x; x < high.x; x += step) {
                const bool in = covered({x, y});
                bool clear = true;
                for (int k = 0; k < 16; ++k) {
                    const double a = std::numbers::pi * k / 8;
                    clear = clear && covered(Vec2(x, y) + margin * Vec2(std::cos(a), std::sin(a))) == in;
                }
                if (clear) points.emplace_back(x, y), inside.push_back(in);
            }
        const std::vector<double> found = films(points);
        int wrong = 0;
        for (std::size_t i = 0; i < points.size(); ++i) wrong += inside[i] ? found[i] < 0.99 : found[i] > 0.01;
        EXPECT_EQ(wrong, 0) << "of " << points.size() << " points; width " << line.width << " mm, "
                            << kCaps[static_cast<int>(line.cap)] << " ends, " << kJoins[static_cast<int>(line.join)];
    }

    /// Every end with every corner, three to a row.
    static std::vector<Line> all(double width) {
        std::vector<Line> lines;
        for (int k = 0; k < 12; ++k) {
            const Vec2 corner = Vec2(50) + width * Vec2(9.0 * (k % 3) - 6, 6.5 * (k / 3) - 11);
            lines.push_back({.from = corner - width * Vec2(4.5, 0),
                             .corner = corner,
                             .to = corner + width * Vec2(-2.5, 3.2),
                             .width = width,
                             .cap = static_cast<Cap>(k % 3),
                             .join = static_cast<Join>(k / 3)});
        }
        return lines;
    }

    static const stroke::Model& shipped(const std::string& name) {
        static std::map<std::string, stroke::Model> known;
        if (!known.contains(name)) {
            stroke::ModelOptions options;
            options.unwrap.size = 4096;
            options.cache = stroke::shared_model_cache();
            known.emplace(name,
                          stroke::prepare_model(mesh::read_polygon_file(source_folder() + "/models/" + name), options));
        }
        return known.at(name);
    }

    const stroke::Model* model_ = nullptr;
    std::optional<stroke::Document> document_;
    std::vector<stroke::JournalEntry> entries_;
    stroke::Placement place_;
};

TEST_F(DrawnLines, HaveTheirEndsAndCornersOnASheet) {
    for (const double width : {1.6, 3.0}) {
        draw("sheet.ply", Vec3(0), text_of(all(width), ""));
        ASSERT_EQ(entries_.size(), 12u);
        check(all(width));
    }
}

TEST_F(DrawnLines, HaveTheirEndsAndCornersOnABowl) {
    const double width = 2.2;
    draw("bowl.ply", {0, -0.08, 0.03}, text_of(all(width), ""));
    // Of a geodesic map, sin(r/R)/(r/R) at r = 40 mm on R = 80 mm.
    check(all(width), 0.04);
}

TEST_F(DrawnLines, AWideOneIsExactToItsCorners) {
    std::vector<Line> lines;
    for (int k = 0; k < 4; ++k)
        lines.push_back({.from = {20, 20.0 * k + 16},
                         .corner = {75, 20.0 * k + 16},
                         .to = {62, 20.0 * k + 29},
                         .width = 6,
                         .cap = static_cast<Cap>(k % 3),
                         .join = static_cast<Join>(k)});
    draw("sheet.ply", Vec3(0), text_of(lines, ""));
    check(lines);
}

TEST_F(DrawnLines, DashesAreLinesWithTheirOwnEnds) {
    const Line whole{.from = {15, 50}, .corner = {50, 50}, .to = {80, 50}, .width = 3, .cap = Cap::round};
    draw("sheet.ply", Vec3(0), text_of({whole}, "stroke-dasharray='6 7' stroke-dashoffset='2'"));
    ASSERT_EQ(entries_.size(), 6u) << "65 mm from 2 mm on, by 13 mm";
    std::vector<Line> dashes;
    for (int k = 0; k < 6; ++k) {
        const double from = 15 + 13 * k - (k > 0 ? 2 : 0), to = std::min(15.0 + 13 * k + 4, 80.0);
        dashes.push_back(
            {.from = {from, 50}, .corner = {0.5 * (from + to), 50}, .to = {to, 50}, .width = 3, .cap = Cap::round});
    }
    check(dashes);
}

TEST_F(DrawnLines, NarrowOnesStayStrokesOfABrush) {
    draw("sheet.ply", Vec3(0), text_of({{.from = {20, 20}, .corner = {40, 20}, .to = {60, 40}, .width = 1}}, ""));
    ASSERT_EQ(entries_.size(), 1u);
    const auto* line = entries_[0].as<stroke::PaintStroke>();
    ASSERT_TRUE(line);
    EXPECT_TRUE(line->trace.outline.empty());
    EXPECT_NEAR(line->trace.line_width, 1e-3, 1e-9);
}

}  // namespace
}  // namespace tuft::io
