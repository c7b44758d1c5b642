#include <imgui.h>

#include <algorithm>

#include "app/panels/panels.h"
#include "app/widgets/titles.h"
#include "app/work/unrolled.h"
#include "brush/preset/preset.h"

/// The list of what was painted, and what can be done with its entries.
namespace tuft::app {
namespace {

constexpr float kRowHeight = 42, kIndent = 16;
constexpr const char* kGroup = "Group";         // the name of a group that is made in the list
constexpr std::size_t kThumbnailStrokes = 300;  // of a group, that its picture shows
constexpr double kThumbnailSpan = 5;            // lengths of its longest stroke, of a text along a path

using Lines = std::vector<const StrokeLine*>;

bool is_stroke(const StrokeLine& line) {
    return line.action == stroke::EntryKind::stroke;
}

unsigned colour_of(const JournalParts& s, const StrokeLine& line) {
    return (ink_colour(s.colours, line.ink) & 0x00ffffffu) | (line.hidden ? 0x60000000u : 0xff000000u);
}

// The path of a stroke; `place` puts a point of it on the screen.
template <class Place>
void draw_path(const JournalParts& s, const StrokeLine& line, float size, const Place& place) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const unsigned colour = colour_of(s, line);
    for (std::size_t i = 1; i < line.path.points.size(); ++i) {
        const Vec3f &a = line.path.points[i - 1], &b = line.path.points[i];
        const ImVec2 from = place(a), to = place(b);
        const float width = 1.0f + 0.055f * size * (a.z + b.z);
        draw->AddLine(from, to, colour, width);
        if (!line.hidden) draw->AddCircleFilled(to, 0.5f * width, colour, 8);  // no notch at the bend
    }
}

void draw_sheet(ImVec2 at, float size, bool hidden) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    draw->AddRectFilled(at, ImVec2(at.x + size, at.y + size), IM_COL32(238, 236, 230, hidden ? 70 : 255), 3);
    draw->AddRect(at, ImVec2(at.x + size, at.y + size), IM_COL32(128, 128, 128, 110), 3);
}

void draw_entry(const JournalParts& s, const StrokeLine& line, ImVec2 at, float size) {
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const ImVec2 middle(at.x + 0.5f * size, at.y + 0.5f * size);
    if (!is_stroke(line)) {
        const bool inked = line.action == stroke::EntryKind::dip || line.action == stroke::EntryKind::fill;
        if (inked) draw->AddCircleFilled(middle, 0.24f * size, ink_colour(s.colours, line.ink), 32);
        draw->AddCircle(middle, 0.24f * size, s.ui.faint, 32);
        return;
    }
    draw_sheet(at, size, line.hidden);
    const float pad = 0.16f * size, inner = size - 2 * pad;
    if (line.length < 1e-3)
        draw->AddCircleFilled(middle, 0.07f * size, colour_of(s, line), 16);  // a touch without a path
    else
        draw_path(s, line, size,
                  [&](const Vec3f& p) { return ImVec2(at.x + pad + p.x * inner, at.y + pad + p.y * inner); });
}

// The frames of flat strokes in one plane; identity where none has a place on the model.
std::vector<PlaneFrame> frames_of(const Lines& lines) {
    std::vector<stroke::Placement> placements;
    for (const StrokeLine* line : lines) {
        const bool follows = !line->placement && !placements.empty();
        placements.push_back(follows ? placements.back() : line->placement.value_or(stroke::Placement{}));
    }
    return unrolled(placements);
}

// The flat strokes of a group in one plane. Of a text along a path they are those of its first characters, which are
// large enough to be read.
struct GroupPicture {
    Lines lines;
    std::vector<PlaneFrame> frames;
    Box box;             // metres
    double longest = 0;  // stroke, metres

    Vec2 in_plane(std::size_t i, const Vec3f& p) const {
        return frames[i].at(lines[i]->path.centre + lines[i]->path.span * (Vec2(p) - 0.5));
    }
};

