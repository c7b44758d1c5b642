#pragma once

#include "ink/canvas/canvas.h"

/// \file
/// One canvas laid on another: what merging two layers does to their texels.
namespace tuft::ink {

/// Lays all films of `upper` over those of `lower`, texel by texel, in their order: the open film
/// of `lower` is closed where `upper` has ink (drying.h), the dry films of `upper` follow, and its
/// open film is the open one of both. What is soaked in joins what is soaked in, liquid joins
/// liquid. The look stays the same, but for texels with more than `kDryFilms` films, whose lowest
/// are mixed
/// (`close_films`), and for ink of `upper` that had soaked in.
///
/// Both canvases need the same pigments in the same planes and as many slots; throws `Error`
/// otherwise. `upper` is left as it is.
void lay_films(Canvas& lower, const Canvas& upper);

}  // namespace tuft::ink
