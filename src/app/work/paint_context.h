#pragma once

#include <atomic>
#include <memory>
#include <string>
#include <vector>

#include "app/work/edit_history.h"
#include "app/work/outbox.h"
#include "app/work/paint_work.h"
#include "app/work/publisher.h"

/// \file
/// State shared by the commands.
namespace tuft::app {

/// State of the paint thread. Only `stop` may be set from another thread.
struct PaintContext {
    PaintContext(PaintWork open, Outbox& window);

    PaintWork work;
    EditHistory history;
    Outbox& outbox;
    Publisher publisher;
    std::vector<ink::Ink> own_inks;  ///< of this project, besides the shipped ones
    std::atomic<bool> stop{false};   ///< cancels long work; the state before it stays

    /// Returns a callback that shows the progress of long work and cancels it on `stop`.
    ProgressFn progress(const std::string& name);
    /// Returns the layer; for `kNewestLayer` the one added last.
    std::uint32_t layer_of(std::uint32_t requested) const;
    /// Stores brush and inks of an entry that is painted next (`Autosave::prepare`). Inks that only it has become the
    /// project's own.
    void prepare(const stroke::JournalEntry& entry);
    /// Gives a document the substrate and recolouring of the work, and the presets of its entries and of `entries`.
    void take_presets(stroke::Document& document, const std::vector<stroke::JournalEntry>& entries);
    /// Replaces the document by one of the same model.
    void replace_document(std::unique_ptr<stroke::Document> document);
};

}  // namespace tuft::app
