#include <algorithm>
#include <set>

#include "app/document/paint_thread.h"
#include "io/project/appearance.h"
#include "io/project/restore.h"

/// What other programs do to the project meanwhile: on the painter's thread.
namespace tuft::app {
namespace {

bool has_model(const io::Project& file, const stroke::Model& model) {
    const io::ProjectModel there = file.model();
    return there.mesh.positions == model.mesh->positions && there.mesh.triangles == model.mesh->triangles &&
           there.atlas.size == model.atlas.size && there.atlas.pages == model.atlas.pages &&
           there.atlas.corner_uvs == model.atlas.corner_uvs;
}

template <class Preset>
Preset named(Preset preset, const std::string& name) {
    preset.name = name;
    return preset;
}

}  // namespace

void PaintThread::look_outside() {
    if (work_.painting->in_stroke() || !work_.autosave.overtaken()) return;
    try {
        take_outside();
    } catch (const std::exception& error) {
        say(error.what());
        publish(true);
    }
}

// Takes in what another program wrote, and writes what it did not know of after that.
void PaintThread::take_outside() {
    Autosave& autosave = work_.autosave;
    const bool viewing = autosave.viewing();
    std::optional<io::Project> file = autosave.read_again();
    if (!file) return publish();
    if (!has_model(*file, *work_.model)) return leave_file();
    const std::vector<stroke::Stroke> theirs = file->strokes();
    std::vector<stroke::EntryMark> marks = stroke::marks_of(theirs);
    const bool same_strokes = marks == autosave.on_disk() && !autosave.behind();
    stroke::MergedJournal merged =
        stroke::merge_journals(autosave.on_disk(), work_.painting->journal().strokes(), theirs);
    if (!same_strokes) {
        const std::lock_guard lock(mutex_);
        update_.from_outside = true;
    }
    if (!same_strokes)
        paint_merged(*file, merged);
    else
        io::show_looks(*file, *work_.painting);
    const bool altered = merged.altered && !same_strokes;
    if (viewing)
        autosave.view(std::move(*file), std::move(marks));
    else
        autosave.adopt(std::move(*file), std::move(marks));
    const std::vector<stroke::Stroke>& now = work_.painting->journal().strokes();
    if (altered)
        autosave.rewrite(work_.source, work_.frame, *work_.painting);
    else if (!viewing)
        autosave.catch_up(std::span(now).subspan(std::min(theirs.size(), now.size())));
    if (merged.news > 0 && !viewing)
        say("Another program changed this project; " + std::to_string(merged.news) +
            (merged.news == 1 ? " change of it is taken in." : " changes of it are taken in."));
    publish(true);
    publish_snapshots();
    publish_looks();
}

void PaintThread::paint_merged(const io::Project& file, const stroke::MergedJournal& merged) {
    const auto shown = [this, name = std::string("Taking in the changes of another program")](std::string_view phase,
                                                                                              double part) {
        progress(name)(phase, part);
        return true;  // half of them would be no journal of anybody
    };
    const auto fresh = [&] {
        auto painting = std::make_unique<stroke::Document>(*work_.model);
        take_presets(*painting, {});
        io::use_presets(file, *painting);
        return painting;
    };
    if (follow(file, merged.entries)) return publish(true);
    auto painting = fresh();
    const auto own = std::span(merged.entries).subspan(merged.from_theirs);
    bool whole = merged.altered || std::ranges::any_of(own, &stroke::Stroke::hidden);
    if (!whole) {
        try {
            io::restore_strokes(file, *painting, shown);
            for (const stroke::Stroke& entry : own) painting->paint(entry, shown);
        } catch (const Error&) {  // such as on a layer that is locked now
            whole = true;
            painting = fresh();
        }
    }
    if (whole) painting->replay(merged.entries, shown);
    io::show_looks(file, *painting);
    steps_.assign(painting->journal().strokes().size(), Step{.made = 1});
    undone_.clear();
    for (const stroke::LayerTexels& layer : painting->canvases())
        for (const std::uint32_t slot : layer.canvas->touched_slots()) painting->canvas().mark_dirty(slot);
    replace_painting(std::move(painting));
    work_.texture->refresh_all(*work_.painting);  // they may show it otherwise
    send_pixels();
}

// Where they only went on, what they did is done here too.
bool PaintThread::follow(const io::Project& file, std::span<const stroke::Stroke> theirs) {
    stroke::Document& painting = *work_.painting;
    const std::vector<stroke::Stroke>& mine = painting.journal().strokes();
    const std::size_t n = mine.size();
    if (theirs.size() < n || !std::equal(mine.begin(), mine.end(), theirs.begin(), [](const auto& a, const auto& b) {
            return stroke::mark_of(a) == stroke::mark_of(b);
        }))
        return false;
    const std::span<const stroke::Stroke> rest = theirs.subspan(n);
    std::set<std::string> brushes, inks;
    for (const stroke::Stroke& s : rest) {
        if (!stroke::has_brush(s.action)) continue;
        if (s.settings.dip == "carry" && !brushes.contains(s.trace.brush) && !painting.held(s.trace.brush))
            return false;
        brushes.insert(s.trace.brush);
    }
    for (const stroke::Stroke& s : rest)
        for (const std::string& ink : stroke::inks_of(s)) inks.insert(ink);
    for (const stroke::Stroke& s : mine) {
        brushes.erase(s.trace.brush);
        for (const std::string& ink : stroke::inks_of(s)) inks.erase(ink);
    }
    for (const auto& [name, toml] : file.brushes())
        if (brushes.contains(name)) painting.use_brush(named(brush::parse_preset(toml, name), name));
    for (const auto& [name, toml] : file.inks())
        if (inks.contains(name)) painting.use_ink(named(ink::parse_ink(toml, name), name));
    painting.replay({rest.begin(), rest.end()}, {});
    steps_.resize(theirs.size(), Step{.made = 1});
    undone_.clear();
    return true;
}

// Another model lies where the project was: what is here goes on in a file of its own.
void PaintThread::leave_file() {
    const std::string name = work_.autosave.path().filename().string();
    const bool viewing = work_.autosave.viewing();
    const std::string fault = work_.autosave.start(work_.spare, work_.source, work_.frame, *work_.painting);
    if (!fault.empty())
        work_.autosave.start_later(work_.spare, work_.source, work_.frame, fault, !work_.painting->journal().empty());
    say(viewing
            ? "Another program put another model into " + name + "; this is a copy of what was in it."
            : "Another program put another model into " + name + "; your work goes on in a copy that has no name yet.");
    publish();
}

}  // namespace tuft::app
