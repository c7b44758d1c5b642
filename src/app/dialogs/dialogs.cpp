#include "app/dialogs/dialogs.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "app/widgets/file_list.h"
#include "core/text/units.h"
#include "io/model/read_model.h"

namespace fs = std::filesystem;

namespace tuft::app {

bool begin_dialog(Ui& ui, const char* title, float width) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * screen.x, 0.48f * screen.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(ImVec2(ui.px(width), 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ui.px(18), ui.px(14)));
    const std::string name = std::string(ui.tr(title)) + "###dialog " + title;
    const bool open = ImGui::Begin(name.c_str(), nullptr,
                                   ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove |
                                       ImGuiWindowFlags_NoSavedSettings);
    if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
    ui.in_dialog = true;
    return open;
}

void end_dialog(Ui& ui) {
    ui.in_dialog = false;
    ImGui::End();
    ImGui::PopStyleVar();
}

void end_dialog_with_file(Session& s, bool& shown, FileDialog::Purpose purpose, const std::string& extension) {
    ImGui::Dummy(ImVec2(0, s.ui.px(4)));
    s.ui.buttons_at_right({{"Cancel", 110}, {"Choose a file...", 160}});
    const bool cancel = s.ui.button("Cancel", nullptr, 110);
    ImGui::SameLine();
    const bool go = s.ui.primary_button("Choose a file...", 160);
    end_dialog(s.ui);
    if (go) s.dialogs.file.show(purpose, project_name(s.paint_thread.get(), s.reported.file.project) + extension);
    if (go || cancel) shown = false;
}

void dialog_row(Ui& ui, const char* name) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", ui.tr(name));
    ImGui::SameLine(ui.px(130));
}