GroupPicture picture_of(const Lines& lines) {
    GroupPicture picture;
    std::copy_if(lines.begin(), lines.end(), std::back_inserter(picture.lines),
                 [](const StrokeLine* l) { return l->path.flat && !l->path.points.empty(); });
    picture.frames = frames_of(picture.lines);
    for (std::size_t i = 0; i < picture.lines.size();) {
        Box grown = picture.box;
        std::size_t next = i;
        for (; next < picture.lines.size() && picture.frames[next].origin == picture.frames[i].origin; ++next) {
            for (const Vec3f& p : picture.lines[next]->path.points) grown.add(Vec3(picture.in_plane(next, p), 0));
            picture.longest = std::max(picture.longest, picture.lines[next]->path.span);
        }
        if (i > 0 && std::max(grown.size().x, grown.size().y) > kThumbnailSpan * picture.longest) {
            picture.lines.resize(i);
            break;
        }
        picture.box = grown;
        i = next;
    }
    return picture;
}

// All flat strokes in one picture, unrolled from the model; other groups by their first stroke.
void draw_group(const JournalParts& s, const Lines& lines, ImVec2 at, float size) {
    const float shift = s.ui.px(2), side = size - shift;
    const bool hidden = std::all_of(lines.begin(), lines.end(), [](const StrokeLine* l) { return l->hidden; });
    draw_sheet(ImVec2(at.x + shift, at.y - shift), side, hidden);
    draw_sheet(ImVec2(at.x, at.y + shift), side, hidden);
    const GroupPicture picture = picture_of(lines);
    if (picture.lines.empty()) return draw_entry(s, *lines.front(), ImVec2(at.x, at.y + shift), side);
    const float inner = side - 2 * 0.1f * size;
    const double span = std::max({picture.box.size().x, picture.box.size().y, 1e-6});
    // Many characters are small in the picture: thinner, so that they do not run together.
    const auto thickness = static_cast<float>(0.3 * std::min(1.0, 2 * picture.longest / span));
    const std::size_t every = 1 + picture.lines.size() / kThumbnailStrokes;
    for (std::size_t i = 0; i < picture.lines.size(); i += every)
        draw_path(s, *picture.lines[i], thickness * size, [&](const Vec3f& p) {
            const Vec2 d = (picture.in_plane(i, p) - Vec2(picture.box.centre())) / span;
            return ImVec2(at.x + 0.5f * side + static_cast<float>(d.x) * inner,
                          at.y + shift + 0.5f * side + static_cast<float>(d.y) * inner);
        });
}

std::vector<std::uint64_t> ids_of(const Lines& lines) {
    std::vector<std::uint64_t> ids;
    for (const StrokeLine* line : lines) ids.push_back(line->id);
    return ids;
}

Lines chosen_lines(const JournalParts& s) {
    Lines lines;
    for (const StrokeLine& line : s.journal.lines)
        if (s.journal.is_selected(line.id)) lines.push_back(&line);
    return lines;
}

// What all lines have in common, or "" where they differ.
template <class Of>
std::string common(const Lines& lines, const Of& of) {
    std::string value;
    for (const StrokeLine* line : lines) {
        if (!is_stroke(*line)) continue;
        if (!value.empty() && value != of(*line)) return "";
        value = of(*line);
    }
    return value;
}

void post(const JournalParts& s, EditStrokes edit, const Lines& lines) {
    edit.ids = ids_of(lines);
    s.work.post(std::move(edit));
}

std::vector<std::string> all_inks(const JournalParts& s) {
    std::vector<std::string> names = s.colours.shipped;
    for (const ink::Ink& own : s.colours.own) names.push_back(own.name);
    return names;
}

void look_at_outline(const JournalParts& s) {
    Box box;
    for (const OutlinePoint& p : s.journal.outline) box.add(Vec3(p.position));
    if (s.journal.outline.empty()) return;
    const Vec3 margin(0.15 * box.diagonal() + 1e-3);
    s.orbit.frame({box.lo - margin, box.hi + margin});
}

