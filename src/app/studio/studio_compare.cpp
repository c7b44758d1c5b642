#include <epoxy/gl.h>

#include <algorithm>

#include "app/studio/studio.h"

/// The work beside one of its snapshots.
namespace tuft::app {

bool Studio::comparing() const {
    return session_.paint_thread && !session_.journal.snapshots.compared.empty();
}

// The snapshot has the left half of the view, the work the right one; swiped, both have all of it.
void Studio::layout_comparison() {
    Session& s = session_;
    SnapshotState& c = s.journal.snapshots;
    c.width = 0;
    if (!comparing() || c.swipe) return;
    c.x = s.view.area.x;
    c.y = s.view.area.y;
    c.width = s.view.area.width / 2;
    c.height = s.view.area.height;
    s.view.area.x += c.width + 1;
    s.view.area.width = std::max(16, s.view.area.width - c.width - 1);
    c.width = s.view.area.width;  // both look the same way at the same size
}

void Studio::take_snapshot_picture() {
    Session& s = session_;
    SnapshotState& c = s.journal.snapshots;
    if (!comparing()) {
        compare_scene_.reset();
        compare_view_.reset();
        return;
    }
    if (!c.picture || c.picture->id != c.compared) return;
    const stroke::Model& m = s.paint_thread->model();
    compare_scene_ = std::make_unique<render::GlScene>();
    compare_view_ = std::make_unique<render::GlView>();
    compare_scene_->set_mesh(*m.mesh, m.atlas.corner_uvs);
    compare_scene_->set_texture(c.picture->pixels);
    c.picture.reset();
    c.ready = true;
}

// Before the work is drawn: swiped, it would lie under it, so what was drawn is kept as a texture.
void Studio::draw_comparison(const render::GlView::Frame& of_work, int height) {
    Session& s = session_;
    SnapshotState& c = s.journal.snapshots;
    take_snapshot_picture();
    if (!comparing() || !c.ready || !compare_scene_) return;
    render::GlView::Frame f = of_work;
    f.solid = nullptr;
    if (f.look.options.shading == render::Shading::triangles) f.look.options.shading = render::Shading::clay;
    if (!c.swipe) f.x = c.x;
    compare_view_->draw(*compare_scene_, f);
    if (!c.swipe) return;
    glBindFramebuffer(GL_READ_FRAMEBUFFER, f.framebuffer);
    if (!c.texture) glGenTextures(1, &c.texture);
    glBindTexture(GL_TEXTURE_2D, c.texture);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glCopyTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, s.view.area.x, height - s.view.area.y - s.view.area.height,
                     s.view.area.width, s.view.area.height, 0);
}

// Whether a press is one on the work, not on the snapshot beside or over it.
bool Studio::on_work(const Event& e) const {
    const Session& s = session_;
    const SnapshotState& c = s.journal.snapshots;
    if (!comparing()) return true;
    return e.x >= s.view.area.x + (c.swipe && c.ready ? c.line_at * s.view.area.width : 0);
}

}  // namespace tuft::app
