#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "app/work/edit_history.h"
#include "app/work/outbox.h"
#include "app/work/paint_work.h"
#include "app/work/publisher.h"

namespace tuft::app {

/// What commands work on, all of it on the paint thread.
struct PaintContext {
    PaintContext(PaintWork open, Outbox& window);

    PaintWork work;
    EditHistory history;
    Outbox& outbox;
    Publisher publisher;
    std::vector<ink::Ink> own_inks;  ///< of this work, beside the shipped ones
    std::atomic<bool> stop{false};   ///< long work ends; what was before stays

    /// Shows long work under a name, until it is done or stopped.
    ProgressFn progress(const std::string& name);
    /// The layer itself where `kNewestLayer` stands for it.
    std::uint32_t layer_of(std::uint32_t requested) const;
    /// Gives a document the material and appearance of the work, and the presets that its entries and these use.
    void take_presets(stroke::Document& document, const std::vector<stroke::JournalEntry>& entries);
    /// The same model with other strokes on it takes the place of the document.
    void replace_document(std::unique_ptr<stroke::Document> document);
};

}  // namespace tuft::app
