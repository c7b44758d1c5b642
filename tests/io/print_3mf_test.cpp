#include "io/export/print_3mf.h"

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "core/files/files.h"
#include "ink/spectra/colorimetry.h"
#include "io/export/export.h"
#include "io/model/read_3mf.h"
#include "io/package/zip.h"
#include "io/package/zip_writer.h"
#include "sample_model.h"

namespace tuft::io {
namespace {

using namespace testing;

/// lib3mf 1.8, by its C interface; nothing where it is not installed.
class Lib3mf {
  public:
    Lib3mf() : library_(dlopen("lib3MF.so.1", RTLD_NOW | RTLD_LOCAL)) {}
    ~Lib3mf() {
        if (library_) dlclose(library_);
    }
    explicit operator bool() const { return library_; }

    struct Facts {
        bool read = false, valid = false;
        unsigned warnings = 0, vertices = 0, triangles = 0;
        int manifold = 0;
    };
    Facts read(const std::string& path) const {
        Facts facts;
        void *model = nullptr, *reader = nullptr, *meshes = nullptr, *object = nullptr;
        call("lib3mf_createmodel", &model);
        call("lib3mf_model_queryreader", model, "3mf", &reader);
        call("lib3mf_reader_setstrictmodeactive", reader, 1);
        facts.read = call("lib3mf_reader_readfromfileutf8", reader, path.c_str()) == 0;
        call("lib3mf_reader_getwarningcount", reader, &facts.warnings);
        call("lib3mf_model_getmeshobjects", model, &meshes);
        int more = 0, valid = 0;
        if (meshes) call("lib3mf_resourceiterator_movenext", meshes, &more);
        if (more) {
            call("lib3mf_resourceiterator_getcurrent", meshes, &object);
            call("lib3mf_object_isvalidobject", object, &valid);
            call("lib3mf_meshobject_getvertexcount", object, &facts.vertices);
            call("lib3mf_meshobject_gettrianglecount", object, &facts.triangles);
            call("lib3mf_meshobject_ismanifoldandoriented", object, &facts.manifold);
        }
        facts.valid = valid;
        for (void* instance : {object, meshes, reader, model})
            if (instance) call("lib3mf_release", instance);
        return facts;
    }

