#include <imgui.h>

#include <algorithm>

#include "app/dialogs/dialogs.h"

namespace tuft::app {
namespace {

// What programs want: format, maps, and the largest side they like.
struct Preset {
    const char *name, *extension, *note;
    bool roughness, relief;
    std::uint32_t most;  ///< texels per side; 0: any
};
constexpr Preset kPresets[] = {
    {"Blender", ".glb", "One GLB file; File > Import > glTF 2.0", true, true, 0},
    {"Unreal", ".glb", "One GLB file; drag it into the content browser", true, true, 8192},
    {"Unity", ".gltf", "glTF with pictures beside it, for the glTFast package", true, true, 8192},
    {"Web", ".glb", "A small GLB file for model viewers in a browser", false, false, 2048},
    {"16-bit maps", ".png", "PNG pictures alone, 16 bits a channel, one for each map", true, true, 0},
    {"EXR maps", ".exr", "Floating-point pictures alone, linear colour, one for each map", true, true, 0},
    {"Strokes", ".inkml", "The strokes alone, to be painted again with tuft paint", false, false, 0},
    {"Print proof", ".obj", "OBJ, MTL and PNG for colour printers and print shops", false, false, 0},
};

const Preset& preset_of(const std::string& name) {
    const auto at =
        std::find_if(std::begin(kPresets), std::end(kPresets), [&](const Preset& p) { return name == p.name; });
    return at == std::end(kPresets) ? kPresets[0] : *at;
}

void choose_preset(Session& s) {
    const Preset& p = preset_of(s.dialogs.export_settings.preset);
    s.dialogs.export_settings.relief = p.relief;
    s.dialogs.export_settings.roughness = p.roughness;
    const std::uint32_t painted = s.paint_thread ? s.paint_thread->model().atlas.size : 0;
    s.dialogs.export_settings.size = p.most && painted > p.most ? p.most : 0;
}

/// The maps that are written, and their size.
void map_rows(Ui& ui, ExportSettings& c, std::uint32_t painted) {
    dialog_row(ui, "Maps");
    bool colour = true;
    ImGui::BeginDisabled();
    ui.toggle("Base colour", colour);
    ImGui::EndDisabled();
    dialog_row(ui, "");
    ui.toggle("Roughness", c.roughness, "Occlusion, roughness and metal in one picture");
    dialog_row(ui, "");
    ui.toggle("Relief of the ink", c.relief, "A normal map made from the film's height");
    if (preset_of(c.preset).extension == std::string(".exr")) {
        dialog_row(ui, "");
        ui.toggle("Pigment amounts", c.pigments, "A channel for each pigment, in film units");
    }
    dialog_row(ui, "Texels per side");
    static const std::vector<std::string> sizes{"As painted", "512", "1024", "2048", "4096", "8192"};
    std::string size = c.size ? std::to_string(c.size) : "As painted";
    if (ui.combo("Export size", size, sizes, 130))
        c.size = size == "As painted" ? 0 : static_cast<std::uint32_t>(std::stoul(size));
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("%u", painted);
    ui.hint("Another size is painted anew from the strokes, not scaled");
}

/// The pictures of the model that are drawn beside the maps.
void picture_rows(Ui& ui, ExportSettings& c) {
    dialog_row(ui, "Pictures");
    static const std::vector<std::string> pictures{"None", "One, as seen now", "24 all round", "72 all round"};
    static constexpr int counts[] = {0, 1, 24, 72};
    const auto at =
        static_cast<std::size_t>(std::find(std::begin(counts), std::end(counts), c.picture) - std::begin(counts));
    std::string picture = pictures[std::min<std::size_t>(at, 3)];
    if (ui.combo("Pictures of it", picture, pictures, 200))
        c.picture = counts[std::find(pictures.begin(), pictures.end(), picture) - pictures.begin()];
    if (!c.picture) return;
    dialog_row(ui, "");
    static const std::vector<std::string> widths{"640", "1280", "1920", "3840"};
    std::string width = std::to_string(c.picture_width);
    if (ui.combo("Picture width", width, widths, 100)) c.picture_width = std::stoi(width);
    ImGui::SameLine();
    ImGui::AlignTextToFramePadding();
    ImGui::TextDisabled("\xc3\x97 %d", c.picture_width * 9 / 16);
}

}  // namespace

ExportModel export_command(const ExportSettings& c, const Orbit& seen_from, const std::filesystem::path& path) {
    return {.path = path,
            .height = c.relief,
            .orm = c.roughness,
            .pigments = c.pigments,
            .size = c.size,
            .pictures = c.picture,
            .picture_width = c.picture_width,
            .azimuth = seen_from.azimuth,
            .elevation = seen_from.elevation};
}

void export_dialog(Session& s) {
    if (!s.dialogs.show_export || !s.paint_thread) return;
    if (!begin_dialog(s.ui, "Export", 460)) return end_dialog(s.ui);
    Ui& ui = s.ui;
    ExportSettings& c = s.dialogs.export_settings;
    std::vector<std::string> names;
    for (const Preset& p : kPresets) names.emplace_back(p.name);
    dialog_row(ui, "For");
    if (ui.combo("Preset", c.preset, names)) choose_preset(s);
    ui.note(ui.tr(preset_of(c.preset).note));
    const bool strokes_alone = preset_of(c.preset).extension == std::string(".inkml");
    if (strokes_alone && std::any_of(s.journal.lines.begin(), s.journal.lines.end(),
                                     [](const StrokeLine& l) { return stroke::keeps_texels(l.action); }))
        ui.wrapped(ui.tr("Strokes name their layer and mask; what layers and masks are stays in the project."));
    ImGui::BeginDisabled(strokes_alone);
    map_rows(ui, c, s.paint_thread->model().atlas.size);
    picture_rows(ui, c);
    ImGui::EndDisabled();
    end_dialog_with_file(s, s.dialogs.show_export, FileDialog::Purpose::export_model, preset_of(c.preset).extension);
}

}  // namespace tuft::app