// What can be done with the chosen entries; what is left of the row below them.
void edit_chosen(const JournalParts& s) {
    Ui& ui = s.ui;
    const Lines lines = chosen_lines(s);
    if (lines.empty()) return;
    const bool hidden = std::all_of(lines.begin(), lines.end(), [](const StrokeLine* l) { return l->hidden; });
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2 / ui.settings().scale;
    if (lines.size() > 1) ui.note(ui.sentence(Message("{} entries chosen", lines.size())));
    if (s.viewing) return;
    if (ui.button(hidden ? "Show" : "Hide",
                  hidden ? "Paints it again in its place" : "The other strokes are painted again without it", half))
        post(s, {.hidden = !hidden}, lines);
    ImGui::SameLine();
    if (ui.button("Delete", "Takes the stroke away and paints the others again", half))
        post(s, {.remove = true}, lines);
    if (std::none_of(lines.begin(), lines.end(), [](const StrokeLine* l) { return is_stroke(*l); })) return;
    const bool on_model = std::any_of(lines.begin(), lines.end(), [](const StrokeLine* l) { return !l->on_palette; });
    if (on_model &&
        ui.choice("Move", s.journal.move_on_drag, "Then drag it over the model with the left button", 2 * half + 8))
        s.journal.move_on_drag = !s.journal.move_on_drag;
    std::string brush = common(lines, [](const StrokeLine&l) { return brush::sized_name(l.brush).base; }),
                ink = common(lines, [](const StrokeLine&l) { return l.ink; });
    if (brush.empty()) brush = "Several brushes";
    if (ink.empty()) ink = "Several inks";
    if (ui.combo("Change brush", brush, s.brushes)) post(s, {.brush = brush}, lines);
    if (ui.combo("Change ink", ink, all_inks(s))) post(s, {.ink = ink}, lines);
}

// The same as a menu at the cursor.
void context_menu(const JournalParts& s) {
    Ui& ui = s.ui;
    if (!ImGui::BeginPopupContextItem("entry menu")) return;
    ui.in_menu = true;
    const Lines lines = chosen_lines(s);
    const bool hidden = std::all_of(lines.begin(), lines.end(), [](const StrokeLine* l) { return l->hidden; });
    const bool strokes = std::any_of(lines.begin(), lines.end(), [](const StrokeLine* l) { return is_stroke(*l); });
    const bool grouped = std::any_of(lines.begin(), lines.end(), [](const StrokeLine* l) { return l->group.id != 0; });
    const bool writes = !s.viewing;
    if (ui.menu_item(hidden ? "Show" : "Hide", nullptr, false, writes)) post(s, {.hidden = !hidden}, lines);
    if (ui.menu_item("Move", nullptr, s.journal.move_on_drag, strokes && writes))
        s.journal.move_on_drag = !s.journal.move_on_drag;
    if (strokes && writes && ui.begin_menu("Brush")) {
        for (const std::string& name : s.brushes)
            if (ui.menu_item(name.c_str())) post(s, {.brush = name}, lines);
        ImGui::EndMenu();
    }
    if (strokes && writes && ui.begin_menu("Ink")) {
        for (const std::string& name : all_inks(s))
            if (ui.menu_item(name.c_str())) post(s, {.ink = name}, lines);
        ImGui::EndMenu();
    }
    if (ui.menu_item("Zoom to it", nullptr, false, !s.journal.outline.empty())) look_at_outline(s);
    ImGui::Separator();
    if (ui.menu_item("Make a group", nullptr, false, writes && lines.size() > 1)) post(s, {.group = kGroup}, lines);
    if (ui.menu_item("Ungroup", nullptr, false, writes && grouped)) post(s, {.group = ""}, lines);
    ImGui::Separator();
    if (ui.menu_item("Delete", name_of(s.keys.chord(Action::delete_stroke)).c_str(), false, writes))
        post(s, {.remove = true}, lines);
    ui.in_menu = false;
    ImGui::EndPopup();
}

