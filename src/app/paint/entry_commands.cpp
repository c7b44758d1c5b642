#include "app/paint/entry_commands.h"

namespace tuft::app {

void act_on_brush(PaintContext& context, JournalEditor& journal, const ActOnBrush& command) {
    context.work.autosave.prepare(*context.work.document, command.brush, command.ink);
    stroke::BrushAction action{.what = command.what, .brush = command.brush, .dip = stroke::DipMode::persistent};
    // A brush that is not held yet begins full of the chosen ink.
    if (std::holds_alternative<stroke::Dip>(action.what) || !context.work.document->brushes().find(command.brush))
        action.ink = command.ink;
    journal.add(std::move(action));
}

void tend_ink(PaintContext& context, JournalEditor& journal, const TendInk& command) {
    context.work.autosave.prepare(*context.work.document, "", "");
    std::visit([&](const auto& what) { journal.add(what); }, command.what);
}

void fill_model(PaintContext& context, JournalEditor& journal, const FillModel& command) {
    context.progress("Filling")("", 0);
    context.work.autosave.prepare(*context.work.document, "", command.ink);
    stroke::Fill fill = command.fill;
    fill.ink = command.ink;
    fill.layer = context.layer_of(command.layer);
    fill.mask = command.mask;
    journal.add(std::move(fill));
}

void change_layers(PaintContext& context, JournalEditor& journal, const ChangeLayers& command) {
    const stroke::LayerTable& table = context.work.document->layers().table();
    stroke::LayerEdit edit = command.edit;
    std::string label = edit.layer.name;
    if (edit.what == stroke::LayerChange::remove)
        if (const stroke::Layer* layer = table.find(edit.layer.id)) label = layer->name;
    // The button may be pressed twice before the first new layer is shown.
    if (stroke::Layer& layer = edit.layer; edit.what == stroke::LayerChange::add) {
        if (layer.id < table.next_id) {
            layer.id = 0;
            edit.place = static_cast<std::uint32_t>(table.layers.size());
        }
        const std::string stem = layer.name.substr(0, layer.name.find_last_not_of("0123456789") + 1);
        for (std::size_t n = table.layers.size() + 1; table.find(std::string_view(layer.name)); ++n)
            layer.name = stem + std::to_string(n);
        label = layer.name;
    }
    journal.add({std::move(edit), std::move(label)});
}

// The label names the parts: one, or the first and an ellipsis.
void change_parts(JournalEditor& journal, const ChangeParts& command) {
    if (command.edit.parts.empty()) return;
    std::string label = command.edit.parts.front().name;
    if (command.edit.parts.size() > 1) label += " ...";
    journal.add({command.edit, std::move(label)});
}

void change_masks(PaintContext& context, JournalEditor& journal, const ChangeMasks& command) {
    const auto entry_of = [&](const stroke::MaskEdit& edit) {
        const stroke::Mask* known = context.work.document->masks().table().find(edit.mask.id);
        return stroke::JournalEntry(edit, known ? known->name : edit.mask.name);
    };
    if (command.edit.remove) return journal.add(entry_of(command.edit));
    const stroke::MaskTexels texels =
        stroke::evaluate(command.edit.mask, context.work.document->masks().table(), *context.work.model);
    bool any = false;
    for (std::uint32_t slot = 0; slot < context.work.model->texels.n_slots() && !any; ++slot) any = !texels.none(slot);
    if (!any) return context.outbox.report("Nothing of the model lies in this mask.");
    journal.add(entry_of(command.edit));
    if (command.with == 0) return;
    const stroke::Mask& made = context.work.document->masks().table().masks.back();
    stroke::MaskEdit both;
    both.mask.name = made.name + (command.how == stroke::MaskKind::unite ? " +" : " \xc3\x97");
    both.mask.kind = command.how;
    both.mask.of = {command.with, made.id};
    journal.add(entry_of(both));
    journal.join_last();
}

}  // namespace tuft::app
