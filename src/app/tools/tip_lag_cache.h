#pragma once

#include <optional>
#include <string>
#include <vector>

#include "app/input/pointer_input.h"
#include "stroke/placement/tip_lag.h"

namespace tuft::app {

/// The tip lag of the brush in hand; measured anew where it is another one.
class TipLagCache {
  public:
    /// What is returned may be used as long as this lives and no other brush is asked for.
    TipLag find(const std::string& brush, const brush::Preset& preset);

  private:
    std::vector<stroke::TipLag> upright_;
    std::optional<stroke::TiltedTipLag> tilted_;
    std::string brush_;
};

}  // namespace tuft::app