// A click chooses the row alone; with Ctrl it is added or taken out, with Shift all from the last one on.
void choose_row(const JournalParts& s, const JournalRow& row) {
    JournalState& j = s.journal;
    std::set<std::uint64_t> ids;
    for (const std::size_t i : row.lines) ids.insert(s.journal.lines[i].id);
    const bool all = std::all_of(ids.begin(), ids.end(), [&](std::uint64_t id) { return j.is_selected(id); });
    const ImGuiIO& io = ImGui::GetIO();
    std::set<std::uint64_t> chosen = io.KeyCtrl || io.KeyShift ? j.selected : std::set<std::uint64_t>{};
    const auto anchor = std::find_if(s.journal.lines.begin(), s.journal.lines.end(),
                                     [&](const StrokeLine& l) { return l.id == j.anchor; });
    if (io.KeyShift && anchor != s.journal.lines.end()) {
        const auto from = static_cast<std::size_t>(anchor - s.journal.lines.begin());
        for (std::size_t i = std::min(from, row.lines.front()); i <= std::max(from, row.lines.back()); ++i)
            chosen.insert(s.journal.lines[i].id);
    } else if (all && (io.KeyCtrl || j.selected.size() == ids.size())) {
        for (const std::uint64_t id : ids) chosen.erase(id);
    } else {
        chosen.insert(ids.begin(), ids.end());
    }
    if (!io.KeyShift) {
        j.anchor = s.journal.lines[row.lines.back()].id;
        j.anchor_inside = row.inside;
    }
    select_entries(s.journal, &s.work, std::move(chosen));
}

struct RowText {
    std::string title, below;
};

const char* layer_change(stroke::LayerChange change) {
    switch (change) {
        case stroke::LayerChange::add:
            return "New layer";
        case stroke::LayerChange::change:
            return "Layer changed";
        case stroke::LayerChange::remove:
            return "Layer removed";
        case stroke::LayerChange::duplicate:
            return "Layer duplicated";
        case stroke::LayerChange::merge:
            return "Layers merged";
    }
    return "Layer";
}

std::string listed(const Ui& ui, const std::vector<std::string>& names) {
    constexpr std::size_t kMostNames = 6;
    std::string list;
    for (std::size_t i = 0; i < std::min(names.size(), kMostNames); ++i) list += (i ? ", " : "") + names[i];
    return names.size() > kMostNames ? ui.sentence(Message("{} and {} more", list, names.size() - kMostNames)) : list;
}

std::string part_words(const Ui& ui, const PartChange& change) {
    const std::string names = listed(ui, change.names);
    switch (change.what) {
        case PartChange::What::hidden:
            return ui.sentence(Message("hidden: {}", names));
        case PartChange::What::shown:
            return ui.sentence(Message("shown: {}", names));
        case PartChange::What::locked:
            return ui.sentence(Message("locked: {}", names));
        case PartChange::What::unlocked:
            return ui.sentence(Message("unlocked: {}", names));
        case PartChange::What::made_of:
            return ui.sentence(Message("made of {}: {}", ui.title(change.substrate), names));
        case PartChange::What::as_model:
            return ui.sentence(Message("made of the same as the model: {}", names));
    }
    return names;
}

std::string part_words(const Ui& ui, const std::vector<PartChange>& changes) {
    std::string words;
    for (const PartChange& change : changes) words += (words.empty() ? "" : "; ") + part_words(ui, change);
    return words;
}

