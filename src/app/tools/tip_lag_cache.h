#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/input/pointer_input.h"
#include "stroke/placement/tip_lag.h"

/// \file
/// Measured tip lag of the chosen brush. Window thread.
namespace tuft::app {

/// Caches the tip lag of one brush.
class TipLagCache {
  public:
    /// Returns the tip lag of a brush; measures it when the brush changed. The result refers to this cache and is valid
    /// until another brush is requested.
    TipLag find(const std::string& brush, const brush::Preset& preset);

  private:
    std::vector<stroke::TipLag> upright_;
    std::optional<stroke::TiltedTipLag> tilted_;
    std::string brush_;
};

}  // namespace tuft::app
