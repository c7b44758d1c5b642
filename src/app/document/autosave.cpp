#include "app/document/autosave.h"

#include <algorithm>
#include <utility>

#include "io/project/appearance.h"

namespace tuft::app {

template <class Action>
void Autosave::attempt(const Action& action) {
    try {
        action();
        if (!behind_ && !wanted_ && pending_.empty()) trouble_ = {};
    } catch (const io::ChangedOutside& error) {
        overtaken_ = true;
        trouble_ = message_of(error);
    } catch (const std::exception& error) {
        trouble_ = message_of(error);
    }
}

template <class Action>
void Autosave::change(const Action& action) {
    attempt([&] {
        if (!project_ || viewing_) return;
        const bool was = std::exchange(behind_, true);
        action();
        behind_ = was;
    });
}

void Autosave::rewrite(const std::string& source, const FileFrame& frame, stroke::Document& painting) {
    behind_ = true;
    if (Message fault = start(wanted_ ? wanted_->path : path(), source, frame, painting); !fault.empty())
        trouble_ = std::move(fault);
}

void Autosave::start_later(const std::filesystem::path& path, const std::string& source, const FileFrame& frame,
                           const Message& fault, bool has_work) {
    wanted_ = {path, source, frame, fault};
    trouble_ = fault;
    project_.reset();
    behind_ = has_work;
    viewing_ = overtaken_ = false;
}

void Autosave::take_presets(const io::Project& project) {
    for (const auto& [name, toml] : project.brushes()) brushes_[name] = toml;
    for (const auto& [name, toml] : project.inks()) inks_[name] = toml;
}

void Autosave::adopt(io::Project project, std::vector<stroke::EntryMark> on_disk) {
    attempt([&] {
        take_presets(project);
        take_attachments(project);
        project.listen({});
        project_ = std::move(project);
        on_disk_ = std::move(on_disk);
        wanted_.reset();
        pending_.clear();
        behind_ = overtaken_ = viewing_ = false;
    });
}

void Autosave::view(io::Project project, std::vector<stroke::EntryMark> on_disk) {
    adopt(std::move(project), std::move(on_disk));
    viewing_ = true;
}

bool Autosave::overtaken() {
    if (project_ && !overtaken_) {
        try {
            overtaken_ = project_->changed_outside();
        } catch (const std::exception&) {
            // What is wrong with the file is said when something is written.
        }
    }
    return overtaken_;
}

std::optional<io::Project> Autosave::read_again() {
    std::optional<io::Project> file;
    attempt([&] { file = io::Project::open(path(), {.access = viewing_ ? io::Access::read : io::Access::write}); });
    return file;
}

Message Autosave::start(const std::filesystem::path& path, const std::string& source, const FileFrame& frame,
                        stroke::Document& painting) {
    std::error_code ec;
    if (project_ && std::filesystem::equivalent(path, this->path(), ec) && overtaken() && !viewing_)
        return io::ChangedOutside(path).message();
    try {
        const stroke::Model& model = painting.model();
        io::Project project = io::Project::create(path,
                                                  {.source = source,
                                                   .frame = frame,
                                                   .mesh = *model.mesh,
                                                   .atlas = model.atlas,
                                                   .substrate = ink::substrate_toml(painting.materials().substrate())},
                                                  [&](io::Project& fresh) {
                                                      io::store_recolouring(fresh, painting);
                                                      for (const auto& preset : brushes_) fresh.put_brush(preset);
                                                      for (const auto& preset : inks_) fresh.put_ink(preset);
                                                      for (const auto& [key, attachment] : attached_)
                                                          fresh.put_attachment(key.first, attachment);
                                                      fresh.append(painting.journal().entries());
                                                      if (!painting.journal().empty())
                                                          fresh.save_canvases(stroke::all_canvases(painting),
                                                                              painting.journal().entries().back().id);
                                                  });
        project_ = std::move(project);
        on_disk_ = stroke::marks_of(painting.journal().entries());
        wanted_.reset();
        pending_.clear();
        trouble_ = {};
        behind_ = overtaken_ = viewing_ = false;
        return {};
    } catch (const std::exception& error) {
        return message_of(error);
    }
}

void Autosave::prepare(stroke::Document& painting, const std::string& brush, const std::string& ink) {
    if (wanted_) {
        const PendingProject wanted = *wanted_;
        if (Message fault = start(wanted.path, wanted.source, wanted.frame, painting); !fault.empty())
            wanted_->fault = trouble_ = std::move(fault);
    }
    if (!brush.empty() && !brushes_.contains(brush)) {
        const std::string toml = brush::preset_toml(painting.materials().brush(brush));
        brush::Preset preset = brush::parse_preset(toml, brush);
        preset.name = brush;
        painting.use(preset);
        brushes_[brush] = toml;
        attempt([&] {
            if (project_ && !viewing_) project_->put_brush({brush, toml});
        });
    }
    if (!ink.empty() && !inks_.contains(ink)) {
        const std::string toml = ink::ink_toml(painting.materials().ink(ink));
        ink::Ink parsed = ink::parse_ink(toml, ink);
        parsed.name = ink;
        painting.use(parsed);
        inks_[ink] = toml;
        attempt([&] {
            if (project_ && !viewing_) project_->put_ink({ink, toml});
        });
    }
}

void Autosave::store_appearance(const stroke::Document& painting) {
    attempt([&] {
        if (project_ && !viewing_) io::store_recolouring(*project_, painting);
    });
}

std::vector<std::string> Autosave::inks() const {
    std::vector<std::string> names;
    for (const auto& [name, toml] : inks_) names.push_back(name);
    return names;
}

void Autosave::flush() {
    if (!project_) throw Error(wanted_ ? wanted_->fault : Message("there is no project file"));
    for (const auto& preset : brushes_) project_->put_brush(preset);
    for (const auto& preset : inks_) project_->put_ink(preset);
    append(pending_);
    pending_.clear();
}

void Autosave::append(std::span<const stroke::JournalEntry> strokes) {
    project_->append(strokes);
    for (const stroke::JournalEntry& s : strokes) on_disk_.push_back(stroke::mark_of(s));
}

void Autosave::retry(const std::string& source, const FileFrame& frame, stroke::Document& painting) {
    if (viewing_) return;
    if (wanted_ || behind_) return rewrite(source, frame, painting);
    if (!pending_.empty()) attempt([&] { flush(); });
}

void Autosave::add(const stroke::JournalEntry& stroke) {
    if (viewing_) return;
    attempt([&] {
        if (pending_.empty() && trouble_.empty() && project_) {
            try {
                append(std::span(&stroke, 1));
            } catch (...) {
                pending_.push_back(stroke);
                throw;
            }
        } else {
            pending_.push_back(stroke);
            flush();
        }
    });
}

void Autosave::catch_up(std::span<const stroke::JournalEntry> entries) {
    pending_.assign(entries.begin(), entries.end());
    attempt([&] { flush(); });
}

void Autosave::attach(const std::string& kind, const io::Attachment& attachment) {
    attached_.insert_or_assign({kind, attachment.name}, attachment);
    change([&] { project_->put_attachment(kind, attachment); });
}

void Autosave::detach(const std::string& kind, const std::string& name) {
    attached_.erase({kind, name});
    change([&] { project_->remove_attachment(kind, name); });
}

std::vector<io::Attachment> Autosave::attachments(const std::string& kind) const {
    std::vector<io::Attachment> found;
    for (const auto& [key, attachment] : attached_)
        if (key.first == kind) found.push_back(attachment);
    return found;
}

std::optional<io::Attachment> Autosave::attachment(const std::string& kind, const std::string& name) const {
    const auto at = attached_.find({kind, name});
    return at == attached_.end() ? std::nullopt : std::optional(at->second);
}

void Autosave::take_attachments(const io::Project& project) {
    for (const char* kind : {io::kCopies, io::kReferences, io::kSnapshots})
        for (io::Attachment& attachment : project.attachments(kind))
            attached_.insert_or_assign({kind, attachment.name}, std::move(attachment));
}

void Autosave::remove(std::uint64_t id) {
    const auto waits = std::find_if(pending_.begin(), pending_.end(), [id](const auto& s) { return s.id == id; });
    if (waits != pending_.end()) {
        pending_.erase(waits);
        return;
    }
    change([&] {
        project_->remove(id);
        std::erase_if(on_disk_, [id](const stroke::EntryMark& m) { return m.id == id; });
    });
}

void Autosave::set_hidden(std::uint64_t id, bool hidden) {
    for (stroke::JournalEntry& stroke : pending_)
        if (stroke.id == id) {
            stroke.hidden = hidden;
            return;
        }
    change([&] {
        project_->set_hidden(id, hidden);
        for (stroke::EntryMark& m : on_disk_)
            if (m.id == id) stroke::set_hidden(m, hidden);
    });
}

void Autosave::store_canvas(const stroke::Document& painting) {
    if (painting.journal().empty()) return;
    attempt([&] {
        if (project_ && !viewing_ && pending_.empty() && !behind_)
            project_->save_canvases(stroke::all_canvases(painting), painting.journal().entries().back().id);
    });
}

}  // namespace tuft::app
