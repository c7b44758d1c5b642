#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/geometry/types.h"
#include "core/message.h"
#include "ink/canvas/canvas.h"
#include "ink/composite/blend.h"

/// \file
/// User layers: films that are painted, shown and changed apart from each other. `LayerStack` holds a document's
/// layers; the studio and `tuft layer` make edits.
namespace tuft::stroke {

inline constexpr std::uint32_t kFirstLayer = 1;  ///< id of the layer of a new document
/// In the place of an id: the palette (layers/palette.h). No layer has this id.
inline constexpr std::uint32_t kPaletteLayer = kNone - 1;
inline constexpr std::size_t kMaxLayers = 100;
inline constexpr std::size_t kMaxNameBytes = 200;  ///< of names of layers, masks and groups

/// A layer without its texels.
struct Layer {
    std::uint32_t id = kFirstLayer;  ///< unique in its document, never reused
    std::string name = "Layer 1";    ///< unique among the layers of the table
    bool visible = true;
    double opacity = 1;                     ///< 0–1 (`ink::shade_tile`)
    bool locked = false;                    ///< rejects new strokes and fills; a replay ignores it
    ink::Blend blend = ink::Blend::normal;  ///< how its films combine with the layers below

    bool operator==(const Layer&) const = default;
};

/// The layers, the lowest first. Made by the `LayerEdit`s of a journal alone.
struct LayerTable {
    std::vector<Layer> layers{Layer{}};
    std::uint32_t next_id = kFirstLayer + 1;

    const Layer* find(std::uint32_t id) const;
    const Layer* find(std::string_view name) const;
    bool operator==(const LayerTable&) const = default;
};

/// What an edit does to the table of layers.
enum class LayerChange {
    add,        ///< a new empty layer
    change,     ///< another name, state or place of a layer
    remove,     ///< its end, with its texels
    duplicate,  ///< a new layer with a copy of another one's texels
    merge,      ///< its texels are added over those of another layer (ink/texels/merge.h), and it ends
};

/// One change of the table.
struct LayerEdit {
    LayerChange what = LayerChange::add;
    Layer layer;              ///< its new state; `remove` and `merge` read the id only. Id 0 with `add` and
                              ///< `duplicate`: the next free one
    std::uint32_t place = 0;  ///< its new index, 0 the lowest
    std::uint32_t other = 0;  ///< `duplicate`: id of the layer copied; `merge`: id of the layer merged into

    bool operator==(const LayerEdit&) const = default;
};

/// Returns a layer's name for a message. Names that the document and the studio give, "Layer N" and "NAME copy N", are
/// words, which are translated; others are as the person wrote them. Its English is the name.
Message title_of(const Layer& layer);

/// Carries the edit out. Throws `Error` and changes nothing for an unknown layer, a name that is empty or taken, the
/// removal of the last layer, and numbers out of range.
void apply(LayerTable& table, const LayerEdit& edit);

/// Return edits of a table. Precondition: it has the layer.
LayerEdit add_on_top(const LayerTable& table, const std::string& name);
LayerEdit changed(const LayerTable& table, const Layer& layer);
LayerEdit moved(const LayerTable& table, std::uint32_t id, std::uint32_t place);
LayerEdit removed(std::uint32_t id);
/// Returns a copy right above the layer, with the same state and another name.
LayerEdit duplicated(const LayerTable& table, std::uint32_t id, const std::string& name);
/// Returns a merge with the layer below. Throws `Error` for the lowest layer, and where the appearance would change:
/// both must be visible, unlocked, of opacity 1 and of the same blend, normal or glaze.
LayerEdit merged_down(const LayerTable& table, std::uint32_t id);
/// Returns `base`, or where a layer has that name the first of "base 2", "base 3", … that is free.
std::string free_name(const LayerTable& table, const std::string& base);

/// Throws `Error` for a name that is empty, longer than `kMaxNameBytes` or no readable text.
void check_name(std::string_view name, const char* of_what);

/// Names of a layer and a mask in a stroke file; empty: none named.
struct PlaceNames {
    std::string layer, mask;

    bool operator==(const PlaceNames&) const = default;
};

/// The texels of a layer, or of the palette.
struct LayerCanvas {
    std::uint32_t layer = kFirstLayer;
    ink::Canvas canvas;
};

/// The same, not owned.
struct LayerTexels {
    std::uint32_t layer = kFirstLayer;
    const ink::Canvas* canvas = nullptr;
};

/// Former contents of tiles of a layer, or of the palette.
struct LayerTiles {
    std::uint32_t layer = kFirstLayer;
    std::vector<ink::TileSnapshot> tiles;
};

}  // namespace tuft::stroke
