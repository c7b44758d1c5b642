#include "render/picture/picture_series.h"

#include <algorithm>
#include <cstdlib>
#include <mutex>
#include <numeric>
#include <optional>

#include "core/error.h"
#include "core/system/parallel.h"
#include "render/picture/light_buffer.h"
#include "render/picture/shading.h"

namespace tuft::render {
namespace {

/// For each tile of the colour map the pixels that read it, with repeats.
class PixelsOfTiles {
  public:
    void reset(std::size_t n_tiles) { pixels_.assign(n_tiles, {}); }
    bool records() const { return !pixels_.empty(); }

    /// A tile and a pixel that read it.
    struct Read {
        std::uint32_t tile = 0, pixel = 0;
    };
    /// Any thread.
    void add(std::span<const Read> reads) {
        const std::lock_guard lock(mutex_);
        for (const Read& read : reads) pixels_[read.tile].push_back(read.pixel);
        held_ += reads.size();
    }

    /// Takes out the pixels that read one of the tiles, ascending. They are recorded again when they are drawn.
    std::vector<std::uint32_t> take(std::span<const std::uint32_t> tiles) {
        std::vector<std::uint32_t> taken;
        for (const std::uint32_t tile : tiles) {
            if (tile >= pixels_.size()) continue;
            std::vector<std::uint32_t>& of_tile = pixels_[tile];
            held_ -= of_tile.size();
            taken.insert(taken.end(), of_tile.begin(), of_tile.end());
            of_tile.clear();
        }
        make_set(taken);
        return taken;
    }

    /// Drops repeats once there are as many of them again as reads.
    void tidy() {
        if (held_ < 2 * distinct_ + kLeastTidied) return;
        held_ = 0;
        for (std::vector<std::uint32_t>& of_tile : pixels_) {
            make_set(of_tile);
            held_ += of_tile.size();
        }
        distinct_ = held_;
    }

  private:
    static constexpr std::size_t kLeastTidied = 1 << 22;

    static void make_set(std::vector<std::uint32_t>& numbers) {
        std::sort(numbers.begin(), numbers.end());
        numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    }

    std::mutex mutex_;
    std::vector<std::vector<std::uint32_t>> pixels_;
    std::size_t held_ = 0, distinct_ = 0;
};

Studio make_light(const mesh::TriangleMesh& mesh, const Camera& camera, const PictureOptions& options) {
    if (options.lights != Lights::raking)
        return make_studio(mesh.bounds, options.view.azimuth, options.light_azimuth, options.floor, options.exposure);
    return make_raking_studio(mesh.bounds, {.right = Vec3f(camera.right),
                                            .up = Vec3f(camera.up),
                                            .forward = Vec3f(camera.forward),
                                            .turn = options.light_azimuth,
                                            .floor = options.floor,
                                            .exposure = options.exposure});
}

Camera make_checked_camera(const mesh::TriangleMesh& mesh, const PictureOptions& options) {
    constexpr std::int64_t kMostPixels = std::int64_t{40} << 20;  // about 5 GB of buffers
    const Camera camera = make_camera(options.view, options.width, options.height, mesh.positions);
    if (std::int64_t{options.width} * options.height > kMostPixels)
        throw Error(
            Message("a picture of {}x{} is too large; at most 40 million pixels", options.width, options.height));
    return camera;
}

}  // namespace

struct PictureSeries::State {
    State(const mesh::TriangleMesh& mesh, const mesh::SurfaceQuery& query, const Appearance& by,
          const PictureOptions& wanted)
        : options(wanted),
          camera(make_checked_camera(mesh, options)),
          lit(by),
          material(mesh, lit),
          scene{mesh, query, material, make_light(mesh, camera, options), 0} {
        scene.offset = 2e-5f * scene.studio.radius + 2e-7f * glm::length(scene.studio.centre);
    }

    PictureOptions options;
    Camera camera;
    Appearance lit;
    MaterialReader material;
    Scene scene;
    std::optional<LightCache> cache;
    LightBuffer buffer;
    Image image;
    std::vector<PixelCode> middles;
    std::vector<Vec3f> middle_codes;  ///< the same, not rounded; empty unless `one_ray`
    std::vector<std::uint8_t> edges;
    PixelsOfTiles reads;
    bool drawn = false;
    std::size_t drawn_pixels = 0;

