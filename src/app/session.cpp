#include "app/session.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>

#include "brush/preset/preset.h"
#include "core/system/files.h"
#include "core/text/units.h"
#include "io/model/read_model.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

// An ink from the eyedropper or a file comes into the hand; the brush goes on.
void take_picked(Session& s, const std::string& name) {
    s.ink = name;
    if (s.tool == Tool::pick) s.tool = Tool::brush;
    const ink::Ink* ink = find_ink(s, name);
    if (!ink) return;
    std::string parts;
    for (const ink::InkPart& part : ink->parts) {
        char text[96];
        std::snprintf(text, sizeof text, "%s%.0f %% %s", parts.empty() ? "" : ", ",
                      100 * part.fraction / std::max(1e-9, ink->strength()), part.pigment.name.c_str());
        parts += text;
    }
    say(s, name + ": " + parts);
}

std::unique_ptr<PaintThread> start_painter(Session& s, PaintThread::Work work) {
    const fs::path project = work.autosave.path();
    if (project.empty() || work.autosave.viewing())
        s.note.clear();  // it is in memory only, or another program's
    else
        s.note.write(project, work.source);
    if (!project.empty() && !is_unnamed(project)) remember_project(project);
    work.spare = s.note.new_project(fs::path(work.source).stem().string());
    return std::make_unique<PaintThread>(std::move(work));
}

// The work lies in this file now.
void take_file(Session& s, const fs::path& project) {
    s.note.write(project, s.painter->source());
    if (is_unnamed(project)) return;
    remember_project(project);
    s.recent = recent_projects();
    // The file that it had before it had a name is of no more use, but as what a revised model is made from.
    std::error_code ec;
    if (const fs::path& before = s.last.project; is_unnamed(before) && before != s.revises && before != s.former)
        fs::remove(before, ec);
}

// A layer just added is painted on, and so is one that an undo brings back after it was removed from under the hand.
// Without the one painted on: the one before it was added, where that is undone, else its neighbour below.
void follow_layers(Session& s, const stroke::LayerTable& now, bool outside) {
    const std::uint32_t before = s.layer, newest = now.next_id - 1;
    if (s.layers_seen == 0)
        s.layer = now.layers.back().id;
    else if (now.next_id > s.layers_seen && !outside && now.find(newest)) {
        if (s.layer != kNewestLayer) s.layers_before.push_back(s.layer);
        s.layer = newest;
    } else if (s.layer == kNewestLayer) {
        if (!s.painter->idle()) return;    // still to come
        s.layer = s.layers_before.back();  // it could not be added
        s.layers_before.pop_back();
    } else if (s.layer_gone != 0 && now.find(s.layer_gone)) {
        s.layer = s.layer_gone;
    }
    if (!now.find(s.layer)) {
        const std::vector<stroke::Layer>& was = s.last.layers.layers;
        const auto place =
            std::find_if(was.begin(), was.end(), [&](const stroke::Layer& l) { return l.id == s.layer; }) - was.begin();
        s.layer_gone = s.layer;
        s.layer = now.layers[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
                                 place - 1, 0, static_cast<std::ptrdiff_t>(now.layers.size()) - 1))]
                      .id;
        for (; now.next_id < s.layers_seen && !s.layers_before.empty(); s.layers_before.pop_back())
            if (now.find(s.layers_before.back())) {
                s.layer = s.layers_before.back();
                s.layers_before.pop_back();
                break;
            }
    } else if (now.find(s.layer_gone)) {
        s.layer_gone = 0;
    }
    s.layers_seen = now.next_id;
    if (s.layer != before) s.layer_opacity = -1;
}

// Settings are pairs of words: blanks in a title become '_'.
std::string as_word(std::string title) {
    std::replace(title.begin(), title.end(), ' ', '_');
    return title;
}
std::string from_word(std::string word) {
    std::replace(word.begin(), word.end(), '_', ' ');
    return word;
}

}  // namespace

void say(Session& s, std::string message) {
    s.message = std::move(message);
    s.message_time = 0;
}

