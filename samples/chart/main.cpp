// A chart of pigments as they look in films of several thicknesses, mixed, and over each
// other: matte on white, matte on black, and under the glaze of porcelain.
#include <cstdio>
#include <string>
#include <vector>

#include "core/error.h"
#include "ink/composite/composite.h"
#include "io/image/image.h"

namespace {

using namespace tuft;

constexpr int kChip = 44, kGap = 4, kColumns = 5, kMargin = 16, kGroupGap = 20;
constexpr double kThickness[kColumns] = {0.1, 0.3, 0.8, 1.8, 4};

struct Part {
    const char* pigment;
    double film;
};
/// Films of a chip, the lowest first.
using Chip = std::vector<std::vector<Part>>;
using Row = std::vector<Chip>;

std::vector<ink::Substrate> backings() {
    ink::Substrate white, black;
    white.reflectance = {0.9f, 0.9f, 0.88f};
    black.reflectance = {0.03f, 0.03f, 0.03f};
    return {white, black, ink::load_substrate("porcelain")};
}

ink::Rgb colour_of(const Chip& chip, const ink::Substrate& backing) {
    std::vector<ink::Pigment> pigments;
    std::vector<ink::Plane> planes;
    planes.reserve(ink::kMaxPigments);
    std::vector<ink::TileFilm> films;
    for (const std::vector<Part>& film : chip) {
        films.emplace_back();
        for (const Part& part : film) {
            films.back().pigments[pigments.size()] = &planes.emplace_back();
            planes.back().fill(static_cast<float>(part.film));
            pigments.push_back(ink::load_pigment(part.pigment));
        }
    }
    const ink::TileAppearance look = ink::shade_films(films, nullptr, pigments, backing);
    return {look.colour[0][0], look.colour[1][0], look.colour[2][0]};
}

Row steps(const char* pigment) {
    Row row;
    for (const double x : kThickness) row.push_back({{{pigment, x}}});
    return row;
}

Row mixture(const char* a, const char* b) {
    Row row;
    for (int i = 0; i < kColumns; ++i) {
        const double part = i / (kColumns - 1.0);
        row.push_back({{{a, 2 * (1 - part)}, {b, 2 * part}}});
    }
    return row;
}

Row glazes(const char* below, const char* above) {
    Row row;
    for (const double x : {0.0, 0.15, 0.4, 0.9, 2.0}) row.push_back({{{below, 0.7}}, {{above, x}}});
    return row;
}

std::vector<std::vector<Row>> chart() {
    std::vector<std::vector<Row>> parts(3);
    for (const char* name : {"carbon-black", "bone-black", "cinnabar", "iron-red", "gamboge", "indigo",
                             "cobalt-underglaze", "titanium-white", "shell-white"})
        parts[0].push_back(steps(name));
    parts[1] = {mixture("gamboge", "indigo"),
                mixture("gamboge", "cobalt-underglaze"),
                mixture("gamboge", "cinnabar"),
                mixture("cinnabar", "indigo"),
                mixture("cinnabar", "titanium-white"),
                mixture("cobalt-underglaze", "titanium-white"),
                mixture("carbon-black", "titanium-white")};
    parts[2] = {glazes("gamboge", "indigo"), glazes("gamboge", "cinnabar"), glazes("cinnabar", "cobalt-underglaze"),
                glazes("cobalt-underglaze", "gamboge")};
    return parts;
}

void draw(const std::string& path) {
    const std::vector<std::vector<Row>> parts = chart();
    const std::vector<ink::Substrate> under = backings();
    int rows = 0;
    for (const auto& part : parts) rows += static_cast<int>(part.size());
    const int step = kChip + kGap, group = kColumns * step - kGap + 2 * kGroupGap;
    io::Image8 image{
        .width = 2 * kMargin + 3 * group, .height = 2 * kMargin + rows * step + 4 * kGroupGap, .channels = 3};
    image.pixels.assign(static_cast<std::size_t>(image.width) * image.height * 3, 235);
    const auto fill = [&](int x0, int y0, int width, int height, const ink::Rgb& colour) {
        for (int y = y0; y < y0 + height; ++y)
            for (int x = x0; x < x0 + width; ++x)
                for (int c = 0; c < 3; ++c)
                    image.pixels[(static_cast<std::size_t>(y) * image.width + x) * 3 + c] =
                        static_cast<std::uint8_t>(255 * ink::srgb_encode(colour[c]) + 0.5f);
    };
    for (std::size_t g = 0; g < under.size(); ++g)
        fill(kMargin + static_cast<int>(g) * group, kMargin, group, image.height - 2 * kMargin, under[g].reflectance);
    int y = kMargin + kGroupGap;
    for (const auto& part : parts) {
        for (const Row& row : part) {
            for (std::size_t g = 0; g < under.size(); ++g)
                for (std::size_t i = 0; i < row.size(); ++i)
                    fill(kMargin + static_cast<int>(g) * group + kGroupGap + static_cast<int>(i) * step, y, kChip,
                         kChip, colour_of(row[i], under[g]));
            y += step;
        }
        y += kGroupGap;
    }
    io::write_image(path, io::view_of(image));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: tuft-chart PICTURE.png\n");
        return 2;
    }
    try {
        draw(argv[1]);
    } catch (const tuft::Error& error) {
        std::fprintf(stderr, "tuft-chart: %s\n", error.what());
        return 1;
    }
    return 0;
}
