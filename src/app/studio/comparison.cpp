#include "app/studio/comparison.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace tuft::app {

bool Comparison::on() const {
    return session_.paint_thread && !session_.journal.snapshots.compared.empty();
}

// The snapshot has the left half of the view, the work the right one; swiped, both have all of it.
void Comparison::layout() {
    Session& s = session_;
    SnapshotState& c = s.journal.snapshots;
    c.width = 0;
    if (!on() || c.swipe) return;
    c.x = s.view.area.x;
    c.y = s.view.area.y;
    c.width = s.view.area.width / 2;
    c.height = s.view.area.height;
    s.view.area.x += c.width + 1;
    s.view.area.width = std::max(16, s.view.area.width - c.width - 1);
    c.width = s.view.area.width;  // both look the same way at the same size
}

void Comparison::take_picture() {
    Session& s = session_;
    SnapshotState& c = s.journal.snapshots;
    if (!on()) {
        scene_.reset();
        view_.reset();
        return;
    }
    if (!c.picture || c.picture->id != c.compared) return;
    const stroke::Model& m = s.paint_thread->model();
    scene_ = std::make_unique<render::GlScene>();
    view_ = std::make_unique<render::GlView>();
    scene_->set_mesh(*m.mesh, m.atlas.corner_uvs);
    scene_->set_texture(c.picture->pixels);
    c.picture.reset();
    c.ready = true;
}

// Before the work is drawn: swiped, it would lie under it, so what was drawn is kept as a texture.
void Comparison::draw(const render::GlView::Frame& of_work, int height) {
    Session& s = session_;
    SnapshotState& c = s.journal.snapshots;
    take_picture();
    if (!on() || !c.ready || !scene_) return;
    render::GlView::Frame f = of_work;
    f.solid = nullptr;
    if (f.appearance.options.shading == render::Shading::triangles)
        f.appearance.options.shading = render::Shading::clay;
    if (!c.swipe) f.x = c.x;
    view_->draw(*scene_, f);
    if (!c.swipe) return;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, f.framebuffer);
    if (!c.texture) glGenTextures(1, &c.texture);
    glBindTexture(GL_TEXTURE_2D, c.texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, s.view.area.x, height - s.view.area.y - s.view.area.height,
                     s.view.area.width, s.view.area.height, 0);
}

bool Comparison::on_work(const Event& e) const {
    const Session& s = session_;
    const SnapshotState& c = s.journal.snapshots;
    if (!on()) return true;
    return e.x >= s.view.area.x + (c.swipe && c.ready ? c.line_at * s.view.area.width : 0);
}

void Comparison::drop_graphics() {
    scene_.reset();
    view_.reset();
}

}  // namespace tuft::app
