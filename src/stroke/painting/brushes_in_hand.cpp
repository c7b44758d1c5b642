#include "stroke/painting/brushes_in_hand.h"

#include <utility>

namespace tuft::stroke {

const BrushInHand* BrushesInHand::find(const std::string& name) const {
    const auto found = held_.find(name);
    return found == held_.end() ? nullptr : &found->second;
}

BrushInHand BrushesInHand::take_up(const BrushStart& start) const {
    const BrushInHand* last = start.dip == DipMode::persistent ? find(start.name) : nullptr;
    if (last && last->tuft.preset.spine == start.preset.spine) return *last;
    BrushInHand fresh{brush::make_tuft(start.preset, start.seed), {}, start.ink, start.ink};
    fresh.reservoir = empty_reservoir(fresh.tuft);
    ink::dip(fresh.reservoir, start.mix);
    return fresh;
}

BrushInHand BrushesInHand::take_up_for_stroke(const BrushStart& start) const {
    BrushInHand brush = take_up(start);
    if (start.ink != brush.named && start.ink != brush.dipped) {
        ink::rinse(brush.reservoir);
        brush::reset(brush.tuft);
        ink::dip(brush.reservoir, start.mix);
        brush.dipped = start.ink;
    }
    brush.named = start.ink;
    return brush;
}

BrushBackup BrushesInHand::put_down(const std::string& name, BrushInHand brush) {
    BrushBackup before{.name = name, .brush = {}};
    if (const auto found = held_.find(name); found != held_.end()) before.brush = std::move(found->second);
    held_.insert_or_assign(name, std::move(brush));
    return before;
}

void BrushesInHand::restore(BrushBackup before) {
    if (before.brush)
        held_.insert_or_assign(before.name, std::move(*before.brush));
    else
        held_.erase(before.name);
}

BrushInHand clean_brush(const brush::Preset& preset) {
    BrushInHand clean{brush::make_tuft(preset), {}, {}, {}};
    clean.reservoir = empty_reservoir(clean.tuft);
    ink::dip(clean.reservoir, ink::Mix{});
    return clean;
}

}  // namespace tuft::stroke