void open_writing(Session& s, const fs::path& path) {
    if (!s.painter) return say(s, "Open a model first; then the writing can be placed on it.");
    try {
        say(s, "");
        s.writing = read_writing(path);
        std::string lost;
        for (const std::string& note : s.writing.notes) lost += (lost.empty() ? "" : "; ") + note;
        if (!lost.empty()) say(s, path.filename().string() + ": " + lost);
        s.tool = Tool::writing;
        const double size = s.painter->model().mesh->bounds.diagonal();
        // A drawing far too large or small for the model comes at a third of it.
        const double own = std::max(s.writing.width, s.writing.height);
        if (own > 0 && (own > size || own < 0.02 * size)) s.writing.scale = 0.33 * size / own;
    } catch (const Error& error) {
        say(s, error.what());
    }
}

void open_ink(Session& s, const fs::path& path) {
    if (!s.painter) return say(s, "Open a model first.");
    try {
        ink::Ink ink = ink::load_ink(path.string());
        if (ink.name.empty()) ink.name = path.stem().string();
        s.painter->post(TakeInk{std::move(ink)});
    } catch (const Error& error) {
        say(s, error.what());
    }
}

void save_ink(Session& s, const fs::path& path) {
    const ink::Ink* ink = find_ink(s, s.ink);
    if (!ink) return;
    ink::Ink named = *ink;
    named.name = path.stem().string();
    try {
        const std::string text = ink::ink_toml(named);
        write_file(path, text.data(), text.size());
        say(s, "Saved as " + path.string());
    } catch (const Error& error) {
        say(s, error.what());
    }
}

const ink::Ink* find_ink(const Session& s, const std::string& name) {
    for (const ink::Ink& ink : s.own_inks)
        if (ink.name == name) return &ink;
    if (s.colour.in_hand && s.colour.in_hand->name == name) return &*s.colour.in_hand;
    static std::map<std::string, std::optional<ink::Ink>> shipped;
    const auto [at, is_new] = shipped.try_emplace(name);
    try {
        if (is_new) at->second = ink::load_ink(name);
    } catch (const Error&) {
        // Whoever paints with it hears why.
    }
    return at->second ? &*at->second : nullptr;
}

void size_brush(Session& s, double factor) {
    const std::string sized = brush::name_of({brush::sized_name(s.brush).base, std::round(1e3 * factor) / 1e3});
    try {
        brush::load_preset(sized);
        s.brush = sized;
    } catch (const Error& error) {
        say(s, error.what());  // not every brush has every size
    }
}

void add_layer(Session& s, const std::string& name) {
    s.painter->post(ChangeLayers{stroke::add_on_top(s.last.layers, name)});
    if (s.layer != kNewestLayer) s.layers_before.push_back(s.layer);
    s.layer = kNewestLayer;
}

void show_palette(Session& s, bool on) {
    s.palette.shown = on;
    if (!on) return;
    s.carry = true;
    say(s, "Pour inks, rinse the brush, stir; then paint on the model with what is in it.");
}

void select_entries(Session& s, std::set<std::uint64_t> ids) {
    JournalState& j = s.journal;
    if (j.selected.empty() && ids.empty()) return;
    j.selected = std::move(ids);
    j.moves = false;
    j.from.reset();
    j.to.reset();
    if (s.painter) s.painter->post(HighlightStrokes{{j.selected.begin(), j.selected.end()}});
}

void choose_mask(Session& s, std::uint32_t id) {
    s.mask = id;
    if (s.veiled == id || !s.painter) return;
    s.veiled = id;
    s.painter->post(ShowMask{id});
}

bool has_unkept_work(const Session& s) {
    return s.painter && (s.last.unkept > 0 || s.last.behind);
}

void leave(Session& s, Leaving leaving) {
    if (!has_unkept_work(s)) return leave_at_once(s, leaving);
    s.files.close();
    s.leaving = std::move(leaving);
    s.painter->post(RetryKeeping{});
}

void leave_at_once(Session& s, const Leaving& leaving) {
    const Leaving now = leaving;
    s.leaving.reset();
    if (now.to == Leaving::To::quit) s.quit = true;
    if (now.to == Leaving::To::open || now.to == Leaving::To::close) {
        close_model(s);
        s.recent = recent_projects();
        s.lost = find_lost_work();
    }
    if (now.to == Leaving::To::open) open_path(s, now.file);
}

