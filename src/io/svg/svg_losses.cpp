#include "io/svg/svg_losses.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/text/text.h"

namespace tuft::io {
namespace {

/// What is said of so many of a kind.
Message loss_text(SvgLoss loss, std::size_t n) {
    const auto say = [n](const char* one, const char* several) { return n == 1 ? Message(one) : Message(several, n); };
    switch (loss) {
        case SvgLoss::text:
            return say("1 character is left out: no installed font has it",
                       "{} characters are left out: no installed font has them");
        case SvgLoss::text_end:
            return say("1 character is left out: its path is too short",
                       "{} characters are left out: their path is too short");
        case SvgLoss::image:
            return say("1 image is left out: lines of a brush do not paint it",
                       "{} images are left out: lines of a brush do not paint them");
        case SvgLoss::damaged_path:
            return say("1 path is damaged: it is drawn up to its fault",
                       "{} paths are damaged: they are drawn up to their faults");
        case SvgLoss::foreign:
            return say("1 foreignObject is left out", "{} foreignObjects are left out");
        case SvgLoss::missing_use:
            return say("1 use draws nothing: the file has no element of the id that it names",
                       "{} uses draw nothing: the file has no elements of the ids that they name");
        case SvgLoss::outside_use:
            return say("1 use of another file is left out: put its element into this file",
                       "{} uses of other files are left out: put their elements into this file");
        case SvgLoss::missing_paint:
            return say("1 area or line has a paint that the file does not hold and is not painted",
                       "{} areas or lines have a paint that the file does not hold and are not painted");
        case SvgLoss::clip:
            return say("1 clip path is not applied: what it hides is painted",
                       "{} clip paths are not applied: what they hide is painted");
        case SvgLoss::mask:
            return say("1 mask is not applied: what it hides is painted",
                       "{} masks are not applied: what they hide is painted");
        case SvgLoss::filter:
            return say("1 filter is not applied", "{} filters are not applied");
        case SvgLoss::gradient:
            return say("1 gradient is painted as one even ink", "{} gradients are painted as one even ink");
        case SvgLoss::pattern:
            return say("1 pattern is painted as one even ink", "{} patterns are painted as one even ink");
        case SvgLoss::marker:
            return say("1 line loses its markers, such as arrow heads",
                       "{} lines lose their markers, such as arrow heads");
        case SvgLoss::opacity:
            return say("1 opacity is not applied: the ink is painted in full",
                       "{} opacities are not applied: the ink is painted in full");
        case SvgLoss::overlap:
            return say("1 shape shows through another of its translucent group, which would hide it",
                       "{} shapes show through others of their translucent groups, which would hide them");
        case SvgLoss::blend:
            return say("1 blend mode is not applied", "{} blend modes are not applied");
        case SvgLoss::white:
            return say(
                "1 white area or line is left bare: white is the background, and what it covers stays painted",
                "{} white areas and lines are left bare: white is the background, and what they cover stays painted");
        case SvgLoss::frame:
            return say("1 svg element within the drawing is drawn without a frame of its own",
                       "{} svg elements within the drawing are drawn without frames of their own");
        case SvgLoss::transform:
            return say("1 transform in a style is not applied: write it as an attribute",
                       "{} transforms in styles are not applied: write them as attributes");
        case SvgLoss::animation:
            return say("1 animation is not played", "{} animations are not played");
        case SvgLoss::script:
            return say("1 script is not run", "{} scripts are not run");
        case SvgLoss::rule:
            return say("1 rule of a style sheet is passed over: at-rules and most pseudo-classes are not understood",
                       "{} rules of style sheets are passed over: at-rules and most pseudo-classes are not understood");
    }
    return {};
}

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

void SvgLosses::add_font(const std::string& missing, const std::string& used) {
    const std::pair pair(missing, used);
    if (std::find(fonts_.begin(), fonts_.end(), pair) == fonts_.end()) fonts_.push_back(pair);
}

std::vector<Message> SvgLosses::lines() const {
    std::vector<Message> out;
    for (std::size_t i = 0; i < kSvgLosses; ++i)
        if (counts_[i] > 0) out.push_back(loss_text(static_cast<SvgLoss>(i), counts_[i]));
    for (const Message& why : images_) out.push_back(Message("an image is left out: {}", why));
    for (const auto& [missing, used] : fonts_)
        out.push_back(Message("the font '{}' is not installed: its text is set in '{}'", excerpt(missing), used));
    if (colours_.empty() || (colours_.size() == 1 && colours_.front() == "black")) return out;
    constexpr std::size_t kNamed = 6;
    const std::vector<std::string> named(
        colours_.begin(), colours_.begin() + static_cast<std::ptrdiff_t>(std::min(kNamed, colours_.size())));
    const std::string names = fmt::format("{}{}", fmt::join(named, ", "), colours_.size() > kNamed ? ", ..." : "");
    out.push_back(colours_.size() == 1 ? Message("1 colour is painted in one ink: {}", names)
                                       : Message("{} colours are painted in one ink: {}", colours_.size(), names));
    return out;
}

}  // namespace tuft::io
