#include "app/studio/project_picture.h"

namespace tuft::app {
namespace {

constexpr double kPictureAfter = 1.5;  // seconds after the last stroke

}  // namespace

void ProjectPicture::reset() {
    strokes_seen_ = session_.journal.lines.size();
}

void ProjectPicture::watch(double now) {
    const std::size_t strokes = session_.journal.lines.size();
    const std::filesystem::path& project = session_.reported.file.project;
    if (strokes == strokes_seen_ && (project == project_ || strokes == 0)) return;
    strokes_seen_ = strokes;
    project_ = project;
    due_ = now + kPictureAfter;
}

bool ProjectPicture::outdated() const {
    return due_ != 0 || session_.journal.lines.size() != strokes_seen_;
}

void ProjectPicture::store(double now, bool at_once) {
    Session& s = session_;
    if (!at_once && (due_ == 0 || now < due_)) return;
    if (!s.paint_thread || s.view.tuft.pressed || !is_settled(s)) return;
    due_ = 0;
    if (s.reported.file.project.empty()) return;
    const Area& area = s.view.area;
    s.project.start_page.pictures.keep(s.reported.file.project, area.width, area.height,
                                       render::read_pixels(area.x, 0, area.width, area.height));
}

}  // namespace tuft::app
