#include <epoxy/gl.h>

#include "app/studio/studio.h"

/// \file
/// The layers' small pictures: asked for from where the model is seen, and put on the graphics card.
namespace tuft::app {
namespace {

constexpr int kWidth = 48, kHeight = 36;  // pixels at a scale of 1
constexpr double kCloser = 0.75;          // times as far as a view keeps away, with room round the model
constexpr double kStill = 0.4;            // seconds without a turn of the view after which they are drawn anew

}  // namespace

void Studio::update_thumbnails() {
    Session& s = session_;
    const auto scaled = [&](int length) { return static_cast<int>(s.ui.px(static_cast<float>(length))); };
    // From the same side, all of the model, as large as it fits.
    const Box& bounds = s.paint_thread->model().mesh->bounds;
    Orbit orbit = s.view.orbit;
    orbit.frame(bounds);
    orbit.distance *= kCloser;
    const render::GlCamera from = orbit.camera(scaled(kWidth), scaled(kHeight), bounds);
    const bool still = drag_ == Drag::none && !hand_ && now_ - last_turn_ > kStill;
    if (still && (!thumbnails_from_ || !(*thumbnails_from_ == from))) {
        thumbnails_from_ = from;
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