RowText text_of(const JournalParts& s, const StrokeLine& line, std::size_t number) {
    static const char* actions[] = {"",     "Dip",  "Rinse", "Comb", "Dry",  "Layer",
                                    "Mask", "Fill", "Wipe",  "Wash", "Parts"};
    std::string title = std::to_string(number) + "   ";
    char length[32];
    std::snprintf(length, sizeof length, "%.0f mm", line.length * 1e3);
    if (line.on_palette)
        title += s.ui.tr("Palette");
    else if (!is_stroke(line))
        title += s.ui.tr(line.change ? layer_change(*line.change) : actions[static_cast<int>(line.action)]);
    else
        title += length + (line.erases ? std::string("   ") + s.ui.tr("erased") : std::string());
    if (line.action == stroke::EntryKind::mask) return {title, mask_title(s.ui, line.label)};
    if (line.action == stroke::EntryKind::part) return {title, part_words(s.ui, line.part_changes)};
    if (stroke::keeps_texels(line.action)) return {title, line.change ? layer_title(s.ui, line.label) : line.label};
    const char* between = line.ink.empty() || line.brush.empty() ? "" : " \xc2\xb7 ";
    return {title, s.ui.title(line.brush) + between + s.ui.tr(line.ink.c_str())};
}

// The triangle before a group, which opens and closes it.
void fold_arrow(const JournalParts& s, std::uint64_t group, const std::string& name, float size) {
    const bool open = s.journal.open_groups.contains(group);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (ImGui::InvisibleButton("##open", ImVec2(s.ui.px(kIndent), size)))
        open ? void(s.journal.open_groups.erase(group)) : void(s.journal.open_groups.insert(group));
    s.ui.mark("open " + name);
    s.ui.fold_arrow(at.x + 0.4f * s.ui.px(kIndent), at.y + 0.5f * size, open);
    ImGui::SameLine(0, 0);
}

// The name that the studio gives is stored in English.
std::string group_title(const Ui& ui, const std::string& name) {
    return name == kGroup ? ui.tr(kGroup) : name;
}

void draw_row(const JournalParts& s, const JournalRow& row) {
    const float size = s.ui.px(kRowHeight);
    Lines lines;
    for (const std::size_t i : row.lines) lines.push_back(&s.journal.lines[i]);
    const StrokeLine& newest = *lines.back();
    ImGui::PushID(static_cast<int>(row.group ? row.group : newest.id));
    if (row.group) ImGui::PushID("group");
    if (row.group) fold_arrow(s, row.group, newest.group.name, size);
    if (row.inside) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + s.ui.px(kIndent));
    const bool chosen =
        std::all_of(lines.begin(), lines.end(), [&](const StrokeLine* l) { return s.journal.is_selected(l->id); });
    const ImVec2 at = ImGui::GetCursorScreenPos();
    if (s.ui.entry("##row", chosen, size)) choose_row(s, row);
    if (ImGui::IsItemClicked(1) && !chosen) choose_row(s, row);
    const std::string name =
        row.group ? "group " + newest.group.name : "stroke " + std::to_string(row.lines.front() + 1);
    s.ui.mark(name);
    const bool over = ImGui::IsItemHovered();
    context_menu(s);
    RowText text;
    if (row.group) {
        draw_group(s, lines, at, size);
        const auto n = static_cast<std::size_t>(
            std::count_if(lines.begin(), lines.end(), [](const StrokeLine* l) { return is_stroke(*l); }));
        // A drawing in its colours has areas alone; a group of other entries has any of them.
        const bool areas = std::all_of(lines.begin(), lines.end(), [](const StrokeLine* l) { return l->is_area; });
        const Message count = n > 0   ? Message(n == 1 ? "{} stroke" : "{} strokes", n)
                              : areas ? Message(lines.size() == 1 ? "{} area" : "{} areas", lines.size())
                                      : Message(lines.size() == 1 ? "{} entry" : "{} entries", lines.size());
        text = {group_title(s.ui, newest.group.name), s.ui.sentence(count)};
    } else {
        draw_entry(s, newest, at, size);
        text = text_of(s, newest, row.lines.front() + 1);
    }
    const bool hidden = std::all_of(lines.begin(), lines.end(), [](const StrokeLine* l) { return l->hidden; });
    const float x = at.x + size + s.ui.px(10), line_height = ImGui::GetTextLineHeight();
    ImDrawList* draw = ImGui::GetWindowDrawList();
    const float room = ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x - x;
    const std::string title = s.ui.fitted(text.title, room), below = s.ui.fitted(text.below, room);
    draw->AddText(ImVec2(x, at.y + 0.5f * size - line_height - 1), hidden ? s.ui.faint : s.ui.strong, title.c_str());
    draw->AddText(ImVec2(x, at.y + 0.5f * size + 1), chosen ? s.ui.strong : s.ui.faint, below.c_str());
    if (over && !row.group && !newest.label.empty())
        ImGui::SetTooltip("%s", (stroke::keeps_texels(newest.action) ? text.below : newest.label).c_str());
    else if (over && (title != text.title || below != text.below))
        ImGui::SetTooltip("%s\n%s", text.title.c_str(), text.below.c_str());
    // Below the row that was clicked last.
    if (newest.id == s.journal.anchor && s.journal.is_selected(newest.id) && row.inside == s.journal.anchor_inside)
        edit_chosen(s);
    if (row.group) ImGui::PopID();
    ImGui::PopID();
}

