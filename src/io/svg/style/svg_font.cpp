#include "io/svg/style/svg_font.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string_view>
#include <utility>

#include "core/text/lower_case.h"
#include "io/svg/style/svg_css.h"

namespace tuft::io {
namespace {

constexpr double kMostSize = 1e6;  // user units
constexpr std::array kNames{"font",
                            "font-family",
                            "font-size",
                            "font-weight",
                            "font-style",
                            "font-stretch",
                            "letter-spacing",
                            "word-spacing",
                            "text-anchor",
                            "dominant-baseline",
                            "alignment-baseline",
                            "baseline-shift",
                            "text-decoration",
                            "text-decoration-line",
                            "writing-mode",
                            "xml:space",
                            "white-space"};

std::string lower(std::string_view text) {
    return lower_case(std::string(stripped(text)));
}

/// A length in user units; em and per cent are of `em`. Nothing for any other text.
std::optional<double> length_of(std::string_view given, double em) {
    const std::string text = lower(given);
    double value = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc() || !std::isfinite(value)) return std::nullopt;
    static constexpr std::pair<std::string_view, double> units[] = {
        {"", 1}, {"px", 1}, {"pt", 96.0 / 72}, {"pc", 16}, {"mm", 96 / 25.4}, {"cm", 96 / 2.54}, {"in", 96}};
    const std::string_view unit(end, text.data() + text.size());
    if (unit == "em" || unit == "rem") return value * em;
    if (unit == "ex" || unit == "ch") return value * em / 2;
    if (unit == "%") return value / 100 * em;
    for (const auto& [name, factor] : units)
        if (unit == name) return value * factor;
    return std::nullopt;
}

std::optional<double> size_of(std::string_view given, double parent) {
    static constexpr std::pair<std::string_view, double> words[] = {{"xx-small", 9}, {"x-small", 10}, {"small", 13},
                                                                    {"medium", 16},  {"large", 18},   {"x-large", 24},
                                                                    {"xx-large", 32}};
    const std::string text = lower(given);
    for (const auto& [name, size] : words)
        if (text == name) return size;
    if (text == "larger") return 1.2 * parent;
    if (text == "smaller") return parent / 1.2;
    const std::optional<double> size = length_of(text, parent);
    return size && *size >= 0 && *size <= kMostSize ? size : std::nullopt;
}

bool set_weight(FontRequest& face, const std::string& text) {
    if (text == "normal") return face.weight = 400, true;
    if (text == "bold") return face.weight = 700, true;
    if (text == "bolder") return face.weight = face.weight < 350 ? 400 : face.weight < 550 ? 700 : 900, true;
    if (text == "lighter") return face.weight = face.weight < 550 ? 100 : face.weight < 750 ? 400 : 700, true;
    int weight = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), weight);
    if (fault != std::errc() || *end != '\0' || weight < 1 || weight > 1000) return false;
    return face.weight = weight, true;
}

bool set_stretch(FontRequest& face, const std::string& text) {
    static constexpr std::pair<std::string_view, int> words[] = {
        {"ultra-condensed", 50}, {"extra-condensed", 63}, {"condensed", 75},
        {"semi-condensed", 87},  {"normal", 100},         {"semi-expanded", 113},
        {"expanded", 125},       {"extra-expanded", 150}, {"ultra-expanded", 200}};
    for (const auto& [name, width] : words)
        if (text == name) return face.width = width, true;
    return false;
}

std::vector<std::string> families_of(std::string_view list) {
    std::vector<std::string> families;
    while (!list.empty() && families.size() < 32) {
        const std::size_t comma = std::min(list.find(','), list.size());
        std::string_view name = stripped(list.substr(0, comma));
        if (name.size() >= 2 && (name.front() == '\'' || name.front() == '"') && name.back() == name.front())
            name = stripped(name.substr(1, name.size() - 2));
        if (name.starts_with('-')) name = {};  // what an editor keeps for itself, such as -inkscape-font
        if (!name.empty()) families.emplace_back(name);
        list.remove_prefix(std::min(comma + 1, list.size()));
    }
    return families;
}

