#include "app/paint/ink_commands.h"

#include <algorithm>

namespace tuft::app {

void add_ink(PaintContext& context, ink::Ink ink) {
    const auto known = [&](const std::string& name) {
        const std::vector<std::string> shipped = ink::list_inks(), kept = context.work.autosave.inks();
        return std::find(shipped.begin(), shipped.end(), name) != shipped.end() ||
               std::find(kept.begin(), kept.end(), name) != kept.end();
    };
    const std::string wanted = ink.name;
    for (int n = 2; known(ink.name); ++n) ink.name = wanted + "-" + std::to_string(n);
    context.work.document->use_ink(ink);
    context.work.autosave.prepare(*context.work.document, "", ink.name);
    context.own_inks.push_back(context.work.document->ink(ink.name));
    context.publisher.publish();
    context.outbox.change([&](Update& update) {
        update.events.own_inks = context.own_inks;
        update.events.picked = ink.name;
    });
}

void pick_ink(PaintContext& context, const PickInk& command) {
    stroke::Document& painting = *context.work.document;
    std::optional<ink::Ink> ink = painting.ink_of(
        command.on_palette ? painting.pick_palette(command.point) : painting.pick(command.point), "mixture");
    if (!ink) return context.outbox.report("There is no ink here to pick up.");
    add_ink(context, std::move(*ink));
}

void recolour(PaintContext& context, const RecolourInk& command) {
    context.work.document->recolour(command.name, command.wanted);
    context.work.autosave.store_appearance(*context.work.document);
    context.publisher.publish();
    context.publisher.publish_appearance();
}

void preview_substrate(PaintContext& context, const PreviewSubstrate& command) {
    stroke::Document& painting = *context.work.document;
    if (command.substrate == painting.painted_on().name)
        painting.preview_substrate(std::nullopt);
    else
        painting.preview_substrate(ink::load_substrate(command.substrate));
    context.work.autosave.store_appearance(painting);
    painting.take_dirty();
    context.work.texture->refresh_all(painting);
    context.publisher.forget_thumbnails();
    context.publisher.publish();
    context.publisher.send_texture();
    context.publisher.publish_appearance();
}

void show_mask(PaintContext& context, const ShowMask& command) {
    const bool there = command.id != 0 && context.work.document->masks().find(command.id);
    context.work.texture->show_veil(there ? &context.work.document->mask(command.id) : nullptr, *context.work.document);
    context.publisher.publish();
    context.publisher.send_texture();
}

}  // namespace tuft::app