void draw_rows(const JournalParts& s) {
    const std::vector<JournalRow> rows = journal_rows(s.journal.lines, s.journal.open_groups);
    const float height = s.ui.px(kRowHeight) + ImGui::GetStyle().ItemSpacing.y;
    // Rows are of one height but for the one with the buttons below it.
    const auto edited = std::find_if(rows.begin(), rows.end(), [&](const JournalRow& row) {
        return s.journal.is_selected(s.journal.anchor) && s.journal.lines[row.lines.back()].id == s.journal.anchor &&
               row.inside == s.journal.anchor_inside;
    });
    const auto clipped = [&](std::size_t from, std::size_t to) {
        if (from >= to) return;
        ImGuiListClipper clipper;
        clipper.Begin(static_cast<int>(to - from), height);
        while (clipper.Step())
            for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i)
                draw_row(s, rows[from + static_cast<std::size_t>(i)]);
    };
    const auto at = static_cast<std::size_t>(edited - rows.begin());
    clipped(0, at);
    if (edited == rows.end()) return;
    draw_row(s, *edited);
    clipped(at + 1, rows.size());
}

}  // namespace

void history_buttons(const HistoryParts& s) {
    Ui& ui = s.ui;
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2 / ui.settings().scale;
    if (ui.button("Undo", name_of(s.keys.chord(Action::undo)).c_str(), half, s.reported.document.can_undo))
        s.work.post(UndoStroke{});
    ImGui::SameLine();
    if (ui.button("Redo", name_of(s.keys.chord(Action::redo)).c_str(), half, s.reported.document.can_redo))
        s.work.post(RedoStroke{});
    if (s.reported.progress.busy.empty()) return;
    ImGui::TextUnformatted(ui.tr(s.reported.progress.busy.c_str()));
    ImGui::ProgressBar(static_cast<float>(s.reported.progress.fraction), ImVec2(-1, ui.px(16)), "");
    if (ui.button("Stop")) s.work.stop_long_work();
}

void journal_section(const JournalParts& s) {
    Ui& ui = s.ui;
    ui.heading("Journal");
    if (s.journal.lines.empty())
        ui.note(ui.tr("Every stroke you paint is listed here, and can be hidden, changed or taken out later."));
    // The list has room for its scrollbar beside the rows.
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::SetNextWindowContentSize(ImVec2(width, 0));
    ImGui::BeginChild("strokes", ImVec2(width + ImGui::GetStyle().ScrollbarSize + ui.px(2), 0));
    draw_rows(s);
    ImGui::EndChild();
}

}  // namespace tuft::app
