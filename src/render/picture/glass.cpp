#include "render/picture/glass.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/system/parallel.h"
#include "render/picture/material.h"

namespace tuft::render {
namespace {

constexpr int kSide = 4, kFewSide = 2;   // rays per pixel and direction
constexpr float kNormalFresnel = 0.04f;  // glass of a refractive index of 1.5

/// What passes a pixel, and the colour that it takes on.
struct Passing {
    bool glass = false;
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
        return {true, part, part * colour};
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

/// A surface that rays meet, and its picture. Behind the first one glass is left out.
struct Layer {
    std::vector<std::uint32_t> triangles;     ///< of `own`
    std::unique_ptr<mesh::SurfaceQuery> own;  ///< null: `query` is the caller's
    const mesh::SurfaceQuery* query = nullptr;
    std::unique_ptr<PictureSeries> series;  ///< null: not drawn yet
    std::vector<std::uint32_t> pixels;      ///< that show glass
    bool traced = false;                    ///< whether `pixels` are found
};

class Blend {
  public:
    Blend(const Camera& camera, const GlassReader& reader, int side) : camera_(camera), reader_(reader), side_(side) {
        for (std::size_t i = 0; i < linear_.size(); ++i) linear_[i] = decode_srgb(static_cast<float>(i) / 255);
    }

    /// Blends `image`, that of `front`, with what is behind it where its rays meet glass first.
    void see_through(Image& image, const Image& behind, Layer& front) const {
        if (!front.traced) {
            front.pixels.resize(image.rgb.size() / 3);
            std::iota(front.pixels.begin(), front.pixels.end(), 0u);
        }
        std::vector<std::uint8_t> glass(front.pixels.size());
        parallel_for(front.pixels.size(), 512, [&](std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) {
                const Passing sum = trace(*front.query, front.pixels[i]);
                glass[i] = sum.glass;
                if (sum.part > 0) blend(image, behind, front.pixels[i], sum);
            }
        });
        if (std::exchange(front.traced, true)) return;
        std::vector<std::uint32_t> found;
        for (std::size_t i = 0; i < glass.size(); ++i)
            if (glass[i]) found.push_back(front.pixels[i]);
        front.pixels = std::move(found);
    }

  private:
    Passing trace(const mesh::SurfaceQuery& query, std::size_t pixel) const {
        const auto width = static_cast<std::size_t>(camera_.width);
        Passing sum;
        for (int k = 0; k < side_ * side_; ++k) {
            const Vec3 d = ray_direction(camera_, static_cast<double>(pixel % width) + (k % side_ + 0.5) / side_,
                                         static_cast<double>(pixel / width) + (k / side_ + 0.5) / side_);
            const Passing one =
                reader_.at(query.trace(Vec3f(camera_.eye), Vec3f(d), 0, std::numeric_limits<float>::infinity()), d);
            sum.glass |= one.glass;
            sum.part += one.part / static_cast<float>(side_ * side_);
            sum.colour += one.colour / static_cast<float>(side_ * side_);
        }
        return sum;
    }

    void blend(Image& image, const Image& behind, std::size_t pixel, const Passing& sum) const {
        for (std::size_t c = 0; c < 3; ++c) {
            std::uint8_t& code = image.rgb[3 * pixel + c];
            const float seen =
                (1 - sum.part) * linear_[code] + sum.colour[static_cast<int>(c)] * linear_[behind.rgb[3 * pixel + c]];
            code = static_cast<std::uint8_t>(std::clamp(255 * encode_srgb(seen) + 0.5f, 0.0f, 255.0f));
        }
    }

    const Camera& camera_;
    const GlassReader& reader_;
    int side_;
    std::array<float, 256> linear_;
};

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

struct GlassSeries::State {
    const mesh::TriangleMesh& mesh;
    const Appearance lit;
    Glass glass;
    PictureOptions options;
    const PictureSeries::Length length;
    Camera camera;
    std::vector<Layer> layers;  ///< from the front
    Image image;                ///< with glass: the picture
    std::size_t done = 0;       ///< layers of the picture in work

    bool has_glass() const { return !glass.transmission.empty() && std::ranges::count(glass.triangles, 1) > 0; }

