#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"
#include "ink/canvas/canvas.h"
#include "ink/composite/blend.h"

/// User layers: films of their own that are painted, shown and changed apart from each other.
namespace tuft::stroke {

inline constexpr std::uint32_t kFirstLayer = 1;  ///< the layer that every painting begins with
/// In the place of a layer: entries that belong on the palette (palette.h). No layer has this id.
inline constexpr std::uint32_t kPaletteLayer = kNone - 1;
inline constexpr std::size_t kMaxLayers = 100;
inline constexpr std::size_t kMaxNameBytes = 200;

/// What is known of a layer besides its texels.
struct Layer {
    std::uint32_t id = kFirstLayer;  ///< unique in its painting, never used again
    std::string name = "Layer 1";    ///< unique among the layers that there are
    bool visible = true;
    double opacity = 1;                     ///< 0–1, see ink::shade_tile
    bool locked = false;                    ///< takes no strokes from the hand
    ink::Blend blend = ink::Blend::normal;  ///< how its films meet what lies below

    bool operator==(const Layer&) const = default;
};

/// The layers from the lowest to the highest. Only strokes and layer edits in their order
/// make it, so a replay gives the same.
struct LayerTable {
    std::vector<Layer> layers{Layer{}};
    std::uint32_t next_id = kFirstLayer + 1;

    const Layer* find(std::uint32_t id) const;
    const Layer* find(std::string_view name) const;
    bool operator==(const LayerTable&) const = default;
};

/// `duplicate`: a new layer with a copy of another's texels as they are then. `merge`: the texels of
/// a layer are laid on those of another (ink/texels/merge.h), and the layer ends.
enum class LayerChange { add, change, remove, duplicate, merge };

/// One change of the table: a new layer, another state or place of one, or its end.
struct LayerEdit {
    LayerChange what = LayerChange::add;
    Layer layer;              ///< as it is to be; `remove` and `merge` look at the id only.
                              ///< `add` and `duplicate` with id 0: the next one
    std::uint32_t place = 0;  ///< index from the bottom that it is to have
    std::uint32_t other = 0;  ///< `duplicate`: the layer copied; `merge`: the one merged into

    bool operator==(const LayerEdit&) const = default;
};

/// Carries the edit out. Throws `Error` and changes nothing where it cannot: no such layer, a
/// name that is empty or taken, the last layer, a number out of range.
void apply(LayerTable& table, const LayerEdit& edit);

/// Edits that make a table's layer something else; `id` must be there.
LayerEdit add_on_top(const LayerTable& table, const std::string& name);
LayerEdit changed(const LayerTable& table, const Layer& layer);
LayerEdit moved(const LayerTable& table, std::uint32_t id, std::uint32_t place);
LayerEdit removed(std::uint32_t id);
/// A copy right above the layer, looking the same but for its name.
LayerEdit duplicated(const LayerTable& table, std::uint32_t id, const std::string& name);
/// The layer laid on the one below it. Throws `Error` where that would look different: both must be
/// visible, unlocked, of opacity 1 and of the same blend, normal or glaze; and for the lowest layer.
LayerEdit merged_down(const LayerTable& table, std::uint32_t id);
/// `base`, or where a layer has that name the first of "base 2", "base 3", … that none has.
std::string free_name(const LayerTable& table, const std::string& base);

/// Throws `Error` for a name that is empty, too long or no readable text.
void check_name(std::string_view name, const char* of_what);

/// The texels of a layer.
struct LayerCanvas {
    std::uint32_t layer = kFirstLayer;
    ink::Canvas canvas;
};

/// The same, looked at.
struct LayerTexels {
    std::uint32_t layer = kFirstLayer;
    const ink::Canvas* canvas = nullptr;
};

/// Tiles of a layer as they were.
struct LayerTiles {
    std::uint32_t layer = kFirstLayer;
    std::vector<ink::TileSnapshot> tiles;
};

}  // namespace tuft::stroke
