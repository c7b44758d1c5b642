#include "app/document/pictures/thumbnails.h"

#include <algorithm>
#include <cmath>

#include "atlas/texels/cluster_graph.h"
#include "ink/spectra/srgb.h"

namespace tuft::app {
namespace {

void put(Thumbnail& picture, std::uint32_t at, const ink::Rgb& linear, float light) {
    for (std::size_t c = 0; c < 3; ++c) picture.rgba[4 * at + c] = ink::code_of_linear(light * linear[c]);
    picture.rgba[4 * at + 3] = 255;
}

}  // namespace

void Thumbnails::look_from(const stroke::Model& model, const render::GlCamera& camera) {
    width_ = camera.width;
    height_ = camera.height;
    pixels_.clear();
    pictures_.clear();
    for (int y = 0; y < height_; ++y)
        for (int x = 0; x < width_; ++x) {
            const Ray ray = render::ray_at(camera, x + 0.5, y + 0.5);
            const auto hit = model.query->ray(ray.origin, ray.direction);
            if (!hit) continue;
            const atlas::TexelRef texel =
                atlas::texel_at(*model.mesh, model.atlas, model.texels, hit->triangle, hit->position);
            if (!texel.valid()) continue;
            const double facing = std::abs(glm::dot(hit->normal, ray.direction));
            pixels_[texel.slot].push_back(
                {static_cast<std::uint32_t>(y * width_ + x), texel.texel, static_cast<float>(0.55 + 0.45 * facing)});
        }
}

bool Thumbnails::waiting(const stroke::Document& painting) const {
    if (width_ == 0) return false;
    const auto& layers = painting.layers().table().layers;
    return !touched_.empty() || layers.size() != pictures_.size() ||
           std::any_of(layers.begin(), layers.end(), [&](const stroke::Layer& l) { return !pictures_.contains(l.id); });
}

Thumbnail Thumbnails::bare(const ink::Substrate& substrate, std::uint32_t layer) const {
    Thumbnail picture{layer, width_, height_,
                      std::vector<std::uint8_t>(std::size_t{4} * static_cast<std::size_t>(width_ * height_), 0)};
    for (const auto& [slot, pixels] : pixels_)
        for (const Pixel& pixel : pixels) put(picture, pixel.at, substrate.reflectance, pixel.light);
    return picture;
}

// Draws the slots that changed, or all; false where none of them is seen.
bool Thumbnails::paint(Thumbnail& picture, const ink::Canvas& canvas, const ink::Substrate& substrate, bool all) const {
    bool any = false;
    const auto slot_again = [&](std::uint32_t slot, const std::vector<Pixel>& pixels) {
        any = true;
        const bool inked = canvas.touched(slot);
        ink::TileAppearance look;
        if (inked) look = ink::shade_tile(canvas, slot, substrate);
        for (const Pixel& pixel : pixels)
            put(picture, pixel.at,
                inked ? ink::Rgb{look.colour[0][pixel.texel], look.colour[1][pixel.texel], look.colour[2][pixel.texel]}
                      : substrate.reflectance,
                pixel.light);
    };
    if (all)
        for (const auto& [slot, pixels] : pixels_)
            if (canvas.touched(slot)) slot_again(slot, pixels);
    if (!all)
        for (const std::uint32_t slot : touched_)
            if (const auto at = pixels_.find(slot); at != pixels_.end()) slot_again(slot, at->second);
    return any;
}

std::vector<Thumbnail> Thumbnails::draw(stroke::Document& painting) {
    std::vector<Thumbnail> changed;
    std::erase_if(pictures_, [&](const auto& entry) { return !painting.layers().table().find(entry.first); });
    for (const stroke::LayerTexels& layer : painting.layers().canvases()) {
        const auto [at, is_new] = pictures_.try_emplace(layer.layer);
        if (is_new) at->second = bare(painting.appearance().substrate(), layer.layer);
        if (paint(at->second, *layer.canvas, painting.appearance().substrate(), is_new) || is_new)
            changed.push_back(at->second);
    }
    touched_.clear();
    return changed;
}

}  // namespace tuft::app