    std::size_t n_pixels() const { return middles.size(); }
    /// Whether a pixel off the edges gets one ray: that through its middle, which finds the edges.
    bool one_ray() const { return options.edge_samples < 8; }
    int x_of(std::size_t pixel) const { return static_cast<int>(pixel % static_cast<std::size_t>(camera.width)); }
    int y_of(std::size_t pixel) const { return static_cast<int>(pixel / static_cast<std::size_t>(camera.width)); }
    void sample_light();
    bool is_edge(std::size_t pixel) const;
    std::vector<std::uint32_t> with_neighbours(std::span<const std::uint32_t> pixels) const;
    void find_edges(std::vector<std::uint32_t>& pixels);
    template <class Fn>
    void for_pixels(std::span<const std::uint32_t> pixels, const char* phase, double from, double to, Fn&& fn);
    void redraw(const Shading& shading, std::vector<std::uint32_t> pixels);
};

void PictureSeries::State::sample_light() {
    LightSamples samples = share_samples(options.light_samples);
    if (options.light_step > 1) samples.on_floor = 1;
    buffer = fill_light_buffer(
        scene, *cache, camera,
        {.samples = samples, .seed = options.seed, .step = options.light_step, .progress = options.progress});
}

/// Whether the pixel's middle differs from that of one of the pixels round it by some six codes.
bool PictureSeries::State::is_edge(std::size_t pixel) const {
    constexpr int kContrast = 6;
    const int x = x_of(pixel), y = y_of(pixel);
    for (int j = std::max(0, y - 1); j <= std::min(camera.height - 1, y + 1); ++j)
        for (int i = std::max(0, x - 1); i <= std::min(camera.width - 1, x + 1); ++i)
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t other =
                    static_cast<std::size_t>(j) * static_cast<std::size_t>(camera.width) + static_cast<std::size_t>(i);
                if (std::abs(middles[other][c] - middles[pixel][c]) > kContrast) return true;
            }
    return false;
}

std::vector<std::uint32_t> PictureSeries::State::with_neighbours(std::span<const std::uint32_t> pixels) const {
    std::vector<std::uint8_t> wanted(n_pixels(), 0);
    for (const std::uint32_t pixel : pixels)
        for (int j = std::max(0, y_of(pixel) - 1); j <= std::min(camera.height - 1, y_of(pixel) + 1); ++j)
            for (int i = std::max(0, x_of(pixel) - 1); i <= std::min(camera.width - 1, x_of(pixel) + 1); ++i)
                wanted[static_cast<std::size_t>(j) * static_cast<std::size_t>(camera.width) +
                       static_cast<std::size_t>(i)] = 1;
    std::vector<std::uint32_t> all;
    for (std::size_t k = 0; k < wanted.size(); ++k)
        if (wanted[k]) all.push_back(static_cast<std::uint32_t>(k));
    return all;
}

/// Finds which pixels lie on edges after the middles of `pixels` changed, and adds those that came to or left one.
void PictureSeries::State::find_edges(std::vector<std::uint32_t>& pixels) {
    const std::vector<std::uint32_t> near = pixels.size() < n_pixels() ? with_neighbours(pixels) : pixels;
    std::vector<std::uint8_t> edge(near.size());
    parallel_for(near.size(), 4096, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) edge[i] = is_edge(near[i]);
    });
    std::vector<std::uint32_t> changed;
    for (std::size_t i = 0; i < near.size(); ++i)
        if (std::exchange(edges[near[i]], edge[i]) != edge[i]) changed.push_back(near[i]);
    std::vector<std::uint32_t> all;
    std::set_union(pixels.begin(), pixels.end(), changed.begin(), changed.end(), std::back_inserter(all));
    pixels = std::move(all);
}

/// Calls fn(pixel, reads) for all of them and records what they read. Progress goes `from` … `to`.
template <class Fn>
void PictureSeries::State::for_pixels(std::span<const std::uint32_t> pixels, const char* phase, double from, double to,
                                      Fn&& fn) {
    constexpr std::size_t kBand = 1 << 16;  // pixels between two reports
    for (std::size_t first = 0; first < pixels.size(); first += kBand) {
        report(options.progress, phase,
               from + (to - from) * static_cast<double>(first) / static_cast<double>(pixels.size()));
        const auto band = pixels.subspan(first, std::min(kBand, pixels.size() - first));
        parallel_for(band.size(), 256, [&](std::size_t begin, std::size_t end) {
            std::vector<PixelsOfTiles::Read> found;
            TileReads of_pixel;
            for (std::size_t i = begin; i < end; ++i) {
                of_pixel.tiles.clear();
                fn(band[i], reads.records() ? &of_pixel : nullptr);
                for (const std::uint32_t tile : of_pixel.tiles) found.push_back({tile, band[i]});
            }
            if (!found.empty()) reads.add(found);
        });
    }
}

