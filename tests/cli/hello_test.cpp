#include <gtest/gtest.h>

#include <cstdlib>
#include <map>

#include "io/model/read_model.h"
#include "program.h"

/// \file
/// samples/hello: the program that a reader copies to begin with.
namespace tuft {
namespace {

class Hello : public test::Program {
  protected:
    /// Runs tuft-hello as a shell would.
    test::Ran hello(const std::string& model, const std::string& glb) const {
        const std::string command = "TUFT_DATA='" + source_folder() + "' '" TUFT_HELLO "' '" + model + "' '" +
                                    path(glb) + "' >'" + path(".out") + "' 2>'" + path(".err") + "'";
        const int raw = std::system(command.c_str());
        return {WIFEXITED(raw) ? WEXITSTATUS(raw) : 128 + WTERMSIG(raw), read(path(".out")), read(path(".err"))};
    }
};

// Texels that are more than 40 of 255 off the commonest colour, which is that of bare porcelain.
std::size_t inked_texels(const mesh::Picture& picture) {
    using Rgb = std::array<int, 3>;
    std::map<Rgb, std::size_t> count;
    const auto texel = [&](std::size_t i) {
        return Rgb{picture.rgb[3 * i], picture.rgb[3 * i + 1], picture.rgb[3 * i + 2]};
    };
    const std::size_t n = picture.rgb.size() / 3;
    for (std::size_t i = 0; i < n; ++i) ++count[texel(i)];
    const Rgb bare = std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) {
                         return a.second < b.second;
                     })->first;
    std::size_t inked = 0;
    for (std::size_t i = 0; i < n; ++i) {
        const Rgb c = texel(i);
        inked += std::abs(c[0] - bare[0]) > 40 || std::abs(c[1] - bare[1]) > 40 || std::abs(c[2] - bare[2]) > 40;
    }
    return inked;
}

TEST_F(Hello, PaintsOneStrokeThatIsInTheGlb) {
    for (const char* name : {"bowl.ply", "sphere.ply", "torus.ply"}) {
        SCOPED_TRACE(name);
        const test::Ran ran = hello(model(name), "hello.glb");
        ASSERT_EQ(ran.status, 0) << ran.err;
        unsigned charts = 0;
        double area = 0;
        ASSERT_EQ(std::sscanf(ran.out.c_str(), "%u charts, %lf mm2 of ink", &charts, &area), 2) << ran.out;
        // 40 mm of a brush of 7.4 mm across its belly: at least a hair line of 1 mm, at most its
        // widest all along.
        EXPECT_GT(area, 40);
        EXPECT_LT(area, 500);
        const mesh::PolygonSoup reread = io::read_model(path("hello.glb"));
        EXPECT_EQ(reread.n_polygons(), io::read_model(model(name)).n_polygons());
        ASSERT_EQ(reread.materials.size(), 1u);
        ASSERT_TRUE(reread.materials[0].picture);
        EXPECT_EQ(reread.materials[0].picture->width, 512);
        EXPECT_GT(inked_texels(*reread.materials[0].picture),
                  40u);  // texels are 1 mm wide at most
    }
}

TEST_F(Hello, SaysWhatIsWrongInOneLine) {
    const test::Ran ran = hello(path("none.ply"), "hello.glb");
    EXPECT_EQ(ran.status, 1);
    EXPECT_EQ(ran.error_lines(), 1);
    EXPECT_FALSE(std::filesystem::exists(path("hello.glb")));
}

}  // namespace
}  // namespace tuft
