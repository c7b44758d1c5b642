#include <cmath>
#include <cstring>
#include <filesystem>
#include <iostream>
#include <string>

#include "core/error.h"
#include "core/files.h"
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

template <class T>
void put(std::vector<char>& out, T value) {
    const std::size_t at = out.size();
    out.resize(at + sizeof value);
    std::memcpy(out.data() + at, &value, sizeof value);
}

struct PlyBytes {
    std::vector<char> bytes;
    std::size_t points_at = 0;  ///< where the vertex floats start
    std::size_t faces_at = 0;   ///< where they end
};

PlyBytes to_ply(const Shape& shape) {
    const std::string header =
        "ply\nformat binary_little_endian 1.0\ncomment millimetres, z up\nelement vertex " +
        std::to_string(shape.points.size()) +
        "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
        std::to_string(shape.triangles.size()) +
        "\nproperty list uchar int vertex_indices\nend_header\n";
    PlyBytes ply{.bytes = {header.begin(), header.end()}, .points_at = header.size()};
    for (const Vec3& p : shape.points)
        for (int k = 0; k < 3; ++k) put(ply.bytes, static_cast<float>(p[k]) + 0.0f);
    ply.faces_at = ply.bytes.size();
    for (const auto& triangle : shape.triangles) {
        put(ply.bytes, std::uint8_t{3});
        for (const std::uint32_t corner : triangle) put(ply.bytes, corner);
    }
    return ply;
}

/// Same counts and faces, and every coordinate within a micrometre: another C
/// library may round a sine differently in its last bit.
bool same_model(const PlyBytes& made, const std::vector<char>& file) {
    if (made.bytes.size() != file.size()) return false;
    if (std::memcmp(made.bytes.data(), file.data(), made.points_at) != 0) return false;
    if (std::memcmp(made.bytes.data() + made.faces_at, file.data() + made.faces_at,
                    file.size() - made.faces_at) != 0)
        return false;
    for (std::size_t at = made.points_at; at < made.faces_at; at += sizeof(float)) {
        float a = 0, b = 0;
        std::memcpy(&a, made.bytes.data() + at, sizeof a);
        std::memcpy(&b, file.data() + at, sizeof b);
        if (!(std::abs(a - b) <= 1e-3f)) return false;
    }
    return true;
}

int run(bool check, const std::filesystem::path& folder) {
    int differing = 0;
    for (const Entry& entry : kModels) {
        const Shape shape = entry.make();
        const PlyBytes ply = to_ply(shape);
        const std::filesystem::path path = folder / entry.file;
        if (!check) {
            write_file(path, ply.bytes.data(), ply.bytes.size());
            std::cout << path.string() << ": " << shape.triangles.size() << " triangles\n";
        } else if (!same_model(ply, read_file(path))) {
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
