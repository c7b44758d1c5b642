#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/input/pointer.h"
#include "stroke/placement/tip_lag.h"

/// \file
/// Measured tip lag of the chosen brush. Window thread.
namespace tuft::app {

/// Caches the tip lag of one brush.
class TipLagCache {
  public:
    /// Returns the tip lag of a brush; measures it when any value of its preset changed: a file may be written anew
    /// under its name. The result refers to this cache and is valid until another brush is requested.
    BrushTipLag find(const brush::Preset& preset);

  private:
    std::vector<stroke::TipLag> upright_;
    std::optional<stroke::TiltedTipLag> tilted_;
    std::string measured_;  ///< the preset that it is of, as TOML
};

}  // namespace tuft::app
