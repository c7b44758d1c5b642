#include "app/session/open_files.h"

#include <algorithm>

#include "core/system/files.h"

namespace fs = std::filesystem;

namespace tuft::app {

void open_writing(Session& s, const fs::path& path) {
    if (!s.paint_thread) return show_message(s.status, "Open a model first; then the writing can be placed on it.");
    try {
        show_message(s.status, "");
        s.tools.writing = read_writing(path);
        if (const auto& lost = s.tools.writing.notes; !lost.empty())
            show_message(s.status, Message("{}: {}", path.filename().string(), join(lost)));
        s.tools.active = Tool::writing;
        const double size = s.paint_thread->model().mesh->bounds.diagonal();
        // A drawing far too large or small for the model comes at a third of it.
        const double own = std::max(s.tools.writing.width, s.tools.writing.height);
        if (own > 0 && (own > size || own < 0.02 * size)) s.tools.writing.scale = 0.33 * size / own;
    } catch (const Error& error) {
        show_message(s.status, error.message());
    }
}

fs::path glyphs_beside(const fs::path& file) {
    const std::string stem = file.stem().string();
    const bool code = stem.size() == 5 && stem.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
    const bool one = file.extension() == ".json" || (file.extension() == ".svg" && code);
    return one ? file.parent_path() : file;
}

void open_ink(PaintThread* work, StatusMessage& status, const fs::path& path) {
    if (!work) return show_message(status, "Open a model first.");
    try {
        ink::Ink ink = ink::load_ink(path.string());
        if (ink.name.empty()) ink.name = path.stem().string();
        work->post(TakeInk{std::move(ink)});
    } catch (const Error& error) {
        show_message(status, error.message());
    }
}

void save_ink(const ColourState& colours, const std::string& name, StatusMessage& status, const fs::path& path) {
    const ink::Ink* ink = find_ink(colours, name);
    if (!ink) return;
    ink::Ink named = *ink;
    named.name = path.stem().string();
    try {
        const std::string text = ink::ink_toml(named);
        write_file(path, text.data(), text.size());
        show_message(status, Message("Saved as {}", path.string()));
    } catch (const Error& error) {
        show_message(status, error.message());
    }
}

void pin_reference(Session& s, const fs::path& path) {
    References& all = s.view.references;
    StatusMessage& status = s.status;
    if (!s.paint_thread) return show_message(status, "Open a model first; then images can be pinned beside it.");
    if (s.reported.file.viewing)
        return show_message(status, "This project is only looked at; File > Save as... makes a copy to work on.");
    try {
        ReferenceImage image = read_reference(path);
        if (all.images.size() >= io::kMostAttachments)
            return show_message(status, "There are as many images as a project can hold; take one off first.");
        const auto same = std::find_if(all.images.begin(), all.images.end(),
                                       [&](const ReferenceImage& r) { return r.id == image.id; });
        if (same != all.images.end()) {
            same->shown = true;
            return show_message(status, "This image is pinned already.");
        }
        const double step = 0.04 * static_cast<double>(all.images.size() % 6);
        image.at += Vec2(step);
        all.hidden = false;
        s.paint_thread->post(AttachToProject{io::kReferences, to_attachment(image)});
        all.images.push_back(std::move(image));
    } catch (const Error& error) {
        show_message(status, error.message());
    }
}

}  // namespace tuft::app
