#include "stroke/layers/materials.h"

#include <algorithm>

#include "ink/composite/match.h"
#include "stroke/drawing/plane_ink.h"

namespace tuft::stroke {

Materials::Brush& Materials::find_brush(const std::string& name) const {
    const auto found = brushes_.find(name);
    if (found != brushes_.end()) return found->second;
    return brushes_.emplace(name, Brush{brush::load_preset(name), {}}).first->second;
}

const ink::Ink& Materials::ink(const std::string& name) const {
    const auto found = inks_.find(name);
    if (found != inks_.end()) return found->second;
    if (!name.starts_with('#')) return inks_.emplace(name, ink::load_ink(name)).first->second;
    if (!searches_) searches_.emplace(ink::shipped_pigments(), substrate_);
    return inks_.emplace(name, ink::ink_named(name, substrate_, pigments_in_use(), &*searches_)).first->second;
}

void Materials::mix_together(const std::map<std::string, double>& weights) {
    std::vector<std::string> names;
    std::vector<ink::WeightedColour> colours;
    for (const auto& [name, weight] : weights) {
        const std::optional<ink::Rgb> colour = ink::colour_of_hex(name);
        if (!colour || inks_.contains(name)) continue;
        names.push_back(name);
        colours.push_back({*colour, weight});
    }
    if (colours.empty()) return;
    const std::vector<ink::Pigment> chosen =
        ink::choose_pigments(colours, ink::shipped_pigments(), pigments_in_use(), substrate_);
    ink::MixSearches searches(chosen, substrate_);
    for (std::size_t i = 0; i < names.size(); ++i) {
        ink::Ink ink = searches.nearest(colours[i].colour).ink;
        ink.name = names[i];
        use(ink);
    }
}

void Materials::forget_inks(const std::vector<std::string>& names) {
    for (const std::string& name : names) inks_.erase(name);
}

// Of the layers, and of inks that were asked for and may come onto them.
std::vector<ink::Pigment> Materials::pigments_in_use() const {
    std::vector<ink::Pigment> all(layers_.pigments().begin(), layers_.pigments().end());
    for (const auto& [name, ink] : inks_)
        for (const ink::InkPart& part : ink.parts)
            if (std::none_of(all.begin(), all.end(),
                             [&](const ink::Pigment& p) { return p.name == part.pigment.name; }))
                all.push_back(part.pigment);
    return all;
}

HolderOptions Materials::holder(const std::string& name, const mesh::TriangleMesh& mesh,
                                bool compensate_tip_lag) const {
    Brush& brush = find_brush(name);
    HolderOptions options = holder_options(brush.preset, mesh);
    if (!compensate_tip_lag) return options;
    if (!brush.tip_lag) brush.tip_lag = std::make_unique<TiltedTipLag>(brush.preset, tip_lags_);
    options.tip_lag = brush.tip_lag->as_held();
    options.tip_lag_change = [tilted = brush.tip_lag.get()](double depth, const Vec2& lean, double turn) {
        return tilted->at(depth, lean, turn);
    };
    options.dot_place = [preset = brush.preset, plain = options](const StrokeSamples& dot) {
        return middle_of_dot(dot, preset, plain);
    };
    return options;
}

}  // namespace tuft::stroke
