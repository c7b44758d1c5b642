#include <epoxy/gl.h>

#include "app/studio.h"
#include "ink/spectra/kubelka_munk.h"

/// The palette: a hand over the plate, and its picture on the graphics card.
namespace tuft::app {
namespace {

constexpr double kHigh = 0.2;      // metres above the plate from where it is looked at
constexpr double kPoolDepth = 60;  // film units in the middle of a pool: 0.6 mm

}  // namespace

bool Studio::in_palette(const Event& e) const {
    const PaletteState& p = session_.palette;
    return p.shown && p.width > 0 && e.x >= p.x && e.y >= p.y && e.x < p.x + p.width && e.y < p.y + p.height;
}

Aim Studio::palette_aim(const Event& e) const {
    const PaletteState& p = session_.palette;
    const double width = p.width > 0 ? p.width : 1, height = p.width > 0 ? p.height : 1;
    const Vec3 from{((e.x - p.x) / width - 0.5) * stroke::kPaletteWidth,
                    (0.5 - (e.y - p.y) / height) * stroke::kPaletteHeight, kHigh};
    Aim aim{.ray = {from, {0, 0, -1}},
            .view_right = {1, 0, 0},
            .view_up = {0, 1, 0},
            .metres_per_pixel = stroke::kPaletteWidth / width,
            .time = e.time,
            .pressure = e.pressure};
    if (e.pressure >= 0) aim.tilt = Vec2(e.tilt.x, -e.tilt.y);
    return aim;
}

void Studio::palette_press(const Event& e) {
    Session& s = session_;
    if (e.button != 0) return;
    const Aim aim = palette_aim(e);
    const Vec3 at{aim.ray.origin.x, aim.ray.origin.y, 0};
    if (s.palette.tool == PaletteTool::pick) return s.painter->post(PickInk{at, true});
    if (s.palette.tool == PaletteTool::pour) {
        stroke::Fill pool{.film = kPoolDepth,
                          .gradient = stroke::Gradient::round,
                          .to_film = 0,
                          .from = at,
                          .to = at + Vec3{s.palette.radius, 0, 0}};
        return s.painter->post(FillModel{.ink = s.ink, .fill = pool, .layer = stroke::kPaletteLayer});
    }
    try {
        if (!plate_) plate_ = stroke::make_palette();
        const brush::Preset preset = brush::load_preset(s.brush);
        hand_.emplace(*plate_->query, preset, s.hand, tip_lag(preset));
    } catch (const Error& error) {
        say(s, error.what());
        return;
    }
    s.erasing = false;
    s.hand_down = on_plate_ = true;
    post(hand_->move(aim), e.time);
}

void Studio::update_palette_picture() {
    PaletteState& p = session_.palette;
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

}  // namespace tuft::app
