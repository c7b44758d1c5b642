#include "app/paint/export_command.h"

#include "io/export/export.h"
#include "io/export/export_maps.h"
#include "io/image/image.h"
#include "io/strokes/inkml.h"
#include "pictures/picture_look.h"
#include "render/picture/glass.h"
#include "stroke/journal/recorded_journal.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

// The base colour as the path says; NAME_normal and so on beside it.
void export_maps(const ExportModel& command, const stroke::Document& painting, const ink::ComposeOptions& compose) {
    std::vector<std::string> names{"base-colour"};
    if (command.orm) names.emplace_back("roughness");
    if (command.height) names.insert(names.end(), {"normal", "height"});
    if (command.pigments && command.path.extension() == ".exr" && !painting.layers().pigments().empty())
        names.emplace_back("pigments");
    io::write_together(command.path, [&](const fs::path& folder) {
        for (const std::string& name : names) {
            const std::string suffix = name == "base-colour" ? "" : "_" + name;
            io::write_map(folder / (command.path.stem().string() + suffix + command.path.extension().string()), name,
                          painting, compose, {.bits = 16});
        }
    });
}

void export_strokes(PaintContext& context, const std::filesystem::path& path) {
    const stroke::RecordedJournal written = stroke::record(context.work.document->journal().entries());
    if (written.strokes.empty()) throw Error("There are no strokes to export yet.");
    io::write_inkml(path, written.strokes, path.stem().string());
    context.outbox.report(Message(
        written.left_out > 0 ? "Exported {}; changes of layers and masks are not in a stroke file" : "Exported {}",
        path.string()));
    context.publisher.publish();
}

void draw_pictures(PaintContext& context, const ExportModel& command, const stroke::Document& painting) {
    const stroke::Model& m = painting.model();
    const pictures::PictureLook look = pictures::make_look(m, &painting, "", false);
    const render::Glass glass = pictures::glass_of(look, painting);
    for (int i = 0; i < command.pictures; ++i) {
        render::PictureOptions options;
        options.width = command.picture_width;
        options.height = command.picture_width * 9 / 16;
        options.view.azimuth = command.azimuth;
        options.view.elevation = command.elevation;
        const ProgressFn shown = context.progress("Taking pictures");
        options.progress = [&](std::string_view phase, double part) {
            return shown(phase, (i + part) / command.pictures);
        };
        if (command.pictures > 1) options = render::turntable_frame(options, i, command.pictures);
        const render::Image image =
            render::render_with_glass(*m.mesh, *painting.parts().surface(), look.appearance, glass, options);
        char number[16] = "";
        if (command.pictures > 1) std::snprintf(number, sizeof number, "-%03d", i);
        std::filesystem::path file = command.path;
        file.replace_filename(command.path.stem().string() + number + ".picture.png");
        io::write_image(file, io::view_of(image.width, image.height, 3, image.rgb.data()));
    }
}

}  // namespace

void export_model(PaintContext& context, const ExportModel& command) {
    const stroke::Document* painting = context.work.document.get();
    context.progress("Exporting")("", 0);
    if (command.path.extension() == ".inkml") return export_strokes(context, command.path);
    // At another size the strokes are painted anew beside what is there.
    std::unique_ptr<stroke::Model> model;
    std::unique_ptr<stroke::Document> resized;
    if (command.size && command.size != context.work.model->atlas.size) {
        stroke::ModelOptions options;
        options.unwrap.size = command.size;
        options.progress = context.progress("Exporting");
        model = std::make_unique<stroke::Model>(stroke::rescale_model(
            stroke::prepare_model(*context.work.model->mesh, context.work.model->atlas, options.progress), options));
        resized = std::make_unique<stroke::Document>(*model);
        context.take_presets(*resized, {});
        resized->replay(context.work.document->journal().entries(), context.progress("Exporting"));
        painting = resized.get();
    }
    const stroke::Model& m = painting->model();
    ink::ComposeOptions compose = painting->appearance().compose_options();
    compose.progress = context.progress("Exporting");
    if (const fs::path e = command.path.extension(); e == ".png" || e == ".exr") {
        export_maps(command, *painting, compose);
        if (command.pictures > 0) draw_pictures(context, command, *painting);
        context.outbox.report(Message("Exported {}", command.path.string()));
        return context.publisher.publish();
    }
    io::ModelMaps maps =
        io::make_maps(painting->appearance().stack(), m.texels, painting->appearance().substrate(), compose);
    if (!command.height) maps.height = {};
    if (!command.orm) maps.orm = {};
    const std::vector<Message> notes = io::export_model(
        command.path, *m.mesh, m.atlas, maps,
        {.frame = context.work.frame,
         .painted = io::painted_parts(painting->appearance().stack(), *m.mesh, m.atlas, m.texels),
         .transmits = io::transmitting_parts(painting->appearance().stack(), painting->appearance().substrate(),
                                             *m.mesh, m.atlas, m.texels),
         .progress = context.progress("Exporting")});
    if (command.pictures > 0) draw_pictures(context, command, *painting);
    context.outbox.report(notes.empty() ? Message("Exported {}", command.path.string())
                                        : Message("Exported {}; {}", command.path.string(), notes.front()));
    context.publisher.publish();
}

}  // namespace tuft::app
