#include <imgui.h>

#include <algorithm>

#include "app/dialogs/dialogs.h"
#include "app/widgets/titles.h"
#include "core/text/units.h"

namespace tuft::app {
namespace {

struct SheetFormat {
    const char *name, *extension, *note;
    bool plates, prints;
};
constexpr SheetFormat kSheetFormats[] = {
    {"PDF", ".pdf", "All pages in one file; cut lines are the spot colour CutContour", true, true},
    {"SVG", ".svg", "One file a page, in millimetres, with its picture", false, true},
    {"DXF", ".dxf", "Cut lines and outlines, in millimetres, for a plotter", false, false},
};

// What a kind of film lets one do.
struct FilmKind {
    const char* name;
    double max_strain, bleed, overlap;  ///< the last two: metres
};
constexpr FilmKind kFilmKinds[] = {{"Water-slide decal", 0.03, 0.003, 0.001}, {"Wrap film", 0.15, 0.075, 0.025}};

struct PageFormat {
    const char* name;
    double width, height;  ///< metres; 0: endless
};
constexpr PageFormat kPageFormats[] = {{"A4", 0.210, 0.297}, {"A3", 0.297, 0.420}, {"Roll, 1370 mm", 1.370, 0}};

template <class T, std::size_t n>
const T& named_of(const T (&all)[n], const std::string& name) {
    const auto at = std::find_if(std::begin(all), std::end(all), [&](const T& one) { return name == one.name; });
    return at == std::end(all) ? all[0] : *at;
}

template <class T, std::size_t n>
std::vector<std::string> names_of(const T (&all)[n]) {
    std::vector<std::string> names;
    for (const T& one : all) names.emplace_back(one.name);
    return names;
}

/// The film: how it follows the surface, and where it is cut.
void film_rows(Ui& ui, DecalSettings& c) {
    dialog_row(ui, "Kind of film");
    std::vector<std::string> kinds = names_of(kFilmKinds);
    if (ui.combo("Kind of film", c.film, kinds, 200)) {
        const FilmKind& kind = named_of(kFilmKinds, c.film);
        c.max_strain = kind.max_strain;
        c.bleed = kind.bleed;
        c.overlap = kind.overlap;
    }
    constexpr float kSliderWidth = 330;
    ui.named_slider("Most strain", c.max_strain, {0.001, 0.5, "%.1f %%", 0.01},
                    "How far the film may be stretched over the model; pieces are cut until it holds",
                    ui.px(kSliderWidth));
    ui.named_slider("Bleed", c.bleed, {0, 0.1, "%.0f mm", kMillimetre}, "Film beyond the paint", ui.px(kSliderWidth));
    ui.named_slider("Overlap", c.overlap, {0, 0.05, "%.0f mm", kMillimetre}, "Of two pieces that meet",
                    ui.px(kSliderWidth));
}

/// The pages and what is printed on them.
void page_rows(Ui& ui, DecalSettings& c, const SheetFormat& format) {
    dialog_row(ui, "Page");
    ui.combo("Page", c.page, names_of(kPageFormats), 200);
    dialog_row(ui, "Dots per inch");
    std::string dpi = std::to_string(c.dpi);
    ImGui::BeginDisabled(!format.prints);
    if (ui.combo("Dots per inch", dpi, {"150", "300", "600", "1200"}, 100)) c.dpi = std::stoi(dpi);
    ImGui::EndDisabled();
    dialog_row(ui, "");
    ImGui::BeginDisabled(!format.plates && !(c.outlines && c.mask.empty()));
    ui.toggle("A plate for each pigment", c.plates, "Separations for screen and pad printing instead of colours");
    ImGui::EndDisabled();
    dialog_row(ui, "");
    ImGui::BeginDisabled(!c.mask.empty());
    ui.toggle("Outlines of inks", c.outlines,
              "What is painted in one ink, or each plate, as filled outlines instead of a picture");
    ImGui::EndDisabled();
    dialog_row(ui, "");
    ImGui::BeginDisabled(!format.prints);
    ui.toggle("Pages of strain", c.strain_map, "A page after each that shows how far its pieces are stretched");
    ImGui::EndDisabled();
    dialog_row(ui, "");
    ui.toggle("Along the grain", c.along_grain, "All pieces point up the page; else they are turned to fill it");
    dialog_row(ui, "");
    ui.toggle("Small fragments too", c.fragments,
              "Pieces that a cut parts from a large one, and specks, however small");
}

}  // namespace

ExportSheets sheets_command(const DecalSettings& c, const stroke::MaskTable& masks, const std::filesystem::path& path) {
    constexpr double kInch = 0.0254;
    const SheetFormat& format = named_of(kSheetFormats, c.format);
    const PageFormat& page = named_of(kPageFormats, c.page);
    ExportSheets command{path, {}};
    io::SheetRequest& request = command.request;
    if (const stroke::Mask* mask = masks.find(c.mask)) request.mask = mask->id;
    request.sheet.outlines = c.outlines && request.mask == 0;
    request.plates = c.plates && (format.plates || request.sheet.outlines);
    request.sheet.max_strain = c.max_strain;
    request.sheet.bleed = c.bleed;
    request.sheet.overlap = c.overlap;
    request.sheet.join = c.join;
    if (c.fragments) request.sheet.least_fragment = 0;
    request.sheet.page = {page.width, page.height};
    request.sheet.upright = c.along_grain;
    request.sheet.pixel = kInch / c.dpi;
    request.sheet.strain_map = c.strain_map && format.prints;
    request.sheet.prints = path.extension() != ".dxf";
    return command;
}

void decals_dialog(Session& s) {
    if (!s.dialogs.show_decals || !s.paint_thread) return;
    if (!begin_dialog(s.ui, "Decal sheets", 460)) return end_dialog(s.ui);
    Ui& ui = s.ui;
    DecalSettings& c = s.dialogs.decal_settings;
    dialog_row(ui, "Format");
    ui.combo("Format", c.format, names_of(kSheetFormats), 200);
    const SheetFormat& format = named_of(kSheetFormats, c.format);
    ui.note(ui.tr(format.note));
    dialog_row(ui, "Areas");
    std::vector<std::string> areas{"All that is painted"};
    for (const stroke::Mask& mask : s.reported.document.masks.masks) areas.push_back(mask_title(ui, mask.name));
    std::string area = s.reported.document.masks.find(c.mask) ? mask_title(ui, c.mask) : areas[0];
    if (ui.combo("Areas", area, areas, 200)) {
        const auto chosen = std::ranges::find(areas, area) - areas.begin();
        c.mask = chosen == 0 ? "" : s.reported.document.masks.masks[static_cast<std::size_t>(chosen - 1)].name;
    }
    film_rows(ui, c);
    page_rows(ui, c, format);
    end_dialog_with_file(s, s.dialogs.show_decals, FileDialog::Purpose::decals, format.extension);
}

}  // namespace tuft::app
