#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <meshoptimizer.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/files/files.h"
#include "core/random.h"
#include "gltf_maker.h"
#include "io/gltf/read_gltf.h"

/// Compressed glTF, by round trips: the test compresses with the libraries' own encoders.
namespace tuft::io {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;

constexpr int kSequential = 0, kEdgebreaker = 1;  ///< methods of Draco

/// A dome over a square: points with UVs, and a list of triangles.
struct Dome {
    std::vector<Vec3f> points;
    std::vector<Vec2f> uvs;
    std::vector<std::uint32_t> indices;

    explicit Dome(std::uint32_t n) {
        for (std::uint32_t j = 0; j <= n; ++j)
            for (std::uint32_t i = 0; i <= n; ++i) {
                const Vec2f uv = Vec2f(float(i), float(j)) / float(n);
                points.push_back({uv.x, std::sin(3 * uv.x) * std::sin(3 * uv.y), uv.y});
                uvs.push_back(uv);
            }
        for (std::uint32_t j = 0; j < n; ++j)
            for (std::uint32_t i = 0; i < n; ++i) {
                const std::uint32_t a = j * (n + 1) + i, b = a + n + 1;
                for (const std::uint32_t v : {a, b, a + 1, a + 1, b, b + 1}) indices.push_back(v);
            }
    }
};

using Bytes = std::vector<unsigned char>;

template <class T>
Bytes bytes_of(const std::vector<T>& values) {
    Bytes out(values.size() * sizeof(T));
    std::memcpy(out.data(), values.data(), out.size());
    return out;
}

/// A GLB with one mesh; views are set by its makers.
class Maker {
  public:
    json document = json::parse(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
      "meshes":[{"name":"dome","primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"indices":2}]}]})");

    explicit Maker(const Dome& dome) {
        document["accessors"] = {{{"componentType", 5126}, {"count", dome.points.size()}, {"type", "VEC3"}},
                                 {{"componentType", 5126}, {"count", dome.uvs.size()}, {"type", "VEC2"}},
                                 {{"componentType", 5125}, {"count", dome.indices.size()}, {"type", "SCALAR"}}};
    }
    std::size_t append(const Bytes& bytes) {
        buffer.resize((buffer.size() + 3) / 4 * 4);
        buffer.insert(buffer.end(), bytes.begin(), bytes.end());
        return buffer.size() - bytes.size();
    }
    void require(const char* extension) { document["extensionsUsed"] = document["extensionsRequired"] = {extension}; }
    std::vector<char> glb() const {
        json full = document;
        full["buffers"][0]["byteLength"] = buffer.size();
        return test::glb_of(full, {reinterpret_cast<const char*>(buffer.data()), buffer.size()});
    }

    Bytes buffer;
};

Maker plain(const Dome& dome) {
    Maker maker(dome);
    int view = 0;
    for (const Bytes& bytes : {bytes_of(dome.points), bytes_of(dome.uvs), bytes_of(dome.indices)}) {
        maker.document["bufferViews"].push_back(
            {{"buffer", 0}, {"byteOffset", maker.append(bytes)}, {"byteLength", bytes.size()}});
        maker.document["accessors"][static_cast<std::size_t>(view)]["bufferView"] = view;
        ++view;
    }
    return maker;
}

/// By a program of its own (draco_sample.cpp), whose attributes have the ids 0 and 1.
Maker by_draco(const Dome& dome, int method, int bits) {
    const std::string folder = ::testing::TempDir() + "tuft_draco_" + std::to_string(::getpid());
    std::filesystem::create_directories(folder);
    const std::string raw = folder + "/mesh", packed = folder + "/packed";
    std::ofstream file(raw, std::ios::binary);
    const std::array<std::uint32_t, 2> counts{static_cast<std::uint32_t>(dome.points.size()),
                                              static_cast<std::uint32_t>(dome.indices.size())};
    file.write(reinterpret_cast<const char*>(counts.data()), sizeof counts);
    for (const Bytes& all : {bytes_of(dome.points), bytes_of(dome.uvs), bytes_of(dome.indices)})
        file.write(reinterpret_cast<const char*>(all.data()), static_cast<std::streamsize>(all.size()));
    file.close();
    const std::string command = std::string(TUFT_DRACO_SAMPLE) + " " + std::to_string(method) + " " +
                                std::to_string(bits) + " <'" + raw + "' >'" + packed + "'";
    EXPECT_EQ(std::system(command.c_str()), 0);
    const std::vector<char> stream = read_file(packed);
    std::filesystem::remove_all(folder);
    Maker maker(dome);
    const Bytes bytes(stream.begin(), stream.end());
    maker.document["bufferViews"] = {
        {{"buffer", 0}, {"byteOffset", maker.append(bytes)}, {"byteLength", bytes.size()}}};
    maker.document["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
        {"bufferView", 0}, {"attributes", {{"POSITION", 0}, {"TEXCOORD_0", 1}}}};
    maker.require("KHR_draco_mesh_compression");
    return maker;
}

/// With a second buffer to decode into, as gltfpack writes it.
Maker by_meshopt(const Dome& dome) {
    Maker maker(dome);
    std::size_t at = 0;
    const auto add = [&](const Bytes& packed, std::size_t count, std::size_t stride, const char* mode) {
        const std::size_t view = maker.document["bufferViews"].size();
        json stream{{"buffer", 0},
                    {"byteOffset", maker.append(packed)},
                    {"byteLength", packed.size()},
                    {"byteStride", stride},
                    {"count", count},
                    {"mode", mode}};
        maker.document["bufferViews"].push_back({{"buffer", 1},
                                                 {"byteOffset", at},
                                                 {"byteLength", count * stride},
                                                 {"extensions", {{"EXT_meshopt_compression", std::move(stream)}}}});
        maker.document["accessors"][view]["bufferView"] = view;
        at += count * stride;
    };
    const auto vertices = [&](const auto& values) {
        const std::size_t stride = sizeof values[0];
        Bytes packed(meshopt_encodeVertexBufferBound(values.size(), stride));
        packed.resize(meshopt_encodeVertexBuffer(packed.data(), packed.size(), values.data(), values.size(), stride));
        add(packed, values.size(), stride, "ATTRIBUTES");
    };
    vertices(dome.points);
    vertices(dome.uvs);
    Bytes packed(meshopt_encodeIndexBufferBound(dome.indices.size(), dome.points.size()));
    packed.resize(meshopt_encodeIndexBuffer(packed.data(), packed.size(), dome.indices.data(), dome.indices.size()));
    add(packed, dome.indices.size(), 4, "TRIANGLES");
    maker.document["buffers"] = {
        json::object(), {{"byteLength", at}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    maker.require("EXT_meshopt_compression");
    return maker;
}

mesh::PolygonSoup read(const Maker& maker) {
    return read_gltf(maker.glb(), "x.glb");
}

/// Each triangle as its three corners, point and UV, the least first; sorted.
std::vector<std::array<std::array<double, 5>, 3>> triangles_of(const mesh::PolygonSoup& soup) {
    std::vector<std::array<std::array<double, 5>, 3>> out;
    for (std::size_t p = 0; p < soup.n_polygons(); ++p) {
        std::array<std::array<double, 5>, 3> t;
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t c = soup.polygon_start[p] + k;
            const Vec3& at = soup.points[soup.corners[c]];
            t[k] = {at.x, at.y, at.z, double(soup.corner_uvs[c].x), double(soup.corner_uvs[c].y)};
        }
        std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
        out.push_back(t);
    }
    std::sort(out.begin(), out.end());
    return out;
}

std::string fault(const Maker& maker) {
    try {
        read(maker);
    } catch (const Error& e) {
        return e.what();
    }
    return "read without complaint";
}

TEST(CompressedGltf, OfMeshoptHasTheSameTrianglesToTheBit) {
    const Dome dome(30);
    const Maker packed = by_meshopt(dome);
    EXPECT_LT(packed.buffer.size(), plain(dome).buffer.size() * 2 / 3);
    EXPECT_EQ(triangles_of(read(packed)), triangles_of(read(plain(dome))));
}

TEST(CompressedGltf, OfDracoHasTheSameTrianglesToTheBitWhereNothingIsRounded) {
    const Dome dome(30);
    for (const int method : {kSequential, kEdgebreaker})
        EXPECT_EQ(triangles_of(read(by_draco(dome, method, 0))), triangles_of(read(plain(dome)))) << method;
}

TEST(CompressedGltf, OfDracoIsAsExactAsItWasRounded) {
    const Dome dome(30);
    constexpr int kBits = 12;
    const auto rounded = triangles_of(read(by_draco(dome, kEdgebreaker, kBits)));
    // UVs are not rounded: they say which corner is which.
    std::map<std::pair<double, double>, std::array<double, 5>> point_at;
    for (const auto& t : triangles_of(read(plain(dome))))
        for (const auto& corner : t) point_at[{corner[3], corner[4]}] = corner;
    ASSERT_EQ(rounded.size(), dome.indices.size() / 3);
    double worst = 0;
    for (const auto& t : rounded)
        for (const auto& corner : t) {
            const auto& exact = point_at.at({corner[3], corner[4]});
            for (std::size_t k = 0; k < 3; ++k) worst = std::max(worst, std::abs(corner[k] - exact[k]));
        }
    // Half a step of the largest extent, which is that of the height, and a float's rounding.
    EXPECT_LE(worst, 0.5 * 2 / ((1 << kBits) - 1) + 1e-6);
    EXPECT_GT(worst, 0);
}

TEST(CompressedGltf, LeavesADocumentThatExportsCanWriteWithoutTheLibraries) {
    const Dome dome(5);
    for (const Maker& maker : {by_draco(dome, kEdgebreaker, 0), by_meshopt(dome)}) {
        const mesh::PolygonSoup soup = read(maker);
        EXPECT_EQ(soup.scene->document.find("compression"), std::string::npos);
        EXPECT_THAT(soup.scene->document, HasSubstr("\"dome\""));
    }
}

TEST(CompressedGltf, ThatAnnouncesMoreThanItsBytesCanSayIsRefusedBeforeMemoryIsTaken) {
    const Dome dome(5);
    Maker views = by_meshopt(dome);
    views.document["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["count"] = std::uint64_t{1} << 40;
    EXPECT_THAT(fault(views), HasSubstr("announces more than its bytes can say"));
    views = by_meshopt(dome);
    views.document["bufferViews"][1]["extensions"]["EXT_meshopt_compression"]["byteLength"] = 1 << 30;
    EXPECT_THAT(fault(views), HasSubstr("announces more than its bytes can say"));
    Maker faces = by_draco(dome, kSequential, 0);
    // The number of faces comes first, seven bits a byte: 50, one byte; now three bytes of a large number.
    ASSERT_EQ(faces.buffer[11], 50);
    faces.buffer[11] = 0xff;
    faces.buffer[12] = 0xff;
    faces.buffer[13] = 0x7f;
    EXPECT_THAT(fault(faces), HasSubstr("announces more than its bytes can say"));
}

TEST(CompressedGltf, ThatIsDamagedIsReadOrRefusedInOneLine) {
    const Dome dome(8);
    Random random(7);
    for (const Maker& whole : {by_draco(dome, kEdgebreaker, 10), by_draco(dome, kSequential, 10), by_meshopt(dome)}) {
        std::size_t refused = 0;
        for (int n = 0; n < 400; ++n) {
            Maker damaged = whole;
            for (int k = 0; k < 3; ++k)
                damaged.buffer[static_cast<std::size_t>(random.uniform() * static_cast<double>(whole.buffer.size()))] ^=
                    static_cast<unsigned char>(1u << static_cast<unsigned>(random.uniform() * 8));
            const std::string words = fault(damaged);
            EXPECT_EQ(words.find('\n'), words.npos) << words;
            if (words != "read without complaint") ++refused;
        }
        EXPECT_GT(refused, 20u);
    }
}

}  // namespace
}  // namespace tuft::io