void PictureSeries::State::redraw(const Shading& shading, std::vector<std::uint32_t> pixels) {
    for_pixels(pixels, "picture", 0, 0.2, [&](std::uint32_t pixel, TileReads* read) {
        const Vec3f code = shade_middle(shading, x_of(pixel), y_of(pixel), read);
        for (int c = 0; c < 3; ++c)
            middles[pixel][static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(255 * code[c]);
        if (one_ray()) middle_codes[pixel] = code;
    });
    find_edges(pixels);
    for_pixels(pixels, "picture", 0.2, 1, [&](std::uint32_t pixel, TileReads* read) {
        const bool edge = edges[pixel] != 0;
        const Vec3f code =
            one_ray() && !edge ? middle_codes[pixel] : shade_pixel(shading, edge, x_of(pixel), y_of(pixel), read);
        const PixelCode out = pixel_code(code, options.seed, pixel);
        std::copy(out.begin(), out.end(), image.rgb.begin() + 3 * static_cast<std::ptrdiff_t>(pixel));
    });
    reads.tidy();
    drawn_pixels = pixels.size();
    report(options.progress, "picture", 1);
}

PictureSeries::PictureSeries(const mesh::TriangleMesh& mesh, const mesh::SurfaceQuery& query, const Appearance& lit,
                             const PictureOptions& options, Length length)
    : state_(std::make_unique<State>(mesh, query, lit, options)) {
    State& s = *state_;
    report(options.progress, "bounces", 0);
    s.cache.emplace(s.scene, length == Length::moving ? LightCache::Retain::links : LightCache::Retain::solution);
    s.sample_light();
    const std::size_t n = static_cast<std::size_t>(options.width) * static_cast<std::size_t>(options.height);
    s.image = {options.width, options.height, std::vector<std::uint8_t>(3 * n)};
    s.middles.resize(n);
    s.edges.assign(n, 0);
    if (s.one_ray()) s.middle_codes.resize(n);
    const std::size_t tiles = (lit.maps.size + kMapTile - 1) / kMapTile;
    if (length == Length::many && lit.maps.height.empty()) s.reads.reset(tiles * tiles);
}

void PictureSeries::look_from(const View& view) {
    State& s = *state_;
    s.options.view = view;
    s.camera = make_checked_camera(s.scene.mesh, s.options);
    s.scene.studio = make_light(s.scene.mesh, s.camera, s.options);
    s.cache->relight(s.scene);
    s.sample_light();
    s.drawn = false;
}

PictureSeries::~PictureSeries() = default;

const Image& PictureSeries::draw(const Appearance& shown, std::span<const std::uint32_t> changed) {
    State& s = *state_;
    s.drawn_pixels = 0;
    if (s.drawn && changed.empty()) return s.image;
    const MaterialReader seen(s.scene.mesh, shown);
    const Shading shading{.scene = s.scene,
                          .cache = *s.cache,
                          .camera = s.camera,
                          .buffer = s.buffer,
                          .options = s.options,
                          .seen = seen,
                          .pixel_angle = static_cast<float>(2 * s.camera.tan_half_height / s.camera.height)};
    std::vector<std::uint32_t> pixels;
    if (s.drawn && s.reads.records()) {
        pixels = s.reads.take(changed);
    } else {
        pixels.resize(s.n_pixels());
        std::iota(pixels.begin(), pixels.end(), 0u);
    }
    s.redraw(shading, std::move(pixels));
    s.drawn = true;
    return s.image;
}

const Camera& PictureSeries::camera() const {
    return state_->camera;
}

std::size_t PictureSeries::drawn_pixels() const {
    return state_->drawn_pixels;
}

Image PictureSeries::take_image() {
    return std::move(state_->image);
}

}  // namespace tuft::render
