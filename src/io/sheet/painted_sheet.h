#pragma once

#include "decal/sheet.h"
#include "ink/spectra/colour_space.h"
#include "stroke/document/document.h"

/// \file
/// Decal sheets of a document. Called by `tuft decals` and by the studio; sheet_files.h writes the result.
namespace tuft::io {

/// What `tuft decals` and the studio ask of a sheet.
struct SheetRequest {
    /// Id of the mask whose areas are cut out, painted or not, never as `SheetOptions::outlines`; 0: all that is
    /// painted.
    std::uint32_t mask = 0;
    bool plates = false;  ///< one plate for each pigment instead of colours
    ink::ColourSpace space = ink::ColourSpace::srgb;
    decal::SheetOptions sheet;  ///< without `prints` the result suits .dxf
};

/// Returns the sheet of what a document shows. Throws `Error` where nothing is painted or a piece fits no page, and
/// `Cancelled`. The same bits for any number of threads.
decal::Sheet make_painted_sheet(const stroke::Document& painting, const SheetRequest& request);

}  // namespace tuft::io
