#include <filesystem>
#include <iostream>
#include <string>

#include "core/error.h"
#include "core/files/files.h"
#include "mesh/read/polygon_soup.h"
#include "shape.h"

namespace {

using namespace tuft;
using models::Shape;

struct Entry {
    const char* file;
    Shape (*make)();
};

constexpr Entry kModels[] = {
    {"bowl.ply", models::make_bowl},
    {"plate.ply", models::make_plate},
    {"vase.ply", models::make_vase},
    {"car.ply", models::make_car},
    {"sheet.ply", models::make_sheet},
    {"sphere.ply", models::make_sphere},
    {"cylinder.ply", models::make_cylinder},
    {"torus.ply", models::make_torus},
    {"thin_plate.ply", models::make_thin_plate},
};

mesh::PolygonSoup to_soup(const Shape& shape) {
    mesh::PolygonSoup soup;
    soup.polygon_start.push_back(0);
    for (const Vec3& p : shape.points) soup.points.push_back(p + 0.0);  // no negative zeros
    for (const auto& triangle : shape.triangles) {
        soup.corners.insert(soup.corners.end(), triangle.begin(), triangle.end());
        soup.polygon_start.push_back(static_cast<std::uint32_t>(soup.corners.size()));
    }
    return soup;
}

/// Same faces, and every coordinate within a micrometre: another C library may
/// round a sine differently in its last bit.
bool same_model(const mesh::PolygonSoup& made, const mesh::PolygonSoup& file) {
    if (made.points.size() != file.points.size() || made.corners != file.corners ||
        made.polygon_start != file.polygon_start)
        return false;
    for (std::size_t i = 0; i < made.points.size(); ++i)
        if (!(glm::length(made.points[i] - file.points[i]) <= 1e-3)) return false;
    return true;
}

int run(bool check, const std::filesystem::path& folder) {
    int differing = 0;
    for (const Entry& entry : kModels) {
        const Shape shape = entry.make();
        const bool is_open = entry.make == models::make_sheet;
        if (const std::string defect = models::solid_defect(shape); !is_open && !defect.empty())
            throw Error(entry.file, defect);
        const mesh::PolygonSoup soup = to_soup(shape);
        const std::filesystem::path path = folder / entry.file;
        if (!check) {
            mesh::write_ply(path, soup);
            std::cout << path.string() << ": " << shape.triangles.size() << " triangles\n";
        } else if (!same_model(soup, mesh::read_ply(read_file(path), path))) {
            std::cerr << path.string() << " is not what this program makes\n";
            ++differing;
        }
    }
    return differing == 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
    const bool check = argc == 3 && std::string(argv[1]) == "--check";
    if (argc != 2 && !check) {
        std::cerr << "usage: tuft-models [--check] FOLDER\n";
        return 2;
    }
    try {
        return run(check, argv[argc - 1]);
    } catch (const Error& error) {
        std::cerr << "tuft-models: " << error.what() << '\n';
        return 1;
    }
}