namespace {

// Two columns: name and value.
void fact(Ui& ui, const char* name, const std::string& value) {
    ImGui::TextDisabled("%s", ui.tr(name));
    ImGui::SameLine(ui.px(150));
    ui.wrapped(value);
}

std::string print(const char* format, double a, double b = 0, double c = 0) {
    char text[96];
    std::snprintf(text, sizeof text, format, a, b, c);
    return text;
}

// 1,234,567
std::string grouped(std::size_t number) {
    std::string text = std::to_string(number);
    for (std::size_t i = text.size(); i > 3; i -= 3) text.insert(i - 3, ",");
    return text;
}

/// Begins a row of a dialog: the name of what follows.
void name_row(Ui& ui, const char* name) {
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", ui.tr(name));
    ImGui::SameLine(ui.px(150));
}

void note_beside(const std::string& text) {
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%s", text.c_str());
}

/// Unit of the file's numbers. One that a person chooses goes before the one that the file states.
void unit_row(Ui& ui, const Inspected& in, FileFrame& frame) {
    static const std::vector<std::string> units{"um", "mm", "cm", "m", "in", "ft"},
        stated{"as stated", "um", "mm", "cm", "m", "in", "ft"};
    name_row(ui, "Unit of the file");
    if (!in.unit_stated()) {
        const std::string& guess = in.summary.unit.unit;
        ui.combo("Unit", frame.unit, units, 90);
        return note_beside(frame.unit == guess ? ui.tr("guessed from the size")
                                               : std::string(ui.tr("guessed")) + ": " + guess);
    }
    std::string unit = frame.unit_overrides ? frame.unit : stated.front();
    if (ui.combo("Unit", unit, stated, 90)) {
        frame.unit_overrides = io::overrides_unit(in.soup, unit);
        frame.unit = frame.unit_overrides ? unit : "m";
    }
    note_beside(ui.tr(frame.unit_overrides ? "in place of what the file states" : "stated in the file"));
}

/// Unit and upward axis of a file.
void frame_rows(Ui& ui, const Inspected& in, FileFrame& frame) {
    static const std::vector<std::string> axes{"z", "y"};
    unit_row(ui, in, frame);
    if (io::is_cad_file(in.path)) return;  // its axes are those of the model
    name_row(ui, "Upward axis");
    std::string up = frame.y_up || in.soup.turned_up ? "y" : "z";
    ImGui::BeginDisabled(in.soup.turned_up);
    if (ui.combo("Up", up, axes, 90)) frame.y_up = up == "y";
    ImGui::EndDisabled();
    if (in.soup.turned_up) note_beside(ui.tr("the format says so"));
}

/// Groups and chord tolerance of a CAD file. Returns true when it is to be read anew.
bool cad_rows(Ui& ui, io::CadReading& cad) {
    static const std::vector<std::string> groups{"bodies", "faces"},
        chords{"from the size", "0.5 mm", "0.1 mm", "0.02 mm", "0.005 mm"};
    constexpr std::array<double, 5> kChords{0, 0.5, 0.1, 0.02, 0.005};
    const io::CadReading before = cad;
    name_row(ui, "Groups of the file");
    std::string group = groups[cad.groups == io::CadGroups::faces ? 1 : 0];
    if (ui.combo("CAD groups", group, groups, 90))
        cad.groups = group == groups[1] ? io::CadGroups::faces : io::CadGroups::bodies;
    name_row(ui, "Chord tolerance");
    std::size_t chosen = 0;
    for (std::size_t i = 0; i < kChords.size(); ++i)
        if (kChords[i] * kMillimetre == cad.chord) chosen = i;
    std::string chord = chords[chosen];
    if (ui.combo("Chord tolerance", chord, chords, 140))
        for (std::size_t i = 0; i < chords.size(); ++i)
            if (chords[i] == chord) cad.chord = kChords[i] * kMillimetre;
    return !(cad == before);
}

/// The chord tolerance is in millimetres of the model. Returns true when the file is to be read anew for it.
bool scale_chord(OpenOptions& options) {
    const std::string unit = options.frame.unit_overrides ? options.frame.unit : "";
    return std::exchange(options.cad.unit, unit) != unit && options.cad.chord > 0;
}

/// Texels, material and sides of the model that is made of a file. `area`: m².
void model_rows(Session& s, const mesh::MeshSummary& m, double area) {
    Ui& ui = s.ui;
    auto& options = s.project.options;
    name_row(ui, "Texels per side");
    static const std::vector<std::string> sizes{"1024", "2048", "4096", "8192"};
    std::string atlas = std::to_string(options.atlas_size);
    if (ui.combo("Atlas size", atlas, sizes, 90)) options.atlas_size = static_cast<std::uint32_t>(std::stoul(atlas));
    note_beside(print(ui.tr("one texel is about %.2f mm"), expected_texel(area, options.atlas_size) * 1e3));
    name_row(ui, "Material");
    ui.combo("Surface", options.substrate, s.colours.substrates, 160);
    if (m.has_colours) {
        ImGui::SameLine();
        ui.toggle("in its own colours", options.own_colours);
    }
    if (!s.project.revision.source.empty())
        ui.toggle("Strokes follow the model", options.follow,
                  "Where the model, or a part of it, was moved, turned or scaled, its strokes go with it");
    if (m.report.parts_turned > 0)
        ui.toggle("Sides as in the file", options.turned_round,
                  "It was inside out, and was turned round: ink goes onto the front of its faces");
    else if (!m.report.closed)
        ui.toggle("Faces turned round", options.turned_round,
                  "For a model that is inside out: ink goes onto the front of its faces");
}

}  // namespace

