#include "app/tools/tip_lag_cache.h"

#include <utility>

namespace tuft::app {

BrushTipLag TipLagCache::find(const brush::Preset& preset) {
    if (std::string content = brush::preset_toml(preset); measured_ != content) {
        measured_.clear();
        upright_ = tilted_.emplace(preset, stroke::shared_tip_lag_cache()).as_held();
        measured_ = std::move(content);
    }
    return {upright_, [this](double depth, const Vec2& lean, double turn) { return tilted_->at(depth, lean, turn); }};
}

}  // namespace tuft::app
