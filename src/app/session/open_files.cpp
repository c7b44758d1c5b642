#include "app/session/open_files.h"

#include <algorithm>

#include "app/document/first_scale.h"
#include "core/files/files.h"
#include "core/files/toml_text.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr std::size_t kMostTomlBytes = (std::size_t{1} << 20) + brush::kMostGeometryBytes;

}  // namespace

void open_writing(Session& s, const fs::path& path) {
    if (!s.paint_thread) return show_message(s.status, "Open a model first; then the writing can be placed on it.");
    try {
        show_message(s.status, "");
        s.tools.writing = read_writing(path);
        if (const auto& lost = s.tools.writing.form().notes; !lost.empty())
            show_message(s.status, Message("{}: {}", path.filename().string(), join(lost)));
        s.tools.active = Tool::writing;
        s.tools.writing.scale = first_scale(s.tools.writing, s.paint_thread->model().mesh->bounds);
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

void keep_copy(Session& s) {
    if (s.reported.file.viewing) return;
    s.tools.copies.read(s.tools.lettering.wanted, s.tools.lettering.kept);
}

void store_read_copies(Session& s) {
    std::optional<CopyReader::Read> read = s.tools.copies.poll();
    if (!read || !s.paint_thread) return;
    if (!read->copy)
        return show_message(s.status, Message("The copied picture is not kept in the project: {}", read->fault));
    std::vector<KeptCopy>& kept = s.tools.lettering.kept;
    const auto same = std::find_if(kept.begin(), kept.end(), [&](const KeptCopy& k) { return k.id == read->copy->id; });
    if (same == kept.end() && kept.size() >= io::kMostAttachments)
        return show_message(s.status,
                            "The project holds as many copied pictures as it can; this one is not kept in it.");
    if (same == kept.end() || !same->has_same_content(*read->copy))
        s.paint_thread->post(AttachToProject{io::kCopies, std::move(read->attachment)});
    if (same == kept.end())
        kept.push_back(std::move(*read->copy));
    else
        *same = std::move(*read->copy);
}

void finish_storing_copies(Session& s) {
    while (s.tools.copies.busy()) {
        s.tools.copies.wait();
        store_read_copies(s);
    }
}

void take_kept_copy(Session& s, const KeptCopy& copy) {
    Lettering& l = s.tools.lettering;
    try {
        copy_picture(l, picture_of(copy));
        l.wanted.correction = copy.correction;
        set_text(l, copy.name);
    } catch (const std::exception& error) {
        show_message(s.status, message_of(error));
    }
}

void save_copy(Session& s, const fs::path& path) {
    const Lettering& l = s.tools.lettering;
    if (!l.text || l.wanted.like.empty() || l.text->lines.empty() || l.text->lines.front().empty()) return;
    try {
        const std::string json = writer::hanzi_json_of(l.text->lines.front().front());
        write_file(path, json.data(), json.size());
        show_message(s.status, Message("Saved as {}", path.string()));
    } catch (const Error& error) {
        show_message(s.status, error.message());
    }
}

void open_brush(Session& s, const fs::path& path) {
    try {
        take_own_brush(s.brush, path);
        show_message(s.status, Message("Brush: {}", path.stem().string()));
    } catch (const Error& error) {
        show_message(s.status, error.message());
    }
}

void open_brush_or_ink(Session& s, const fs::path& path) {
    try {
        // An ink names its pigments; a brush with a fault is a brush.
        const std::vector<char> bytes = read_file(path, kMostTomlBytes);
        const bool is_ink = parse_toml({bytes.data(), bytes.size()}, path.string()).contains("pigment");
        is_ink ? open_ink(s.paint_thread.get(), s.status, path) : open_brush(s, path);
    } catch (const Error& error) {
        show_message(s.status, error.message());
    }
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
