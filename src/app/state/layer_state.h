#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "app/paint/paint_thread.h"

/// \file
/// The active layer and the list of layers. Window thread.
namespace tuft::app {

/// State of the list of layers.
struct LayerList {
    std::uint32_t renamed = 0;  ///< layer whose name is being edited; 0: none
    bool focus = false;         ///< its text field has just appeared
    std::map<std::uint32_t, Thumbnail> pictures;
    std::map<std::uint32_t, unsigned> textures;  ///< OpenGL names
    std::set<std::uint32_t> fresh;               ///< layers whose picture is not uploaded yet
    std::optional<render::GlCamera> seen_from;   ///< view of the pictures
};

/// The active layer and settings of the layers section.
struct LayerState {
    std::uint32_t active = stroke::kFirstLayer;  ///< painted on; `kNewestLayer` until a requested layer exists
    std::vector<std::uint32_t> active_before;    ///< active layers before layers were added, newest last
    std::uint32_t removed = 0;                   ///< removed while active; 0: none
    std::uint32_t last_next_id = 0;              ///< `LayerTable::next_id` at the last update; 0: none yet
    double opacity = -1;                         ///< while its slider is dragged; negative: it is not
    bool show_details = false;
    LayerList list;
};

/// Adds a layer on top and makes it active.
void add_layer(LayerState& layers, PaintThread& work, const stroke::LayerTable& table, const std::string& name);
/// Updates the active layer after the table changed from `before` to `now`. `outside`: another program contributed to
/// the change. `idle`: the paint thread has no command left.
void follow_layers(LayerState& layers, const stroke::LayerTable& now, const stroke::LayerTable& before, bool outside,
                   bool idle);

}  // namespace tuft::app
