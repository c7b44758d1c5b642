#include "app/paint/entry_commands.h"

namespace tuft::app {

void act_on_brush(PaintContext& context, JournalEditor& journal, const ActOnBrush& command) {
    context.work.autosave.prepare(*context.work.document, command.brush, command.ink);
    stroke::Stroke entry;
    entry.action = command.action;
    entry.trace.flat = false;
    entry.trace.brush = command.brush;
    // A brush that is not held yet begins full of the chosen ink.
    if (command.action == stroke::Action::dip || !context.work.document->held(command.brush))
        entry.trace.ink = command.ink;
    entry.seconds = command.seconds;
    entry.extent = command.extent;
    entry.settings.dip = "carry";
    journal.add(std::move(entry));
}

void fill_model(PaintContext& context, JournalEditor& journal, const FillModel& command) {
    context.progress("Filling")("", 0);
    context.work.autosave.prepare(*context.work.document, "", command.ink);
    stroke::Stroke entry;
    entry.action = stroke::Action::fill;
    entry.trace.flat = false;
    entry.trace.ink = command.ink;
    entry.fill = command.fill;
    entry.layer = context.layer_of(command.layer);
    entry.mask = command.mask;
    journal.add(std::move(entry));
}

void change_layers(PaintContext& context, JournalEditor& journal, const ChangeLayers& command) {
    stroke::Stroke entry;
    entry.action = stroke::Action::layer;
    entry.trace.flat = false;
    entry.trace.label = command.edit.layer.name;
    if (command.edit.what == stroke::LayerChange::remove)
        if (const stroke::Layer* layer = context.work.document->layers().find(command.edit.layer.id))
            entry.trace.label = layer->name;
    entry.edit = command.edit;
    // The button may be pressed twice before the first new layer is shown.
    if (stroke::Layer& layer = entry.edit.layer; command.edit.what == stroke::LayerChange::add) {
        const stroke::LayerTable& table = context.work.document->layers();
        if (layer.id < table.next_id) {
            layer.id = 0;
            entry.edit.place = static_cast<std::uint32_t>(table.layers.size());
        }
        const std::string stem = layer.name.substr(0, layer.name.find_last_not_of("0123456789") + 1);
        for (std::size_t n = table.layers.size() + 1; table.find(std::string_view(layer.name)); ++n)
            layer.name = stem + std::to_string(n);
        entry.trace.label = layer.name;
    }
    journal.add(std::move(entry));
}

void change_masks(PaintContext& context, JournalEditor& journal, const ChangeMasks& command) {
    const auto entry_of = [&](const stroke::MaskEdit& edit) {
        stroke::Stroke entry;
        entry.action = stroke::Action::mask;
        entry.trace.flat = false;
        const stroke::Mask* known = context.work.document->masks().find(edit.mask.id);
        entry.trace.label = known ? known->name : edit.mask.name;
        entry.mask_edit = edit;
        return entry;
    };
    if (command.edit.remove) return journal.add(entry_of(command.edit));
    const stroke::MaskTexels texels =
        stroke::evaluate(command.edit.mask, context.work.document->masks(), *context.work.model);
    bool any = false;
    for (std::uint32_t slot = 0; slot < context.work.model->texels.n_slots() && !any; ++slot) any = !texels.none(slot);
    if (!any) return context.outbox.report("Nothing of the model lies in this mask.");
    journal.add(entry_of(command.edit));
    if (command.with == 0) return;
    const stroke::Mask& made = context.work.document->masks().masks.back();
    stroke::MaskEdit both;
    both.mask.name = made.name + (command.how == stroke::MaskKind::unite ? " +" : " \xc3\x97");
    both.mask.kind = command.how;
    both.mask.of = {command.with, made.id};
    journal.add(entry_of(both));
    journal.join_last();
}

}  // namespace tuft::app