void open_in_use(Session& s, OpenAs as) {
    if (!s.in_use) return;
    const fs::path project = s.in_use->project;
    s.in_use.reset();
    s.opening.load(project, s.note.new_project(project.stem().string()), as);
}

void open_path(Session& s, const fs::path& path) {
    if (path.extension() == ".toml") return open_ink(s, path);
    if (const std::string e = path.extension().string(); e == ".svg" || e == ".inkml") return open_writing(s, path);
    if (const std::string e = lower(path.extension().string());
        e == ".png" || e == ".jpg" || e == ".jpeg" || e == ".tif" || e == ".tiff")
        return pin_reference(s, path);
    if (has_unkept_work(s)) return leave(s, {Leaving::To::open, path});
    s.pictures.rest();
    s.in_use.reset();
    s.inspected.reset();
    s.is_sample = false;
    s.revises.clear();
    s.files.close();
    std::error_code ec;
    if (fs::is_regular_file(path, ec) && (path.extension() == ".tuft" || io::is_project(path)))
        s.opening.load(path, s.note.new_project(path.stem().string()));
    else
        s.opening.inspect(path);
}

void open_sample(Session& s, const fs::path& path) {
    open_path(s, path);
    s.is_sample = true;
}

void revise_with(Session& s, const fs::path& path) {
    if (!s.painter) return;
    if (!s.last.trouble.empty()) return say(s, s.ui.tr("The project must be on disk first: ") + s.last.trouble);
    const OpenOptions same{.frame = s.painter->frame(),
                           .atlas_size = s.painter->model().atlas.size,
                           .substrate = s.open_options.substrate,
                           .own_colours = s.open_options.own_colours};
    const fs::path former = s.last.project;
    open_path(s, path);
    s.open_options = same;
    s.revises = former;
}

void open_former(Session& s) {
    if (const fs::path former = s.former; !former.empty()) open_path(s, former);
}

bool close_dialog(Session& s) {
    if (s.files.shown())
        s.files.close();
    else if (s.help.manual)
        s.help.manual = false;
    else if (s.key_asked)
        s.key_asked.reset();
    else if (s.show_keys)
        s.show_keys = false;
    else if (s.show_about)
        s.show_about = false;
    else if (s.show_mismatches)
        s.show_mismatches = false;
    else if (s.journal.moves)
        s.journal.moves = false, s.journal.from.reset(), s.journal.to.reset();
    else if (s.show_settings)
        s.show_settings = false;
    else if (s.show_colours)
        s.show_colours = false;
    else if (s.show_export)
        s.show_export = false;
    else if (s.opening.running())
        s.opening.cancel();
    else if (s.leaving)
        s.leaving.reset();
    else if (s.in_use)
        s.in_use.reset();
    else if (s.inspected)
        s.inspected.reset();
    else if (s.sure_to_delete)
        s.sure_to_delete = false;
    else if (!s.lost.empty() && !s.painter)
        s.lost.erase(s.lost.begin());  // later
    else if (!s.snapshots.compared.empty())
        compare_with(s, "");
    else if (!s.journal.selected.empty())
        select_entries(s, {});
    else
        return false;
    return true;
}

void accept_inspected(Session& s) {
    if (!s.inspected) return;
    const fs::path project = s.note.new_project(s.inspected->path.stem().string());
    if (s.revises.empty())
        s.opening.prepare(std::move(*s.inspected), s.open_options, project);
    else
        s.opening.revise(std::move(*s.inspected), s.open_options, s.revises, project);
    s.inspected.reset();
}

