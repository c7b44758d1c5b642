#pragma once

#include "ink/canvas/canvas.h"

/// \file
/// One canvas laid on another: what merging two layers does to their texels.
namespace tuft::ink {

/// Adds all films of `upper` over those of `lower`, texel by texel, in their order. The open film of `lower` is
/// closed where `upper` has ink (drying.h), the dry films of `upper` follow, and the open films join. Soaked ink
/// joins soaked ink, and liquid joins liquid. The appearance does not change, with two exceptions: texels with more
/// than `kDryFilms` films, whose lowest are mixed (`close_films`), and soaked ink of `upper`.
///
/// Throws `Error` unless both canvases have the same pigments in the same planes and the same number of slots.
/// `upper` does not change.
void merge_films(Canvas& lower, const Canvas& upper);

}  // namespace tuft::ink