    /// Makes the layers that the camera sees; keeps those that are there.
    void find_layers() {
        if (!has_glass()) return;
        std::vector<std::uint32_t> second = behind_glass(mesh, glass, camera, true),
                                   third = behind_glass(mesh, glass, camera, false);
        const bool same = second == third;
        layers.resize(same ? 2 : 3);
        set_layer(layers[1], std::move(second));
        if (!same) set_layer(layers[2], std::move(third));
    }
    void set_layer(Layer& layer, std::vector<std::uint32_t> triangles) const {
        if (layer.query && layer.triangles == triangles) return;
        layer = {};
        layer.triangles = std::move(triangles);
        layer.own = std::make_unique<mesh::SurfaceQuery>(mesh, layer.triangles);
        layer.query = layer.own.get();
    }

    void make_series(Layer& layer) {
        PictureOptions one = options;
        one.progress = [this](std::string_view phase, double part) {
            const auto n = static_cast<double>(layers.size());
            return !options.progress || options.progress(phase, (static_cast<double>(done) + part) / n);
        };
        layer.series = std::make_unique<PictureSeries>(mesh, *layer.query, lit, one, length);
    }

    const Image& draw_layer(Layer& layer, const Appearance& shown, std::span<const std::uint32_t> changed) {
        if (!layer.series) make_series(layer);
        return layer.series->draw(shown, changed);
    }
    /// One picture needs the light of one layer at a time.
    Image take_layer(Layer& layer, const Appearance& shown, std::span<const std::uint32_t> changed) {
        const Image& drawn = draw_layer(layer, shown, changed);
        ++done;
        if (length != PictureSeries::Length::one) return drawn;
        Image picture = layer.series->take_image();
        layer.series.reset();
        return picture;
    }
};

GlassSeries::GlassSeries(const mesh::TriangleMesh& mesh, const mesh::SurfaceQuery& query, const Appearance& lit,
                         Glass glass, const PictureOptions& options, PictureSeries::Length length)
    : state_(new State{.mesh = mesh,
                       .lit = lit,
                       .glass = std::move(glass),
                       .options = options,
                       .length = length,
                       .camera = make_camera(options.view, options.width, options.height, mesh.positions),
                       .layers = {},
                       .image = {}}) {
    state_->layers.resize(1);
    state_->layers[0].query = &query;
    state_->find_layers();
}

GlassSeries::~GlassSeries() = default;

const Image& GlassSeries::draw(const Appearance& shown, std::span<const std::uint8_t> transmission,
                               std::span<const std::uint32_t> changed) {
    State& s = *state_;
    s.done = 0;
    if (s.layers.size() == 1) return s.draw_layer(s.layers[0], shown, changed);
    if (s.layers[0].traced && changed.empty()) return s.image;
    s.glass.transmission = transmission;
    const GlassReader reader(s.mesh, shown, s.glass);
    const Blend blend(s.camera, reader, s.options.edge_samples < 8 ? kFewSide : kSide);
    Image behind = s.take_layer(s.layers.back(), shown, changed);
    for (std::size_t k = s.layers.size() - 1; k-- > 0;) {
        Image front = s.take_layer(s.layers[k], shown, changed);
        blend.see_through(front, behind, s.layers[k]);
        behind = std::move(front);
    }
    s.image = std::move(behind);
    return s.image;
}

void GlassSeries::look_from(const View& view) {
    State& s = *state_;
    s.options.view = view;
    s.camera = make_camera(view, s.options.width, s.options.height, s.mesh.positions);
    s.find_layers();
    for (Layer& layer : s.layers) {
        layer.traced = false;
        if (layer.series) layer.series->look_from(view);
    }
}

const Camera& GlassSeries::camera() const {
    return state_->camera;
}

Image GlassSeries::take_image() {
    State& s = *state_;
    return s.layers.size() == 1 ? s.layers[0].series->take_image() : std::move(s.image);
}

Image render_with_glass(const mesh::TriangleMesh& mesh, const mesh::SurfaceQuery& query, const Appearance& appearance,
                        const Glass& glass, const PictureOptions& options) {
    GlassSeries series(mesh, query, appearance, glass, options, PictureSeries::Length::one);
    series.draw(appearance, glass.transmission);
    return series.take_image();
}

}  // namespace tuft::render