  private:
    template <class... Arguments>
    int call(const char* name, Arguments... arguments) const {
        using Function = int (*)(Arguments...);
        const auto function = reinterpret_cast<Function>(dlsym(library_, name));
        return function ? function(arguments...) : -1;
    }
    void* library_;
};

/// A tetrahedron of 20 mm: closed, four charts of a quarter of the atlas.
mesh::TriangleMesh tetrahedron() {
    mesh::TriangleMesh m;
    m.positions = {{0, 0, 0}, {0.02f, 0, 0}, {0, 0.02f, 0}, {0, 0, 0.02f}};
    m.triangles = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    for (std::size_t t = 0; t < 4; ++t) {
        const Vec2f at{0.5f * static_cast<float>(t % 2), 0.5f * static_cast<float>(t / 2)};
        for (const Vec2f& uv : {Vec2f{0.02f, 0.02f}, Vec2f{0.48f, 0.02f}, Vec2f{0.02f, 0.48f}})
            m.corner_uvs.push_back(at + uv);
        m.corner_normals.insert(m.corner_normals.end(), 3, Vec3f(mesh::face_normal(m, t)));
    }
    m.neighbours.assign(12, 0);
    for (const Vec3f& p : m.positions) m.bounds.add(Vec3(p));
    return m;
}

constexpr std::uint32_t kSize = 128;

/// White, with a blue disc in the middle of each quarter.
ink::AtlasMap<float> discs() {
    ink::AtlasMap<float> map{kSize, 3, {}};
    for (std::uint32_t y = 0; y < kSize; ++y)
        for (std::uint32_t x = 0; x < kSize; ++x) {
            const double dx = x % 64 - 20.0, dy = y % 64 - 20.0;
            const bool blue = dx * dx + dy * dy < 100;
            map.texels.insert(map.texels.end(), {blue ? 0.02f : 0.9f, blue ? 0.03f : 0.9f, blue ? 0.3f : 0.88f});
        }
    return map;
}

PaintOptions white_and_blue(double detail) {
    return {.filaments = {{"white", {0.9f, 0.9f, 0.88f}, 0}, {"blue & <deep>", {0.02f, 0.03f, 0.3f}, 0}},
            .detail = detail,
            .progress = {}};
}

double area_of(const PaintedTriangles& p, std::uint32_t filament) {
    double sum = 0;
    for (std::size_t t = 0; t < p.triangles.size(); ++t) {
        const auto& v = p.triangles[t];
        const Vec3 a = p.positions[v[0]];
        if (p.filament[t] == filament)
            sum += 0.5 * glm::length(glm::cross(p.positions[v[1]] - a, p.positions[v[2]] - a));
    }
    return sum;
}

TEST(Print3mf, HalvedTrianglesLeaveNoCrackAndKeepTheSurface) {
    const mesh::TriangleMesh mesh = tetrahedron();
    const atlas::Atlas atlas = cylinder_atlas(mesh, kSize);
    const PaintedTriangles painted = paint_triangles(mesh, atlas, discs(), white_and_blue(0.5e-3));
    EXPECT_GT(painted.triangles.size(), 100u);
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // each is used once in each direction
    for (const auto& v : painted.triangles)
        for (std::size_t k = 0; k < 3; ++k) ++edges[{v[k], v[(k + 1) % 3]}];
    for (const auto& [edge, n] : edges) {
        ASSERT_EQ(n, 1);
        ASSERT_EQ(edges.count({edge.second, edge.first}), 1u);
    }
    const double whole = mesh::surface_area(mesh);
    EXPECT_NEAR(area_of(painted, 0) + area_of(painted, 1), whole, 1e-9 * whole);
}

TEST(Print3mf, PaintedAreaAndColourComeNearerWithTheDetail) {
    const mesh::TriangleMesh mesh = tetrahedron();
    const atlas::Atlas atlas = cylinder_atlas(mesh, kSize);
    // A disc of 305 texels (x² + y² < 100) in a triangle that spans 58.88 texels on two sides.
    double blue = 0, last_difference = 1e9;
    for (std::size_t t = 0; t < 4; ++t) {
        const Vec3 a = mesh.position(t, 0);
        const double area = 0.5 * glm::length(glm::cross(mesh.position(t, 1) - a, mesh.position(t, 2) - a));
        blue += area * 305 / (0.5 * 58.88 * 58.88);
    }
    for (const double detail : {8e-3, 2e-3, 0.5e-3, 0.25e-3}) {
        const PaintedTriangles painted = paint_triangles(mesh, atlas, discs(), white_and_blue(detail));
        EXPECT_LT(painted.mean_delta_e, last_difference);
        last_difference = painted.mean_delta_e;
        // Triangles on the rim are one colour or the other: a band as wide as an edge, of which a tenth errs.
        if (detail < 1e-3) {
            EXPECT_NEAR(area_of(painted, 1), blue, 0.03 * blue);
        }
    }
    EXPECT_LT(last_difference, 3);  // ΔE of the two is 76; the rim is 4 % of the surface
}

TEST(Print3mf, PaintedFileReadsBackAndLib3mfFindsNoFault) {
    const Folder folder("painted3mf");
    const mesh::TriangleMesh mesh = tetrahedron();
    const PaintOptions options = white_and_blue(1e-3);
    const PaintedTriangles painted = paint_triangles(mesh, cylinder_atlas(mesh, kSize), discs(), options);
    write_painted_3mf(folder / "p.3mf", painted, options.filaments, true);
    const mesh::PolygonSoup soup = read_3mf(read_file(folder / "p.3mf"), folder / "p.3mf");
    ASSERT_EQ(soup.n_polygons(), painted.triangles.size());
    ASSERT_EQ(soup.group_names.size(), 2u);
    std::map<std::string, std::size_t> triangles;
    for (const std::uint32_t g : soup.polygon_groups) ++triangles[soup.group_names[g]];
    std::size_t blue = 0;
    for (const std::uint32_t f : painted.filament) blue += f;
    bool found = false;
    for (const auto& [name, n] : triangles) found |= name.find("blue & <deep>") != name.npos && n == blue;
    EXPECT_TRUE(found);
    const Lib3mf lib3mf;
    if (!lib3mf) GTEST_SKIP() << "lib3mf is not installed";
    const Lib3mf::Facts facts = lib3mf.read((folder / "p.3mf").string());
    EXPECT_TRUE(facts.read);
    EXPECT_TRUE(facts.valid);
    EXPECT_EQ(facts.warnings, 0u);
    EXPECT_EQ(facts.triangles, painted.triangles.size());
    EXPECT_EQ(facts.vertices, painted.positions.size());
    EXPECT_TRUE(facts.manifold);
}

TEST(Print3mf, TexturedFileReadsBackAndLib3mfFindsNoFault) {
    const Folder folder("textured3mf");
    const mesh::TriangleMesh mesh = tetrahedron();
    export_model(folder / "t.3mf", mesh, cylinder_atlas(mesh, 64), pattern_maps(64));
    EXPECT_EQ(folder.n_files(), 1u);
    const mesh::PolygonSoup soup = read_3mf(read_file(folder / "t.3mf"), folder / "t.3mf");
    ASSERT_EQ(soup.n_polygons(), mesh.n_triangles());
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            // Nine digits hold a float; millimetres and back round once more.
            EXPECT_LT(glm::length(soup.points[soup.corners[3 * t + k]] - mesh.position(t, static_cast<int>(k))), 1e-9);
            EXPECT_EQ(soup.corner_uvs[3 * t + k], mesh.corner_uvs[3 * t + k]);
        }
    const std::vector<char> bytes = read_file(folder / "t.3mf");
    Zip zip(bytes, "t.3mf");
    EXPECT_TRUE(zip.has("3D/Textures/t_base_colour.png"));
    const Lib3mf lib3mf;
    if (!lib3mf) GTEST_SKIP() << "lib3mf is not installed";
    const Lib3mf::Facts facts = lib3mf.read((folder / "t.3mf").string());
    EXPECT_TRUE(facts.read);
    EXPECT_TRUE(facts.valid);
    EXPECT_EQ(facts.warnings, 0u);
    EXPECT_EQ(facts.triangles, 4u);
}

/// Number of triangles by their paint in the file of PrusaSlicer or in ours.
std::map<std::string, int> paint_in(const std::filesystem::path& path) {
    const std::vector<char> bytes = read_file(path);
    Zip zip(bytes, path.string());
    const std::vector<char> entry = zip.read("3D/3dmodel.model");
    const std::string text(entry.begin(), entry.end()), key = "slic3rpe:mmu_segmentation=\"";
    std::map<std::string, int> paint;
    for (auto at = text.find(key); at != text.npos; at = text.find(key, at + 1))
        ++paint[text.substr(at + key.size(), text.find('"', at + key.size()) - at - key.size())];
    return paint;
}

TEST(Print3mf, PrusaSlicerReadsThePaintAndWritesItAgain) {
    const Folder folder("prusa");
    const std::string log = (folder / "log").string(), out = (folder / "back.3mf").string();
    if (std::system("command -v prusa-slicer > /dev/null")) GTEST_SKIP() << "PrusaSlicer is not installed";
    const mesh::TriangleMesh mesh = tetrahedron();
    const PaintOptions options = white_and_blue(2e-3);
    write_painted_3mf(folder / "p.3mf", paint_triangles(mesh, cylinder_atlas(mesh, kSize), discs(), options),
                      options.filaments, true);
    const std::string in = (folder / "p.3mf").string(), to_log = " >> '" + log + "' 2>&1";
    ASSERT_EQ(std::system(("prusa-slicer --info '" + in + "'" + to_log).c_str()), 0);
    ASSERT_EQ(std::system(("prusa-slicer --export-3mf -o '" + out + "' '" + in + "'" + to_log).c_str()), 0);
    const std::vector<char> bytes = read_file(log);
    const std::string said(bytes.begin(), bytes.end());
    EXPECT_NE(said.find("size_x = 20.000000"), said.npos) << said;
    EXPECT_NE(said.find("manifold = yes"), said.npos) << said;
    EXPECT_FALSE(paint_in(folder / "p.3mf").empty());
    EXPECT_EQ(paint_in(out), paint_in(folder / "p.3mf"));
}

TEST(ZipWriter, EntriesComeBackAndTheSameEntriesAreTheSameBytes) {
    const auto archive = [] {
        ZipWriter zip;
        zip.add("mimetype", std::string("text/plain"), ZipWriter::Method::stored);
        zip.add("a/b.txt", std::string(10'000, 'x'));
        zip.add("empty", std::string());
        return zip.finish();
    };
    const std::vector<std::uint8_t> bytes = archive();
    EXPECT_EQ(bytes, archive());
    EXPECT_LT(bytes.size(), 600u);
    const std::vector<char> chars(bytes.begin(), bytes.end());
    Zip zip(chars, "test");
    EXPECT_EQ(zip.read("a/b.txt"), std::vector<char>(10'000, 'x'));
    EXPECT_EQ(zip.read("empty").size(), 0u);
    // Stored, at the offset where `file` looks for it.
    EXPECT_EQ(std::string(&chars[30], 18), "mimetypetext/plain");
}

}  // namespace
}  // namespace tuft::io
