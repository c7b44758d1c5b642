#pragma once

#include <cstdint>
#include <vector>

#include "brush/preset/preset.h"
#include "core/files/disk_cache.h"
#include "core/system/progress.h"

/// \file
/// A small picture of a stroke of a brush, by which a painter knows it. Called by the studio's list of brushes.
namespace tuft::pictures {

/// A picture of a stroke in carbon ink on rice paper.
struct TriedStroke {
    static constexpr int kWidth = 320, kHeight = 80;  ///< pixels; one is a texel
    std::vector<std::uint8_t> rgb;                    ///< [3 kWidth kHeight] sRGB, row 0 at the top
};

/// Returns the height of the sheet on which a brush is tried, metres: 1.9 widths of its line, and at least 0.45 times
/// its hair. So a liner is seen to draw finer lines than a wash brush of the same size.
double tried_height(const brush::Preset& preset);

/// Paints a stroke of a full brush on a sheet in proportion to it, through `stroke::Document`: pressed, travelled in a
/// wave, turned, lifted. A broad side goes across the path, then along it, then across again. Foam is dabbed three
/// times, each time lighter. The same preset gives the same bits. Throws `Cancelled` where `progress` returns false.
/// `tip_lags`: cache of measured tip lags. Cost: 0.1 s for a round brush, 1 s for a flat, 8 s for the widest hake.
TriedStroke paint_tried_stroke(const brush::Preset& preset, const ProgressFn& progress = {},
                               const DiskCache& tip_lags = {});

}  // namespace tuft::pictures
