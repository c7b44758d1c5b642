#pragma once

#include <map>
#include <set>

#include "app/document/thumbnails.h"

/// \file
/// What the list of layers shows besides the layers themselves; part of the session.
namespace tuft::app {

struct LayerList {
    std::uint32_t renamed = 0;  ///< layer whose name is being typed; 0: none
    bool focus = false;         ///< the field for it has just appeared
    std::map<std::uint32_t, Thumbnail> pictures;
    std::map<std::uint32_t, unsigned> textures;  ///< OpenGL names
    std::set<std::uint32_t> fresh;               ///< pictures that the graphics card has not got yet
};

}  // namespace tuft::app
