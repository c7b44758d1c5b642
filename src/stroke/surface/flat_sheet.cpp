#include "stroke/surface/flat_sheet.h"

#include <stdexcept>

namespace tuft::stroke {

Model make_flat_sheet(const FlatSheet& sheet) {
    const double side = sheet.texel * sheet.texels;
    const Vec2 size = sheet.high - sheet.low, first = sheet.low - sheet.corner, last = sheet.high - sheet.corner;
    if (!(size.x > 0 && size.y > 0 && sheet.columns > 0 && sheet.rows > 0 && side > 0))
        throw std::invalid_argument("a flat sheet without area");
    if (!(first.x >= 0 && first.y >= 0 && last.x <= side && last.y <= side))
        throw std::invalid_argument("a flat sheet that reaches out of its atlas");
    mesh::PolygonSoup soup;
    std::vector<Vec2f> uvs;
    for (int j = 0; j <= sheet.rows; ++j)
        for (int i = 0; i <= sheet.columns; ++i) {
            const Vec2 at = sheet.low + size * Vec2(i, j) / Vec2(sheet.columns, sheet.rows);
            soup.points.push_back(sheet.frame.to_world(Vec3(at, 0)));
            uvs.emplace_back((at - sheet.corner) / side);
        }
    soup.polygon_start.push_back(0);
    const auto add = [&](std::initializer_list<int> corners) {
        for (const int c : corners) {
            soup.corners.push_back(static_cast<std::uint32_t>(c));
            soup.corner_uvs.push_back(uvs[static_cast<std::size_t>(c)]);
        }
        soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    };
    for (int j = 0; j < sheet.rows; ++j)
        for (int i = 0; i < sheet.columns; ++i) {
            const int a = j * (sheet.columns + 1) + i, b = a + sheet.columns + 1;
            add({a, a + 1, b + 1});
            add({a, b + 1, b});
        }
    ModelOptions options;
    options.repair.metres_per_unit = 1;
    options.repair.sides = mesh::OpenSides::file;
    options.unwrap.size = sheet.texels;
    options.unwrap.uvs = atlas::UvPolicy::keep;
    options.texels = atlas::TexelStore::floats;
    return prepare_model(std::move(soup), options);
}

}  // namespace tuft::stroke
