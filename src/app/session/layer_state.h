#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/paint/paint_thread.h"

namespace tuft::app {

/// What the list of layers shows besides the layers themselves.
struct LayerList {
    std::uint32_t renamed = 0;  ///< layer whose name is being typed; 0: none
    bool focus = false;         ///< the field for it has just appeared
    std::map<std::uint32_t, Thumbnail> pictures;
    std::map<std::uint32_t, unsigned> textures;  ///< OpenGL names
    std::set<std::uint32_t> fresh;               ///< pictures that the graphics card has not got yet
    std::optional<render::GlCamera> seen_from;   ///< by the pictures
};

struct LayerState {
    std::uint32_t active = stroke::kFirstLayer;  ///< painted on; `kNewestLayer` until one that was requested exists
    std::vector<std::uint32_t> active_before;    ///< painted on before one was added, the newest at the back
    std::uint32_t removed = 0;                   ///< painted on when it was removed; 0: none
    std::uint32_t last_next_id = 0;              ///< `LayerTable::next_id` at the last look; 0: none yet
    double opacity = -1;                         ///< while its slider is dragged; below 0: it is not
    bool show_details = false;
    LayerList list;
};

/// Adds a layer on top, which is painted on from now on.
void add_layer(LayerState& layers, PaintThread& work, const stroke::LayerTable& table, const std::string& name);
/// Chooses the layer to paint on when the table changed from `before` to `now`. `outside`: another program had a part
/// in it; `idle`: the paint thread has nothing left to do.
void follow_layers(LayerState& layers, const stroke::LayerTable& now, const stroke::LayerTable& before, bool outside,
                   bool idle);

}  // namespace tuft::app
