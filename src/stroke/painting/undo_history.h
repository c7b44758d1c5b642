#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "stroke/journal/entry/mask.h"
#include "stroke/journal/entry/parts.h"
#include "stroke/layers/layer_stack.h"
#include "stroke/painting/brushes_in_hand.h"

/// \file
/// What the last entries of a journal changed, as it was before, so that `Document::undo` need not paint anew.
namespace tuft::stroke {

/// Everything that one entry changed, as it was before.
struct UndoRecord {
    std::uint64_t entry = 0;            ///< id
    std::vector<LayerTiles> tiles;      ///< of layers, or of the palette
    std::optional<LayerBackup> layers;  ///< of a `LayerEdit`
    std::optional<MaskTable> masks;     ///< of a `MaskEdit`
    std::optional<PartTable> parts;     ///< of a `PartEdit`
    std::optional<BrushBackup> brush;   ///< of an entry with a brush in it
};

/// Records of the last entries, the oldest given up first once all take more than the budget. The last one is always
/// retained.
class UndoHistory {
  public:
    explicit UndoHistory(std::size_t budget_bytes) : budget_(budget_bytes) {}

    /// Adds the record of the entry done last. `n_pigments`: that the document has met with it.
    void add(UndoRecord record, std::size_t n_pigments);
    /// Takes the last record out; nothing where it is not of this entry. `n_pigments` is again what it was before.
    std::optional<UndoRecord> take(std::uint64_t entry);
    /// Forgets all records.
    void clear(std::size_t n_pigments);
    /// Pigments that the document had met after the last entry. Those that an entry met which failed or was taken back
    /// are forgotten: a replay meets the others in its own order.
    std::size_t n_pigments() const { return n_pigments_; }

  private:
    struct Sized {
        UndoRecord record;
        std::size_t n_pigments = 0;  ///< before the entry
        std::size_t bytes = 0;
    };
    std::size_t budget_, bytes_ = 0;
    std::size_t n_pigments_ = 0;
    std::deque<Sized> records_;
};

}  // namespace tuft::stroke