void close_model(Session& s) {
    if (!s.painter) return;
    remember_brush(s);
    s.colour.in_hand.reset();
    s.layer_list.pictures.clear();
    const bool empty = s.strokes.empty() && s.painter->idle();
    fs::path project = s.last.project;
    const bool viewing = s.last.viewing;
    s.left_behind.clear();
    // Finishes and keeps what is in work.
    if (const fs::path spare = s.painter->finish(); !spare.empty()) {
        s.left_behind = project.string() + " could not be written; the work is in " + spare.string() +
                        " and is offered at the next start";
        s.note.write(spare, s.painter->source());
        remember_project(spare);
        project = spare;
    } else if (s.painter->unkept()) {
        s.left_behind = project.string() + " could not be written, and nothing else either: the last strokes are lost";
    }
    s.painter.reset();
    s.strokes.clear();
    s.journal = {};
    s.references.images.clear();  // the textures are the context's until it goes
    s.snapshots = {.swipe = s.snapshots.swipe};
    s.mismatches.clear();
    s.former.clear();
    s.show_mismatches = s.show_colours = false;
    s.mask = s.veiled = s.masks_seen = 0;
    s.layers_seen = s.layer_gone = 0;
    s.layers_before.clear();
    s.lasso.clear();
    s.own_inks.clear();
    s.palette.shown = false;
    s.palette.picture = {};
    s.palette.fresh = true;
    s.tuft = {};
    s.curve = {};
    if (empty && !viewing && is_unnamed(project)) {
        std::error_code ec;
        fs::remove(project, ec);
    }
    if (empty || viewing || !is_unnamed(project)) s.note.clear();
    if (!s.left_behind.empty()) say(s, s.left_behind);
}

void poll_session(Session& s) {
    Opening::Result result = s.opening.poll();
    if (!result.error.empty()) say(s, result.error);
    if (result.in_use) s.in_use = std::move(result.in_use);
    if (result.inspected) {
        s.inspected = std::move(result.inspected);
        // A revised file has the unit of the one before, where that was in a format without one.
        const bool known = !s.revises.empty() && s.painter && !io::metres_per_unit_of(s.painter->source());
        if (!known) s.open_options.frame.unit = s.inspected->summary.unit.unit;
        if (s.inspected->unit_fixed) s.open_options.frame.unit = "m";
        if (s.revises.empty()) {
            const mesh::MeshSummary& m = s.inspected->summary;
            const double factor = metres_per(s.open_options.frame.unit).value_or(m.metres_per_unit) / m.metres_per_unit;
            s.open_options.atlas_size = proposed_size(m.area * factor * factor);
            s.open_options.frame.y_up = false;
        }
        if (s.is_sample) accept_inspected(s);
    }
    const bool opened = result.work.has_value();
    if (result.work) {
        std::vector<stroke::StrokeMismatch> mismatches = std::move(result.work->mismatches);
        std::vector<std::string> fit = std::move(result.work->fit);
        const bool revised = !s.revises.empty();
        // Unnamed work that is left for other work is offered again at the next start.
        if (s.painter && !s.strokes.empty() && is_unnamed(s.last.project)) remember_project(s.last.project);
        std::string note = std::move(result.work->note);
        close_model(s);
        if (!s.left_behind.empty()) note = s.left_behind;
        s.painter = start_painter(s, std::move(*result.work));
        s.last = {};
        if (!find_ink(s, s.ink)) s.ink = "carbon";
        s.model_is_new = true;
        for (const io::Attachment& image : s.painter->carried_references())
            s.references.images.push_back(from_attachment(image));
        if (s.help.by_itself && !s.help.seen && s.help.step < 0) start_guide(s);
        s.keeps_view = revised;
        s.former = s.revises;
        s.symmetry.centre = s.painter->model().mesh->bounds.centre();
        say(s, revised ? "The strokes are painted on the revised model; the former project is as it was." : note);
        s.revises.clear();
        s.mismatches = std::move(mismatches);
        s.fit = std::move(fit);
        s.show_mismatches = !s.mismatches.empty();
    }
    poll_painter(s);
    if (opened) choose_brush(s);
    poll_colour(s);
}

