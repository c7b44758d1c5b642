#include "stroke/painting/undo_history.h"

#include <utility>

namespace tuft::stroke {
namespace {

std::size_t bytes_of(const LayerTiles& tiles) {
    std::size_t bytes = 0;
    for (const ink::TileSnapshot& tile : tiles.tiles)
        bytes += sizeof(ink::TileSnapshot) + tile.amounts.size() * sizeof(float);
    return bytes;
}

std::size_t bytes_of(const UndoRecord& record) {
    std::size_t bytes = 0;
    for (const LayerTiles& tiles : record.tiles) bytes += bytes_of(tiles);
    if (record.layers && record.layers->merged) bytes += bytes_of(*record.layers->merged);
    if (record.layers && record.layers->canvas) bytes += record.layers->canvas->canvas.memory_bytes();
    if (record.brush && record.brush->brush) bytes += sizeof(BrushInHand);
    return bytes;
}

}  // namespace

void UndoHistory::add(UndoRecord record, std::size_t n_pigments) {
    const std::size_t bytes = bytes_of(record);
    bytes_ += bytes;
    records_.push_back({std::move(record), std::exchange(n_pigments_, n_pigments), bytes});
    while (bytes_ > budget_ && records_.size() > 1) {
        bytes_ -= records_.front().bytes;
        records_.pop_front();
    }
}

std::optional<UndoRecord> UndoHistory::take(std::uint64_t entry) {
    if (records_.empty() || records_.back().record.entry != entry) return std::nullopt;
    Sized last = std::move(records_.back());
    records_.pop_back();
    bytes_ -= last.bytes;
    n_pigments_ = last.n_pigments;
    return std::move(last.record);
}

void UndoHistory::clear(std::size_t n_pigments) {
    records_.clear();
    bytes_ = 0;
    n_pigments_ = n_pigments;
}

}  // namespace tuft::stroke
