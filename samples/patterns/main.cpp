// Three things that cross many seams, each drawn twice: as it is, and with the seams of the
// atlas in red. Nobody should be able to tell from the first where they are.
//   tuft-patterns FOLDER [car | bowl | plate]

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numbers>
#include <string>

#include "atlas/texels/seams.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/text/units.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "render/picture/picture.h"
#include "roller.h"
#include "stroke/document/document.h"

namespace tuft::samples {
namespace {

using std::numbers::pi;

stroke::Model load(const char* name, std::uint32_t size = 4096) {
    stroke::ModelOptions options;
    options.unwrap.size = size;
    return stroke::prepare_model(io::read_model(data_folder() / "models" / (std::string(name) + ".ply")), options);
}

void draw_seams(const stroke::Model& model, ink::AtlasMap<float>& colour) {
    std::vector<atlas::SeamSample> samples;
    for (const atlas::SeamEdge& edge : atlas::find_seams(*model.mesh, model.atlas))
        atlas::sample_seam(*model.mesh, model.atlas, edge, 0.5, samples);
    const auto size = static_cast<int>(colour.size);
    for (const atlas::SeamSample& s : samples) {
        for (const atlas::SeamSide* side : {&s.a, &s.b}) {
            for (int dy = -2; dy <= 2; ++dy) {
                for (int dx = -2; dx <= 2; ++dx) {
                    const int x = static_cast<int>(side->uv.x) + dx, y = static_cast<int>(side->uv.y) + dy;
                    if (x < 0 || y < 0 || x >= size || y >= size) continue;
                    float* texel = &colour.texels[3 * (std::size_t(y) * size + x)];
                    texel[0] = 0.8f;
                    texel[1] = texel[2] = 0.02f;
                }
            }
        }
    }
}

void draw(const stroke::Document& painting, const render::View& view, const std::filesystem::path& out) {
    const stroke::Model& model = painting.model();
    const stroke::Appearance& shown = painting.appearance();
    for (const bool seams : {false, true}) {
        ink::AtlasMap<float> colour =
            ink::compose_linear(shown.stack(), model.texels, shown.substrate(), shown.compose_options());
        if (seams) draw_seams(model, colour);
        render::Appearance look;
        const ink::Substrate& substrate = shown.substrate();
        look.finish = substrate.roughness > 0.45f ? render::Finish::clay : render::Finish::porcelain;
        look.body_colour = Vec3f(substrate.reflectance[0], substrate.reflectance[1], substrate.reflectance[2]);
        look.maps.size = colour.size;
        look.maps.corner_uvs = model.atlas.corner_uvs;
        look.maps.base_colour = {reinterpret_cast<const Vec3f*>(colour.texels.data()),
                                 std::size_t{colour.size} * colour.size};
        render::PictureOptions options{.width = 1280, .height = 800, .view = view};
        const render::Image image = render::render_picture(*model.mesh, *model.query, look, options);
        std::filesystem::path file = out;
        file += seams ? "-seams.png" : ".png";
        io::write_image(file, io::view_of(image.width, image.height, 3, image.rgb.data()));
        std::printf("%s\n", file.c_str());
    }
}

// A document whose texels come from elsewhere, not from strokes.
void show(const stroke::Model& model, const std::string& substrate, ink::Canvas canvas, const render::View& view,
          const std::filesystem::path& out) {
    stroke::Document painting(model, {.substrate = substrate});
    painting.adopt({}, {{stroke::kFirstLayer, std::move(canvas)}}, 0);
    draw(painting, view, out);
}

/// 20 mm checks, four abreast, over bonnet, its edge, the shoulder and the wheel arch.
void car(const std::filesystem::path& folder) {
    const stroke::Model model = load("car", 8192);
    ink::Canvas canvas(model.texels.n_slots());
    const int pigment = canvas.add_pigment(ink::load_ink("carbon").parts[0].pigment);
    const double check = 20 * kMillimetre, step = check / 48, length = 12 * check;
    const auto track = straight_track(model, {0.34, -0.02, 0.25}, {0.08, -1, 0}, step, 12 * 48);
    roll(model, canvas, track, {pigment, 2.5f, step, 4 * check}, [&](double x, double v) {
        if (x < 0 || x > length || std::abs(v) > 2 * check) return false;
        return static_cast<int>(std::floor(x / check) + std::floor(v / check)) % 2 == 0;
    });
    render::View view{.azimuth = 15 * kDegree, .elevation = 28 * kDegree};
    view.target = Vec3{0.36, -0.18, 0.19};
    view.width_at_target = 0.42;
    show(model, "clay", std::move(canvas), view, folder / "car-checks");
}

/// A band of waves between two lines round the plate's rim; its ends meet.
void plate(const std::filesystem::path& folder) {
    const stroke::Model model = load("plate");
    ink::Canvas canvas(model.texels.n_slots());
    const int pigment = canvas.add_pigment(ink::load_ink("cobalt").parts[0].pigment);
    const double radius = 113.5 * kMillimetre;
    constexpr int kPeriods = 48, kRows = 180;  // of a period
    const double step = 2 * pi * radius / (kPeriods * kRows), period = kRows * step;
    const auto track = ring(model, radius, 0.1, kPeriods * kRows);
    roll(model, canvas, track, {pigment, 2.0f, step, 18 * kMillimetre}, [&](double x, double v) {
        const double mm = v / kMillimetre;
        if (std::abs(std::abs(mm) - 8) < 0.4) return true;
        if (std::abs(mm - 3.6 * std::sin(2 * pi * x / period)) < 0.7) return true;
        // Dots in the bends.
        const double s = x - period * std::floor(x / period);
        return std::hypot(s - 0.25 * period, v + 0.5 * kMillimetre) < 1.3 * kMillimetre ||
               std::hypot(s - 0.75 * period, v - 0.5 * kMillimetre) < 1.3 * kMillimetre;
    });
    show(model, "porcelain", std::move(canvas), {.azimuth = 0, .elevation = 60 * kDegree}, folder / "plate-ring");
}

/// A stroke with a brush from inside over the rim to the outside.
void bowl(const std::filesystem::path& folder) {
    const stroke::Model model = load("bowl");
    stroke::Document painting(model);
    stroke::PaintStroke s;
    s.trace.flat = false;
    s.brush = "wolf-small";
    s.ink = "cinnabar";
    const double length = painting.materials().brush(s.brush).length, step = 0.25 * kMillimetre;
    const auto track = straight_track(model, {0.035, -0.01, 0.02}, glm::normalize(Vec3{1, -0.3, 0.6}), step, 400);
    const auto rim = std::max_element(track.begin(), track.end(), [](const Contact& a, const Contact& b) {
        return a.frame.origin.z < b.frame.origin.z;
    });
    double time = 0;
    Vec3 before{0};
    for (std::size_t i = 0; i < track.size(); ++i) {
        const double part = double(i) / double(track.size() - 1);
        // Lighter on the edge, where the hair is pressed over a narrow lip: it comes there 4 mm behind the hand.
        const double behind_rim = (double(i) - double(rim - track.begin())) * step - 4 * kMillimetre;
        const double over = 1 - 0.3 * std::exp(-std::pow(behind_rim / (5 * kMillimetre), 2));
        const double press = 4 * kMillimetre * over * std::min({1.0, part / 0.2, (1 - part) / 0.3});
        // The holder turns over the rim gently: its axis is the mean normal of 15 mm of the path.
        Vec3 n{0};
        for (int k = -30; k <= 30; ++k)
            n += track[std::clamp<std::ptrdiff_t>(std::ptrdiff_t(i) + k, 0, std::ptrdiff_t(track.size()) - 1)].frame.n;
        n = glm::normalize(n);
        const Frame f = make_frame(Vec3{0}, n, track[i].frame.t);
        stroke::StrokeSample p;
        p.position = track[i].frame.origin + (length - press) * n;
        p.rotation = glm::quat_cast(Mat3(f.t, f.b, f.n));
        if (i > 0) time += std::max(step, glm::length(p.position - before)) / 0.06;
        before = p.position;
        p.time = time;
        s.trace.samples.push_back(p);
    }
    const stroke::StrokeReport report = painting.paint(s);
    std::printf("%zu stamps, %.1f film units · mm²\n", report.stamps, report.ink_given * 1e6);
    const render::View outside{.azimuth = 60 * kDegree, .elevation = 25 * kDegree};
    const render::View inside{.azimuth = -70 * kDegree, .elevation = 45 * kDegree};
    draw(painting, outside, folder / "bowl-outside");
    draw(painting, inside, folder / "bowl-inside");
    render::View near{.azimuth = 60 * kDegree, .elevation = 55 * kDegree};
    near.target = rim->frame.origin;
    near.width_at_target = 0.03;
    draw(painting, near, folder / "bowl-rim");
}

}  // namespace
}  // namespace tuft::samples

int main(int argc, char** argv) {
    const std::string only = argc > 2 ? argv[2] : "";
    if (argc < 2 || argv[1][0] == '-' || !(only.empty() || only == "car" || only == "bowl" || only == "plate")) {
        std::fprintf(stderr, "usage: tuft-patterns FOLDER [car | bowl | plate]\n");
        return 2;
    }
    const std::filesystem::path folder = argv[1];
    try {
        std::filesystem::create_directories(folder);
        if (only.empty() || only == "car") tuft::samples::car(folder);
        if (only.empty() || only == "bowl") tuft::samples::bowl(folder);
        if (only.empty() || only == "plate") tuft::samples::plate(folder);
    } catch (const tuft::Error& error) {
        std::fprintf(stderr, "tuft-patterns: %s\n", error.what());
        return 1;
    }
    return 0;
}