void poll_painter(Session& s) {
    if (!s.painter) return;
    Update u = s.painter->take();
    if (u.strokes) {
        s.strokes = std::move(*u.strokes);
        // What is chosen may be gone, or lie elsewhere.
        std::set<std::uint64_t> there;
        for (const StrokeLine& line : s.strokes)
            if (s.journal.holds(line.id)) there.insert(line.id);
        select_entries(s, std::move(there));
    }
    if (u.snapshots) s.snapshots.lines = std::move(*u.snapshots);
    if (u.snapshot_picture) s.snapshots.picture = std::move(*u.snapshot_picture);
    u.snapshots.reset();
    u.snapshot_picture.reset();
    if (u.outline) s.journal.outline = std::move(*u.outline);
    u.outline.reset();
    if (u.own_inks) s.own_inks = std::move(*u.own_inks);
    for (Thumbnail& picture : u.thumbnails) {
        s.layer_list.fresh.insert(picture.layer);
        s.layer_list.pictures.insert_or_assign(picture.layer, std::move(picture));
    }
    u.thumbnails.clear();
    if (u.palette) {
        s.palette.picture = std::move(*u.palette);
        s.palette.fresh = true;
        u.palette.reset();
    }
    if (u.not_saved) s.files.return_with(u.not_saved->first, u.not_saved->second);
    u.not_saved.reset();
    if (u.looks) s.looks = std::move(*u.looks);
    if (!u.picked.empty()) take_picked(s, u.picked);
    for (std::string& message : u.messages) say(s, std::move(message));
    u.messages.clear();
    if (!u.project.empty() && !u.viewing && u.project != s.last.project) take_file(s, u.project);
    // The scene takes the tiles.
    std::vector<render::TilePixels> tiles = std::move(s.last.tiles);
    tiles.insert(tiles.end(), u.tiles.begin(), u.tiles.end());
    u.tiles = std::move(tiles);
    if (!u.pixels) u.pixels = std::move(s.last.pixels);
    if (!u.tuft) u.tuft = std::move(s.last.tuft);
    follow_layers(s, u.layers, u.from_outside);
    const stroke::MaskTable& masks = u.masks;
    // A mask that was just made is the one wanted; one that is gone holds nothing back.
    if (masks.next_id > s.masks_seen && s.masks_seen > 0 && !masks.masks.empty())
        choose_mask(s, masks.masks.back().id);
    else if (s.mask != 0 && !masks.find(s.mask))
        choose_mask(s, 0);
    s.masks_seen = masks.next_id;
    s.last = std::move(u);
    // What was asked about is on disk now.
    if (s.leaving && !has_unkept_work(s) && s.painter->idle()) leave_at_once(s, *s.leaving);
}

bool settled(const Session& s) {
    return !s.opening.running() && !s.colour.finder.busy() && (!s.painter || s.painter->idle()) && !s.hand_down;
}

void save_as(Session& s, const fs::path& path) {
    if (s.painter) s.painter->post(SaveProject{path});
}

Vec4f section_plane(const Session& s) {
    if (!s.view.section || !s.painter) return Vec4f(0);
    const Box& b = s.painter->model().mesh->bounds;
    Vec3 normal(0);
    normal[s.view.section_axis] = s.view.section_axis == 1 ? -1 : 1;
    const int k = s.view.section_axis;
    const double margin = 1e-3 * b.diagonal();
    const double at = normal[k] > 0 ? b.lo[k] - margin + s.view.section_at * (b.size()[k] + 2 * margin)
                                    : b.hi[k] + margin - s.view.section_at * (b.size()[k] + 2 * margin);
    return Vec4f(Vec4(normal, -normal[k] * at));
}

std::string project_name(const Session& s) {
    if (!s.painter) return "";
    return s.last.project.empty() || is_unnamed(s.last.project) ? fs::path(s.painter->source()).stem().string()
                                                                : s.last.project.stem().string();
}

void pin_reference(Session& s, const fs::path& path) {
    if (!s.painter) return say(s, "Open a model first; then images can be pinned beside it.");
    try {
        ReferenceImage image = read_reference(path);
        References& all = s.references;
        if (all.images.size() >= io::kMostAttachments)
            return say(s, "There are as many images as a project can hold; take one off first.");
        const auto same = std::find_if(all.images.begin(), all.images.end(),
                                       [&](const ReferenceImage& r) { return r.id == image.id; });
        if (same != all.images.end()) {
            same->shown = true;
            return say(s, "This image is pinned already.");
        }
        const double step = 0.04 * static_cast<double>(all.images.size() % 6);
        image.at += Vec2(step);
        all.hidden = false;
        s.painter->post(AttachToProject{io::kReferences, to_attachment(image)});
        all.images.push_back(std::move(image));
    } catch (const Error& error) {
        say(s, error.what());
    }
}

