#include "io/strokes/svg_losses.h"

#include <fmt/format.h>

#include <algorithm>

namespace tuft::io {
namespace {

/// What is said of one and of several; "{}" is the count.
struct LossText {
    SvgLoss loss;
    const char *one, *several;
};

constexpr LossText kTexts[] = {
    {SvgLoss::text, "1 text is left out: turn text into paths first",
     "{} texts are left out: turn text into paths first"},
    {SvgLoss::image, "1 image is left out", "{} images are left out"},
    {SvgLoss::foreign, "1 foreignObject is left out", "{} foreignObjects are left out"},
    {SvgLoss::missing_use, "1 use draws nothing: the file has no element of the id that it names",
     "{} uses draw nothing: the file has no elements of the ids that they name"},
    {SvgLoss::outside_use, "1 use of another file is left out: put its element into this file",
     "{} uses of other files are left out: put their elements into this file"},
    {SvgLoss::missing_paint, "1 area or line has a paint that the file does not hold and is not painted",
     "{} areas or lines have a paint that the file does not hold and are not painted"},
    {SvgLoss::clip, "1 clip path is not applied: what it hides is painted",
     "{} clip paths are not applied: what they hide is painted"},
    {SvgLoss::mask, "1 mask is not applied: what it hides is painted",
     "{} masks are not applied: what they hide is painted"},
    {SvgLoss::filter, "1 filter is not applied", "{} filters are not applied"},
    {SvgLoss::gradient, "1 gradient is painted as one even ink", "{} gradients are painted as one even ink"},
    {SvgLoss::pattern, "1 pattern is painted as one even ink", "{} patterns are painted as one even ink"},
    {SvgLoss::dash, "1 dashed line is painted whole", "{} dashed lines are painted whole"},
    {SvgLoss::marker, "1 line loses its markers, such as arrow heads",
     "{} lines lose their markers, such as arrow heads"},
    {SvgLoss::opacity, "1 opacity is not applied: the ink is painted in full",
     "{} opacities are not applied: the ink is painted in full"},
    {SvgLoss::blend, "1 blend mode is not applied", "{} blend modes are not applied"},
    {SvgLoss::scaled_width, "1 line that shall keep its width (vector-effect) grows with its transform",
     "{} lines that shall keep their width (vector-effect) grow with their transforms"},
    {SvgLoss::white, "1 white area or line is left bare: white is the background, and what it covers stays painted",
     "{} white areas and lines are left bare: white is the background, and what they cover stays "
     "painted"},
    {SvgLoss::frame, "1 svg element within the drawing is drawn without a frame of its own",
     "{} svg elements within the drawing are drawn without frames of their own"},
    {SvgLoss::transform, "1 transform in a style is not applied: write it as an attribute",
     "{} transforms in styles are not applied: write them as attributes"},
    {SvgLoss::animation, "1 animation is not played", "{} animations are not played"},
    {SvgLoss::script, "1 script is not run", "{} scripts are not run"},
    {SvgLoss::rule, "1 rule of a style sheet is passed over: at-rules and most pseudo-classes are not understood",
     "{} rules of style sheets are passed over: at-rules and most pseudo-classes are not understood"},
};
static_assert(std::size(kTexts) == kSvgLosses);

bool is_black(const std::string& colour) {
    static constexpr const char* names[] = {"black",     "#000",       "#000000",     "#000f",
                                            "#000000ff", "rgb(0,0,0)", "currentcolor"};
    return std::find(std::begin(names), std::end(names), colour) != std::end(names);
}

}  // namespace

void SvgLosses::add_colour(const std::string& colour) {
    const std::string name = is_black(colour) ? "black" : colour;
    if (known_.insert(name).second) colours_.push_back(name);
}

std::vector<std::string> SvgLosses::lines() const {
    std::vector<std::string> out;
    for (const LossText& text : kTexts) {
        const std::size_t n = counts_[static_cast<std::size_t>(text.loss)];
        if (n == 1)
            out.emplace_back(text.one);
        else if (n > 1)
            out.push_back(fmt::format(fmt::runtime(text.several), n));
    }
    if (colours_.empty() || (colours_.size() == 1 && colours_.front() == "black")) return out;
    constexpr std::size_t kNamed = 6;
    const std::vector<std::string> named(
        colours_.begin(), colours_.begin() + static_cast<std::ptrdiff_t>(std::min(kNamed, colours_.size())));
    out.push_back(fmt::format("{} painted in one ink: {}{}",
                              colours_.size() == 1 ? "1 colour is" : fmt::format("{} colours are", colours_.size()),
                              fmt::join(named, ", "), colours_.size() > kNamed ? ", ..." : ""));
    return out;
}

}  // namespace tuft::io
