#include <gtest/gtest.h>

#include "mesh/read/polygon_soup.h"
#include "stroke/document/document.h"
#include "stroke/document/pick.h"

/// Where areas and strokes end: shut lines, openings, walls, borders.
namespace tuft::stroke {
namespace {

/// A quad from `corner` along `u` and `v`, millimetres, in cells of about 2 mm.
void add_quad(mesh::PolygonSoup& soup, const Vec3& corner, const Vec3& u, const Vec3& v) {
    const auto cells = [](const Vec3& d) { return std::max(1, static_cast<int>(glm::length(d) / 2)); };
    const int n = cells(u), m = cells(v);
    if (soup.polygon_start.empty()) soup.polygon_start.push_back(0);
    const auto first = static_cast<std::uint32_t>(soup.points.size());
    for (int j = 0; j <= m; ++j)
        for (int i = 0; i <= n; ++i) soup.points.push_back(corner + u * (double(i) / n) + v * (double(j) / m));
    for (std::uint32_t j = 0; j < static_cast<std::uint32_t>(m); ++j)
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i) {
            const std::uint32_t a = first + j * static_cast<std::uint32_t>(n + 1) + i, b = a + 1,
                                c = b + static_cast<std::uint32_t>(n + 1), d = c - 1;
            soup.corners.insert(soup.corners.end(), {a, b, c, d});
            soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
        }
}

/// Two panels beside a gap of 2 mm, the second with a wall of 6 mm down at its end, and a plate 15 mm below beyond it.
const Model& panels() {
    static const Model model = [] {
        mesh::PolygonSoup soup;
        add_quad(soup, {-30, -12, 0}, {29, 0, 0}, {0, 24, 0});
        add_quad(soup, {1, -12, 0}, {29, 0, 0}, {0, 24, 0});
        add_quad(soup, {30, -12, -6}, {0, 24, 0}, {0, 0, 6});
        add_quad(soup, {30.5, -12, -15}, {30, 0, 0}, {0, 24, 0});
        ModelOptions options;
        options.unwrap.size = 1024;
        return prepare_model(soup, options);
    }();
    return model;
}

/// A stripe of 6 mm along x over all of them, its middle on the second panel.
FlatArea stripe(SurfaceMapping mapping, AreaEdges edges) {
    FlatArea area{.rings = {{{-0.045, -0.003}, {0.04, -0.003}, {0.04, 0.003}, {-0.045, 0.003}}},
                  .placement = {.origin = {0.015, 0, 0}, .mapping = mapping},
                  .placed = true,
                  .edges = edges,
                  .low = {-0.045, -0.003},
                  .high = {0.04, 0.003},
                  .stops = {{.ink = "carbon", .film = 1}}};
    return area;
}

double ink_at(const Document& document, const Vec3& mm) {
    return pick(document, 1e-3 * mm).amounts[0] / document.materials().ink("carbon").strength();
}

TEST(Edges, CutEndsAtAnOpeningAndPassesAShutLine) {
    for (const SurfaceMapping mapping : {SurfaceMapping::project, SurfaceMapping::drape}) {
        Document document(panels());
        document.paint(fill_of_area(stripe(mapping, AreaEdges::cut)));
        for (const double x : {-25.0, -2.0, 2.0, 20.0, 29.0}) EXPECT_NEAR(ink_at(document, {x, 0, 0}), 1, 0.01) << x;
        EXPECT_EQ(ink_at(document, {20, 5, 0}), 0);
        EXPECT_EQ(ink_at(document, {45, 0, -15}), 0) << "beyond the opening";
        EXPECT_EQ(ink_at(document, {30, 0, -3}), 0) << "the wall";
    }
}

TEST(Edges, FacingPaintsWhatLiesBehindAndRunOverTheWallsToo) {
    Document facing(panels());
    facing.paint(fill_of_area(stripe(SurfaceMapping::project, AreaEdges::facing)));
    EXPECT_NEAR(ink_at(facing, {45, 0, -15}), 1, 0.01);
    EXPECT_EQ(ink_at(facing, {30, 0, -3}), 0);
    Document over(panels());
    over.paint(fill_of_area(stripe(SurfaceMapping::project, AreaEdges::run_over)));
    EXPECT_NEAR(ink_at(over, {45, 0, -15}), 1, 0.01);
    EXPECT_NEAR(ink_at(over, {30, 0, -3}), 1, 0.01);
}

TEST(Edges, AMaskClearOfEdgesLeavesItsMargin) {
    Document document(panels());
    MaskEdit edit;
    edit.mask = {.id = 1, .name = "clear", .kind = MaskKind::clear, .within = 0.5, .distance = 3e-3};
    document.paint(edit);
    Fill fill = fill_of_area(stripe(SurfaceMapping::project, AreaEdges::cut));
    fill.mask = 1;
    document.paint(fill);
    const double texel = 1e3 * panels().texels.texel_size;
    // The panels end at 1, 30 and -1 mm: the paint ends 3 mm before, within a texel.
    for (const double sign : {1.0, -1.0}) {
        EXPECT_EQ(ink_at(document, {sign * (4 - 1.5 * texel), 0, 0}), 0);
        EXPECT_NEAR(ink_at(document, {sign * (4 + 1.5 * texel), 0, 0}), 1, 0.01);
    }
    EXPECT_NEAR(ink_at(document, {27 - 1.5 * texel, 0, 0}), 1, 0.01);
    EXPECT_EQ(ink_at(document, {27 + 1.5 * texel, 0, 0}), 0);
    EXPECT_NEAR(ink_at(document, {15, 0, 0}), 1, 0.01) << "edges between triangles of one plane are not sharp";
}

TEST(Edges, AreKeptInTheJournal) {
    const FlatArea area = stripe(SurfaceMapping::drape, AreaEdges::cut);
    EXPECT_EQ(area_of_text(text_of(area)), area);
    EXPECT_EQ(text_of(stripe(SurfaceMapping::drape, AreaEdges::facing)).find("edges"), std::string::npos)
        << "as earlier versions wrote it";
    MaskTable table;
    EXPECT_THROW(apply(table, {.mask = {.name = "a", .kind = MaskKind::clear, .distance = 0}}), Error);
    EXPECT_THROW(apply(table, {.mask = {.name = "a", .kind = MaskKind::clear, .distance = 2}}), Error);
}

}  // namespace
}  // namespace tuft::stroke
