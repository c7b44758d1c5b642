#include "app/paint/ink_commands.h"

#include <algorithm>

#include "stroke/document/pick.h"

namespace tuft::app {

void add_ink(PaintContext& context, ink::Ink ink) {
    const auto known = [&](const std::string& name) {
        const std::vector<std::string> shipped = ink::list_inks(), kept = context.work.autosave.inks();
        return std::find(shipped.begin(), shipped.end(), name) != shipped.end() ||
               std::find(kept.begin(), kept.end(), name) != kept.end();
    };
    const std::string wanted = ink.name;
    for (int n = 2; known(ink.name); ++n) ink.name = wanted + "-" + std::to_string(n);
    context.work.document->use(ink);
    context.work.autosave.prepare(*context.work.document, "", ink.name);
    context.own_inks.push_back(context.work.document->materials().ink(ink.name));
    context.publisher.publish();
    context.outbox.change([&](Update& update) {
        update.events.own_inks = context.own_inks;
        update.events.picked = ink.name;
    });
}

void pick_ink(PaintContext& context, const PickInk& command) {
    stroke::Document& painting = *context.work.document;
    const stroke::Pick pick =
        command.on_palette ? stroke::pick_on_palette(painting, command.point) : stroke::pick(painting, command.point);
    std::optional<ink::Ink> ink = stroke::picked_ink(pick, painting.layers().pigments(), "mixture");
    if (!ink) return context.outbox.report("There is no ink here to pick up.");
    add_ink(context, std::move(*ink));
}

void recolour(PaintContext& context, const RecolourInk& command) {
    context.work.document->appearance().recolour(command.name, command.wanted);
    context.work.autosave.store_appearance(*context.work.document);
    context.publisher.publish();
    context.publisher.publish_appearance();
}

void preview_substrate(PaintContext& context, const PreviewSubstrate& command) {
    stroke::Document& painting = *context.work.document;
    if (command.substrate == painting.materials().substrate().name)
        painting.appearance().preview_substrate(std::nullopt);
    else
        painting.appearance().preview_substrate(ink::load_substrate(command.substrate));
    context.work.autosave.store_appearance(painting);
    painting.appearance().take_dirty();
    context.work.texture->refresh_all(painting);
    context.publisher.forget_thumbnails();
    context.publisher.publish();
    context.publisher.send_texture();
    context.publisher.publish_appearance();
}

void show_mask(PaintContext& context, const ShowMask& command) {
    const stroke::MaskSet& masks = context.work.document->masks();
    const bool there = command.id != 0 && masks.table().find(command.id);
    context.work.texture->show_veil(there ? &masks.texels(command.id) : nullptr, *context.work.document);
    context.publisher.publish();
    context.publisher.send_texture();
}

}  // namespace tuft::app
