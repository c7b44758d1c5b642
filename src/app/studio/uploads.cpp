#include "app/studio/uploads.h"

#include <epoxy/gl.h>

#include "ink/spectra/kubelka_munk.h"

namespace tuft::app {
namespace {

constexpr int kThumbnailWidth = 48, kThumbnailHeight = 36;  // pixels at a scale of 1
constexpr double kCloser = 0.75;  // times as far as a view keeps away, with room round the model

}  // namespace

void upload_palette(PaletteState& p) {
    if (!p.shown || (!p.fresh && p.texture)) return;
    p.fresh = false;
    if (p.picture.rgb.empty()) {
        const ink::Rgb bare = stroke::palette_substrate().reflectance;
        p.picture.rgb.resize(3 * static_cast<std::size_t>(p.picture.width * p.picture.height));
        for (std::size_t i = 0; i < p.picture.rgb.size(); ++i)
            p.picture.rgb[i] = static_cast<std::uint8_t>(255 * ink::srgb_encode(bare[i % 3]) + 0.5f);
    }
    if (!p.texture) glGenTextures(1, &p.texture);
    glBindTexture(GL_TEXTURE_2D, p.texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, p.picture.width, p.picture.height, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 p.picture.rgb.data());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
}

void upload_thumbnails(Session& s, bool still) {
    const auto scaled = [&](int length) { return static_cast<int>(s.ui.px(static_cast<float>(length))); };
    // From the same side, all of the model, as large as it fits.
    const Box& bounds = s.paint_thread->model().mesh->bounds;
    Orbit orbit = s.view.orbit;
    orbit.frame(bounds);
    orbit.distance *= kCloser;
    const render::GlCamera from = orbit.camera(scaled(kThumbnailWidth), scaled(kThumbnailHeight), bounds);
    if (still && (!s.layers.list.seen_from || !(*s.layers.list.seen_from == from))) {
        s.layers.list.seen_from = from;
        s.paint_thread->post(LookFrom{from});
    }
    LayerList& list = s.layers.list;
    for (const std::uint32_t layer : list.fresh) {
        const auto at = list.pictures.find(layer);
        if (at == list.pictures.end()) continue;
        unsigned& texture = list.textures[layer];
        if (!texture) glGenTextures(1, &texture);
        glBindTexture(GL_TEXTURE_2D, texture);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, at->second.width, at->second.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     at->second.rgba.data());
    }
    list.fresh.clear();
}

}  // namespace tuft::app