// font: [style | variant | weight | stretch]* size[/line-height] families
void set_shorthand(SvgFont& font, std::string_view text) {
    SvgFont made = font;
    made.face = {.families = font.face.families};
    while (!text.empty()) {
        const std::size_t blank = std::min(text.find_first_of(" \t\n\r"), text.size());
        const std::string word = lower(text.substr(0, blank));
        text = stripped(text.substr(blank));
        if (word == "italic" || word == "oblique") {
            made.face.italic = true;
        } else if (const auto size = size_of(word.substr(0, word.find('/')), font.size);
                   size && !set_weight(made.face, word)) {
            const std::vector<std::string> families = families_of(text);
            if (families.empty()) return;
            made.size = *size;
            made.face.families = families;
            font = made;
            return;
        } else {
            set_stretch(made.face, word) || set_weight(made.face, word);
        }
    }
}

std::optional<SvgBaseline> baseline_of(const std::string& text) {
    static constexpr std::pair<std::string_view, SvgBaseline> words[] = {
        {"auto", SvgBaseline::alphabetic},           {"alphabetic", SvgBaseline::alphabetic},
        {"baseline", SvgBaseline::alphabetic},       {"middle", SvgBaseline::middle},
        {"central", SvgBaseline::central},           {"hanging", SvgBaseline::hanging},
        {"text-before-edge", SvgBaseline::text_top}, {"before-edge", SvgBaseline::text_top},
        {"text-top", SvgBaseline::text_top},         {"text-after-edge", SvgBaseline::text_bottom},
        {"after-edge", SvgBaseline::text_bottom},    {"text-bottom", SvgBaseline::text_bottom},
        {"ideographic", SvgBaseline::text_bottom},   {"mathematical", SvgBaseline::mathematical}};
    for (const auto& [name, baseline] : words)
        if (text == name) return baseline;
    return std::nullopt;
}

}  // namespace

bool states_font(const SvgProperty& own) {
    return std::any_of(kNames.begin(), kNames.end(), [&](const char* name) { return !own(name).empty(); });
}

void inherit_font(SvgFont& font, const SvgProperty& own) {
    const double parent_size = font.size;
    if (const std::string text = own("font"); !text.empty()) set_shorthand(font, stripped(text));
    if (std::vector<std::string> families = families_of(own("font-family")); !families.empty())
        font.face.families = std::move(families);
    if (const std::string text = own("font-size"); !text.empty())
        font.size = size_of(text, parent_size).value_or(font.size);
    if (const std::string text = lower(own("font-weight")); !text.empty()) set_weight(font.face, text);
    if (const std::string text = lower(own("font-style")); !text.empty()) font.face.italic = text != "normal";
    if (const std::string text = lower(own("font-stretch")); !text.empty()) set_stretch(font.face, text);
    const auto spacing = [&](const char* name, double& to) {
        const std::string text = lower(own(name));
        if (!text.empty()) to = text == "normal" ? 0 : length_of(text, font.size).value_or(to);
    };
    spacing("letter-spacing", font.letter_spacing);
    spacing("word-spacing", font.word_spacing);
    if (const std::string text = lower(own("text-anchor")); !text.empty())
        font.anchor = text == "middle" ? SvgAnchor::middle : text == "end" ? SvgAnchor::end : SvgAnchor::start;
    for (const char* name : {"dominant-baseline", "alignment-baseline"})
        font.baseline = baseline_of(lower(own(name))).value_or(font.baseline);
    if (const std::string text = lower(own("baseline-shift")); !text.empty() && text != "baseline")
        font.raise += text == "sub"     ? -0.2 * parent_size
                      : text == "super" ? 0.4 * parent_size
                                        : length_of(text, parent_size).value_or(0);
    for (const char* name : {"text-decoration", "text-decoration-line"}) {
        const std::string text = lower(own(name));
        font.underline = font.underline || text.find("underline") != text.npos;
        font.overline = font.overline || text.find("overline") != text.npos;
        font.strikeout = font.strikeout || text.find("line-through") != text.npos;
    }
    if (const std::string text = lower(own("writing-mode")); !text.empty())
        font.vertical = text.starts_with("tb") || text.starts_with("vertical");
    if (const std::string text = lower(own("xml:space")); !text.empty()) font.keeps_space = text == "preserve";
    if (const std::string text = lower(own("white-space")); !text.empty()) font.keeps_space = text.starts_with("pre");
}

}  // namespace tuft::io
