#include "app/work/paint_context.h"

#include <algorithm>

namespace tuft::app {

PaintContext::PaintContext(PaintWork open, Outbox& window)
    : work(std::move(open)), outbox(window), publisher(work, history, window) {
    work.document->appearance().take_dirty();
    const std::vector<std::string> shipped = ink::list_inks();
    for (const std::string& name : work.autosave.inks())
        if (std::find(shipped.begin(), shipped.end(), name) == shipped.end())
            own_inks.push_back(work.document->materials().ink(name));
    outbox.change([&](Update& update) { update.events.own_inks = own_inks; });
    history.reset(work.document->journal().entries().size());
    publisher.publish_appearance();
    publisher.publish_snapshots();
    publisher.publish(true);
}

ProgressFn PaintContext::progress(const std::string& name) {
    return [this, name](std::string_view, double fraction) {
        outbox.show_progress(name, fraction);
        return !stop.load();
    };
}

std::uint32_t PaintContext::layer_of(std::uint32_t requested) const {
    const stroke::LayerTable& table = work.document->layers().table();
    if (requested != kNewestLayer) return requested;
    return table.find(table.next_id - 1) ? table.next_id - 1 : table.layers.back().id;
}

void PaintContext::prepare(const stroke::JournalEntry& entry) {
    work.autosave.prepare(*work.document, stroke::brush_of(entry), stroke::ink_of(entry));
    bool fresh = false;
    for (const std::string& name : stroke::inks_of(entry)) {
        work.autosave.prepare(*work.document, "", name);
        if (!name.starts_with('#') || std::ranges::find(own_inks, name, &ink::Ink::name) != own_inks.end()) continue;
        own_inks.push_back(work.document->materials().ink(name));
        fresh = true;
    }
    if (fresh) outbox.change([&](Update& update) { update.events.own_inks = own_inks; });
}

void PaintContext::take_presets(stroke::Document& document, const std::vector<stroke::JournalEntry>& entries) {
    stroke::Document& own = *work.document;
    document.use(own.materials().substrate());
    if (own.appearance().has_preview_substrate()) document.appearance().preview_substrate(own.appearance().substrate());
    for (const ink::Ink& ink : own_inks) document.use(ink);  // also those that no entry uses now
    for (const std::vector<stroke::JournalEntry>* of : {&own.journal().entries(), &entries})
        for (const stroke::JournalEntry& s : *of) {
            if (stroke::has_brush(stroke::kind_of(s))) document.use(own.materials().brush(stroke::brush_of(s)));
            if (const std::string& ink = stroke::ink_of(s); !ink.empty()) document.use(own.materials().ink(ink));
            for (const std::string& ink : stroke::inks_of(s)) document.use(own.materials().ink(ink));
        }
    for (const auto& [name, wanted] : own.appearance().recolours()) {
        document.use(own.materials().ink(name));
        document.appearance().recolour(name, wanted);
    }
}

void PaintContext::replace_document(std::unique_ptr<stroke::Document> document) {
    for (const stroke::LayerTexels& layer : work.document->layers().canvases())
        document->appearance().mark_changed(layer.canvas->touched_slots());
    work.document = std::move(document);
    publisher.forget_journal();
    publisher.publish(true);
}

}  // namespace tuft::app