void open_dialog(Session& s) {
    if (!s.project.inspected ||
        !begin_dialog(s.ui, s.project.revision.source.empty() ? "Open model" : "Revised model", 520)) {
        if (s.project.inspected) end_dialog(s.ui);
        return;
    }
    Ui& ui = s.ui;
    const Inspected& in = *s.project.inspected;
    const mesh::MeshSummary& m = in.summary;
    const double factor = in.metres_per_unit(s.project.options.frame) / m.metres_per_unit;
    Vec3 size = m.bounds.size() * factor * 1e3;
    if (s.project.options.frame.y_up && !in.soup.turned_up) std::swap(size.y, size.z);
    fact(ui, "File", in.path.filename().string());
    fact(ui, "Size", print("%.1f \xc3\x97 %.1f \xc3\x97 %.1f mm", size.x, size.y, size.z));
    fact(ui, "Triangles", grouped(m.n_triangles));
    frame_rows(ui, in, s.project.options.frame);
    const bool reread =
        io::is_cad_file(in.path) && (cad_rows(ui, s.project.options.cad) || scale_chord(s.project.options));
    model_rows(s, m, m.area * factor * factor);
    ui.heading("Checked and repaired");
    if (in.defects.empty()) ui.note(ui.tr("The mesh is sound; nothing had to be repaired."));
    for (const Message& line : in.defects) ui.wrapped("\xc2\xb7 " + ui.sentence(line));
    const std::size_t memory = stroke::atlas_memory(s.project.options.atlas_size);
    const bool fits = memory < stroke::available_memory();
    if (!fits) ui.wrapped(ui.tr("This many texels need more memory than is free."));
    ImGui::Dummy(ImVec2(0, ui.px(4)));
    const char* action = s.project.revision.source.empty() ? "Unwrap and paint" : "Unwrap and repaint";
    ui.buttons_at_right({{"Cancel", 120}, {action, 120}});
    const bool cancelled = ui.button("Cancel", nullptr, 120);
    ImGui::SameLine();
    const bool accepted = ui.primary_button(action, 120, fits);
    end_dialog(s.ui);
    if (reread) {
        s.project.opening.inspect(in.path, s.project.options.cad);
        s.project.inspected.reset();
    } else if (accepted) {
        accept_inspected(s);
    } else if (cancelled) {
        s.project.inspected.reset();
    }
}

void opening_progress(Session& s) {
    if (!begin_dialog(s.ui, "Opening", 380)) return end_dialog(s.ui);
    std::string phase = s.project.opening.phase();
    ImGui::TextUnformatted(s.ui.tr(phase.c_str()));
    ImGui::ProgressBar(static_cast<float>(s.project.opening.fraction()), ImVec2(-1, s.ui.px(18)), "");
    s.ui.buttons_at_right({{"Cancel", 110}});
    const bool stop = s.ui.button("Cancel", nullptr, 110);
    end_dialog(s.ui);
    if (stop) s.project.opening.cancel();
}

void recovery_dialog(Session& s) {
    if (s.project.recovery.lost.empty()) return;
    if (!begin_dialog(s.ui, s.project.recovery.confirm_delete ? "Delete this work?" : "Your work is still here", 480))
        return end_dialog(s.ui);
    Ui& ui = s.ui;
    const LostWork work = s.project.recovery.lost.front();
    ui.wrapped(
        ui.tr("tuft studio stopped before you saved this. Nothing is lost: every stroke that you finished is here."));
    ImGui::Dummy(ImVec2(0, ui.px(2)));
    if (const unsigned texture = s.project.start_page.pictures.texture(work.project)) {
        ImGui::Image(reinterpret_cast<ImTextureID>(static_cast<std::intptr_t>(texture)),
                     ImVec2(ui.px(180), ui.px(120)));
        ImGui::Dummy(ImVec2(0, ui.px(2)));
    }
    fact(ui, "Model", fs::path(work.source).filename().string());
    fact(ui, "Project", is_unnamed(work.project) ? ui.tr("not saved under a name yet") : work.project.string());
    fact(ui, "Changed", date_text(work.changed));
    ImGui::Dummy(ImVec2(0, ui.px(4)));
    bool go_on = false, later = false, drop = false;
    if (s.project.recovery.confirm_delete) {
        ui.wrapped(ui.tr("It cannot be brought back."));
        ui.buttons_at_right({{"Keep it", 120}, {"Delete for good", 140}});
        drop = ui.button("Delete for good", nullptr, 140);
        ImGui::SameLine();
        if (ui.primary_button("Keep it", 120)) s.project.recovery.confirm_delete = false;
    } else {
        // A project of its own stays where it is; only the offer goes.
        const bool unnamed = is_unnamed(work.project);
        const char* away = unnamed ? "Delete..." : "Leave it";
        ui.buttons_at_right({{away, 100}, {"Not now", 100}, {"Continue", 140}});
        const bool leave = ui.button(
            away, unnamed ? "Removes this work for good" : "The project stays where it is; it is not offered again",
            100);
        ImGui::SameLine();
        later = ui.button("Not now", "It is offered again at the next start", 100);
        ImGui::SameLine();
        go_on = ui.primary_button("Continue", 140);
        drop = leave && !unnamed;
        s.project.recovery.confirm_delete = leave && unnamed;
    }
    end_dialog(s.ui);
    if (go_on) {
        forget_lost_work(work, false);
        open_path(s, work.project);
    } else if (drop) {
        forget_lost_work(work, true);
        s.project.recovery.confirm_delete = false;
    }
    if (go_on || later || drop) s.project.recovery.lost.erase(s.project.recovery.lost.begin());
}