void compare_with(Session& s, const std::string& id) {
    SnapshotState& all = s.snapshots;
    all.compared = id;
    all.ready = false;
    all.picture.reset();
    if (id.empty() || !s.painter) return;
    s.view.atlas = false;
    s.painter->post(ShowSnapshot{id});
}

void fold_panels(Session& s) {
    s.tools_shown = s.journal_shown = !(s.tools_shown || s.journal_shown);
    store_settings(s);
}

namespace {

double number_within(const std::string& text, double lo, double hi) {
    const double number = std::atof(text.c_str());
    return number >= lo ? std::min(number, hi) : lo;  // NaN, too, becomes `lo`
}

}  // namespace

void load_settings(Session& s) {
    std::ifstream in(state_folder() / "settings");
    for (std::string key, value; in >> key >> value;) {
        if (key == "language")
            s.wanted.language = value == "chinese" ? Language::chinese : Language::english;
        else if (key == "theme")
            s.wanted.theme = value == "light" ? Theme::light : Theme::dark;
        else if (key == "own_scale") {
            s.wanted.scale = static_cast<float>(number_within(value, 0.75, 3));
            s.wanted.own_scale = true;
        } else if (key == "guide_seen")
            s.help.seen = value == "1";
        else if (key == "panels") {
            s.tools_shown = value.find('t') != std::string::npos;
            s.journal_shown = value.find('j') != std::string::npos;
        } else if (key.rfind("section:", 0) == 0)
            s.ui.sections[from_word(key.substr(8))] = value == "1";
        else if (key == "left_handed")
            s.wanted.left_handed = value == "1";
        else if (key.rfind("key:", 0) == 0)
            s.keys.restore(key.substr(4), value);
        else if (key == "pen_least")
            s.hand.pen_least = number_within(value, 0.0, 0.9);
        else if (key == "pen_full")
            s.hand.pen_full = number_within(value, s.hand.pen_least + 0.1, 1.0);
        else if (key == "pen_gamma")
            s.hand.pen_gamma = number_within(value, 0.25, 4.0);
        else if (key == "cap_speed")
            s.cap.speed = number_within(value, 0.1, 4.0);
        else if (key == "cap_level")
            s.cap.level = value == "1";
        else if (key == "cap_eye")
            s.cap.moves_eye = value == "1";
        else if (key == "clean_ends")
            s.hand.clean_ends = value == "1";
        else if (key == "keymap")
            s.keymap = value == "maya" ? Keymap::maya : Keymap::blender;
    }
}

void store_settings(const Session& s) {
    std::ostringstream out;
    out << "language " << (s.wanted.language == Language::chinese ? "chinese" : "english") << "\ntheme "
        << (s.wanted.theme == Theme::light ? "light" : "dark") << "\nleft_handed " << s.wanted.left_handed
        << "\nkeymap " << (s.keymap == Keymap::maya ? "maya" : "blender") << "\npen_least " << s.hand.pen_least
        << "\npen_full " << s.hand.pen_full << "\npen_gamma " << s.hand.pen_gamma << "\ncap_speed " << s.cap.speed
        << "\ncap_level " << s.cap.level << "\ncap_eye " << s.cap.moves_eye << "\nclean_ends " << s.hand.clean_ends
        << '\n';
    if (s.wanted.own_scale) out << "own_scale " << s.wanted.scale << '\n';
    out << "guide_seen " << s.help.seen << "\n";
    out << "panels -" << (s.tools_shown ? "t" : "") << (s.journal_shown ? "j" : "") << '\n';
    for (const auto& [title, open] : s.ui.sections) out << "section:" << as_word(title) << ' ' << open << '\n';
    for (const auto& [word, chord] : s.keys.changes()) out << "key:" << word << ' ' << chord << '\n';
    const std::string text = out.str();
    try {
        write_file(state_folder() / "settings", text.data(), text.size());
    } catch (const Error&) {
        // They hold for this run then.
    }
}

}  // namespace tuft::app
