#include "app/state/layer_state.h"

#include <algorithm>

namespace tuft::app {

void add_layer(LayerState& layers, PaintThread& work, const stroke::LayerTable& table, const std::string& name) {
    work.post(ChangeLayers{stroke::add_on_top(table, name)});
    if (layers.active != kNewestLayer) layers.active_before.push_back(layers.active);
    layers.active = kNewestLayer;
}

// A layer just added is painted on, and so is one that an undo brings back after it was removed from under the hand.
// Without the one painted on: the one before it was added, where that is undone, else its neighbour below.
void follow_layers(LayerState& s, const stroke::LayerTable& now, const stroke::LayerTable& before, bool outside,
                   bool idle) {
    const std::uint32_t active = s.active, newest = now.next_id - 1;
    if (s.last_next_id == 0)
        s.active = now.layers.back().id;
    else if (now.next_id > s.last_next_id && !outside && now.find(newest)) {
        if (s.active != kNewestLayer) s.active_before.push_back(s.active);
        s.active = newest;
    } else if (s.active == kNewestLayer) {
        if (!idle) return;                  // still to come
        s.active = s.active_before.back();  // it could not be added
        s.active_before.pop_back();
    } else if (s.removed != 0 && now.find(s.removed)) {
        s.active = s.removed;
    }
    if (!now.find(s.active)) {
        const std::vector<stroke::Layer>& was = before.layers;
        const auto place =
            std::find_if(was.begin(), was.end(), [&](const stroke::Layer& l) { return l.id == s.active; }) -
            was.begin();
        s.removed = s.active;
        s.active = now.layers[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(
                                  place - 1, 0, static_cast<std::ptrdiff_t>(now.layers.size()) - 1))]
                       .id;
        for (; now.next_id < s.last_next_id && !s.active_before.empty(); s.active_before.pop_back())
            if (now.find(s.active_before.back())) {
                s.active = s.active_before.back();
                s.active_before.pop_back();
                break;
            }
    } else if (now.find(s.removed)) {
        s.removed = 0;
    }
    s.last_next_id = now.next_id;
    if (s.active != active) s.opacity = -1;
}

}  // namespace tuft::app