void settings_dialog(Session& s) {
    if (!s.dialogs.show_settings) return;
    if (!begin_dialog(s.ui, "Settings", 420)) return end_dialog(s.ui);
    Ui& ui = s.ui;
    UiSettings& w = s.preferences.ui;
    bool changed = false;
    ui.heading("Language");
    if (ui.choice("English", w.language == Language::english, nullptr, 120))
        w.language = Language::english, changed = true;
    ImGui::SameLine();
    // In its own script, for those who read no other.
    if (ui.choice(ui.has_chinese ? "中文" : "Chinese", w.language == Language::chinese, nullptr, 120))
        w.language = Language::chinese, changed = true;
    ui.heading("Colours");
    if (ui.choice("Dark", w.theme == Theme::dark, nullptr, 120)) w.theme = Theme::dark, changed = true;
    ImGui::SameLine();
    if (ui.choice("Light", w.theme == Theme::light, nullptr, 120)) w.theme = Theme::light, changed = true;
    ui.heading("Size of text and buttons");
    if (ui.choice("Automatic", !w.own_scale, "As the display asks for it", 96)) w.own_scale = false, changed = true;
    for (const float scale : {1.0f, 1.25f, 1.5f, 2.0f, 2.5f, 3.0f}) {
        char label[16];
        std::snprintf(label, sizeof label, "%.0f %%", 100.0 * static_cast<double>(scale));
        if (scale != 2.5f) ImGui::SameLine();
        if (ui.choice(label, w.own_scale && std::abs(w.scale - scale) < 0.01f, nullptr, 64))
            w.scale = scale, w.own_scale = changed = true;
    }
    ui.heading("Mouse and hand");
    if (ui.choice("As in Blender", s.preferences.keymap == Keymap::blender, "Turn with the middle button", 150))
        s.preferences.keymap = Keymap::blender, changed = true;
    ImGui::SameLine();
    if (ui.choice("As in Maya", s.preferences.keymap == Keymap::maya, "Turn with Alt and the left button", 150))
        s.preferences.keymap = Keymap::maya, changed = true;
    changed |= ui.toggle("Left-handed: tools on the right", w.left_handed);
    bool cap = false;
    if (s.preferences.space_mouse.seen) {
        ui.heading("SpaceMouse");
        if (ui.choice("Moves the model", !s.preferences.space_mouse.moves_eye,
                      "It goes where you push and turn the cap", 150))
            s.preferences.space_mouse.moves_eye = false, cap = true;
        ImGui::SameLine();
        if (ui.choice("Moves the eye", s.preferences.space_mouse.moves_eye, "The cap is your head", 150))
            s.preferences.space_mouse.moves_eye = true, cap = true;
        cap |= ui.toggle("Keep the horizon level", s.preferences.space_mouse.level);
        cap |= ui.slider("Cap speed", s.preferences.space_mouse.speed, {0.1, 4, "%.1f"});
    }
    if (cap) store_settings(s);
    if (ui.button("Keys...", "Look up and change what the keys do", 150)) s.dialogs.show_keys = true;
    ImGui::Dummy(ImVec2(0, ui.px(4)));
    ui.buttons_at_right({{"Close", 110}});
    const bool close = ui.button("Close", nullptr, 110);
    end_dialog(s.ui);
    if (changed) {
        s.preferences.restyle = true;
        store_settings(s);
    }
    if (close) s.dialogs.show_settings = false;
}

}  // namespace tuft::app
