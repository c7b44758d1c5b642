#include "render/picture/glass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/system/parallel.h"
#include "render/picture/material.h"

namespace tuft::render {
namespace {

constexpr int kSide = 4;                 // rays per pixel and direction
constexpr float kNormalFresnel = 0.04f;  // glass of a refractive index of 1.5

/// What passes a pixel, and the colour that it takes on.
struct Passing {
    float part = 0;
    Vec3f colour{0};  ///< times `part`
};

class GlassReader {
  public:
    GlassReader(const mesh::TriangleMesh& mesh, const Appearance& appearance, const Glass& glass)
        : mesh_(mesh), maps_(appearance.maps), glass_(glass) {}

    Passing at(const mesh::RayHit& hit, const Vec3& direction) const {
        if (hit.triangle == kNone || !glass_.triangles[hit.triangle]) return {};
        const Vec2f* uv = &maps_.corner_uvs[3 * std::size_t{hit.triangle}];
        const Vec2f at = (1 - hit.b1 - hit.b2) * uv[0] + hit.b1 * uv[1] + hit.b2 * uv[2];
        const std::size_t texel = index(at);
        const Vec3 normal = mesh::surface_point(mesh_, hit.triangle, double{hit.b1}, double{hit.b2}).normal;
        const auto cosine = static_cast<float>(std::min(1.0, std::abs(glm::dot(normal, direction))));
        const float fresnel = kNormalFresnel + (1 - kNormalFresnel) * std::pow(1 - cosine, 5.0f);
        const float part = static_cast<float>(glass_.transmission[texel]) / 255 * (1 - fresnel);
        const Vec3f colour = maps_.base_colour.empty() ? Vec3f(1) : maps_.base_colour[texel];
        return {part, part * colour};
    }

  private:
    std::size_t index(const Vec2f& uv) const {
        const auto n = static_cast<float>(glass_.size);
        const auto place = [&](float x) { return static_cast<std::size_t>(std::clamp(x * n, 0.0f, n - 1)); };
        return place(uv.y) * glass_.size + place(uv.x);
    }

    const mesh::TriangleMesh& mesh_;
    const TextureMaps& maps_;
    const Glass& glass_;
};

/// Blends `image` with what is behind it where its rays meet glass first.
void see_through(Image& image, const Image& behind, const Camera& camera, const mesh::SurfaceQuery& query,
                 const GlassReader& reader) {
    std::array<float, 256> linear;
    for (std::size_t i = 0; i < linear.size(); ++i) linear[i] = decode_srgb(static_cast<float>(i) / 255);
    const auto width = static_cast<std::size_t>(image.width);
    parallel_for(image.rgb.size() / 3, 512, [&](std::size_t begin, std::size_t end) {
        for (std::size_t pixel = begin; pixel < end; ++pixel) {
            Passing sum;
            for (int k = 0; k < kSide * kSide; ++k) {
                const Vec3 d = ray_direction(camera, static_cast<double>(pixel % width) + (k % kSide + 0.5) / kSide,
                                             static_cast<double>(pixel / width) + (k / kSide + 0.5) / kSide);
                const Passing one =
                    reader.at(query.trace(Vec3f(camera.eye), Vec3f(d), 0, std::numeric_limits<float>::infinity()), d);
                sum.part += one.part / (kSide * kSide);
                sum.colour += one.colour / float(kSide * kSide);
            }
            if (!(sum.part > 0)) continue;
            for (std::size_t c = 0; c < 3; ++c) {
                std::uint8_t& code = image.rgb[3 * pixel + c];
                const float seen =
                    (1 - sum.part) * linear[code] + sum.colour[static_cast<int>(c)] * linear[behind.rgb[3 * pixel + c]];
                code = static_cast<std::uint8_t>(std::clamp(255 * encode_srgb(seen) + 0.5f, 0.0f, 255.0f));
            }
        }
    });
}

/// Triangles in the picture that are no glass, or with `backs` glass that faces away from the eye.
std::vector<std::uint32_t> behind_glass(const mesh::TriangleMesh& mesh, const Glass& glass, const Camera& camera,
                                        bool backs) {
    std::vector<std::uint32_t> triangles;
    for (std::uint32_t t = 0; t < mesh.n_triangles(); ++t) {
        if (!glass.hidden.empty() && glass.hidden[t]) continue;
        const bool faces = glm::dot(mesh::face_normal(mesh, t), camera.eye - mesh.position(t, 0)) > 0;
        if (!glass.triangles[t] || (backs && !faces)) triangles.push_back(t);
    }
    return triangles;
}

}  // namespace

Image render_with_glass(const mesh::TriangleMesh& mesh, const mesh::SurfaceQuery& query, const Appearance& appearance,
                        const Glass& glass, const PictureOptions& options) {
    const auto n_glass = std::ranges::count(glass.triangles, 1);
    if (n_glass == 0 || glass.transmission.empty()) return render_picture(mesh, query, appearance, options);
    const Camera camera = make_camera(options.view, options.width, options.height, mesh.positions);
    const GlassReader reader(mesh, appearance, glass);
    const std::vector<std::uint32_t> second = behind_glass(mesh, glass, camera, true),
                                     third = behind_glass(mesh, glass, camera, false);
    PictureOptions one = options;
    const int n = second == third ? 2 : 3;
    int done = 0;
    const auto draw = [&](const mesh::SurfaceQuery& of) {
        one.progress = [&](std::string_view phase, double part) {
            return !options.progress || options.progress(phase, (done + part) / n);
        };
        Image image = render_picture(mesh, of, appearance, one);
        ++done;
        return image;
    };
    Image image = draw(query);
    const mesh::SurfaceQuery behind(mesh, second);
    Image next = draw(behind);
    if (n == 3) see_through(next, draw(mesh::SurfaceQuery(mesh, third)), camera, behind, reader);
    see_through(image, next, camera, query, reader);
    return image;
}

}  // namespace tuft::render
