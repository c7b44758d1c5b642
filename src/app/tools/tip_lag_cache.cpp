#include "app/tools/tip_lag_cache.h"

namespace tuft::app {

TipLag TipLagCache::find(const std::string& brush, const brush::Preset& preset) {
    if (brush_ != brush) {
        upright_ = stroke::measure_tip_lag(preset);
        tilted_.emplace(preset);
        brush_ = brush;
    }
    return {upright_, [this](double depth, const Vec2& lean) { return tilted_->at(depth, lean); }};
}

}  // namespace tuft::app
