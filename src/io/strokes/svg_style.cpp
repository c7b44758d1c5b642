#include "io/strokes/svg_style.h"

#include <algorithm>
#include <cctype>
#include <pugixml.hpp>
#include <sstream>

#include "io/strokes/inkml_marks.h"

namespace tuft::io {
namespace {

// The declarations of a style, "name: value; name: value".
std::map<std::string, std::string> declarations(std::string_view text) {
    std::map<std::string, std::string> out;
    while (!text.empty()) {
        const std::string_view one = text.substr(0, text.find(';'));
        text.remove_prefix(std::min(text.size(), one.size() + 1));
        const std::size_t colon = one.find(':');
        if (colon == std::string_view::npos) continue;
        std::string_view value = stripped(one.substr(colon + 1));
        if (const std::size_t mark = value.find('!'); mark != std::string_view::npos)
            value = stripped(value.substr(0, mark));
        out[std::string(stripped(one.substr(0, colon)))] = value;
    }
    return out;
}

std::string without_comments(std::string_view sheet) {
    std::string out;
    for (std::size_t at = 0; at < sheet.size();) {
        const std::size_t open = sheet.find("/*", at);
        out += sheet.substr(at, open == std::string_view::npos ? open : open - at);
        if (open == std::string_view::npos) break;
        const std::size_t close = sheet.find("*/", open + 2);
        at = close == std::string_view::npos ? sheet.size() : close + 2;
    }
    return out;
}

bool is_simple(std::string_view selector) {
    if (selector.empty()) return false;
    const std::string_view name = selector.substr(selector.front() == '.' || selector.front() == '#');
    return !name.empty() && std::all_of(name.begin(), name.end(), [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' ||
               static_cast<unsigned char>(c) >= 0x80;
    });
}

std::string canonical(std::string_view colour) {
    std::string out;
    for (const char c : colour)
        if (!std::isspace(static_cast<unsigned char>(c)))
            out += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

bool is_white(const std::string& colour) {
    static constexpr const char* names[] = {"white",
                                            "#fff",
                                            "#ffff",
                                            "#ffffff",
                                            "#ffffffff",
                                            "rgb(255,255,255)",
                                            "rgb(100%,100%,100%)",
                                            "rgba(255,255,255,1)",
                                            "hsl(0,0%,100%)"};
    return std::find(std::begin(names), std::end(names), colour) != std::end(names);
}

}  // namespace

std::string_view stripped(std::string_view s) {
    const char* white = " \t\r\n";
    const auto from = s.find_first_not_of(white);
    return from == std::string_view::npos ? std::string_view() : s.substr(from, s.find_last_not_of(white) - from + 1);
}

std::size_t SvgSheet::add(std::string_view text) {
    const std::string sheet = without_comments(text);
    std::size_t passed = 0;
    for (std::size_t at = 0, open; (open = sheet.find('{', at)) != std::string::npos;) {
        std::string_view head = stripped(std::string_view(sheet).substr(at, open - at));
        while (!head.empty() && head.front() == '@' && head.find(';') != std::string_view::npos) {  // "@import ...;"
            ++passed;
            head = stripped(head.substr(head.find(';') + 1));
        }
        std::size_t close = open + 1;
        if (!head.empty() && head.front() == '@') {  // holds rules of its own
            ++passed;
            for (int depth = 1; close < sheet.size(); ++close) {
                depth += sheet[close] == '{' ? 1 : sheet[close] == '}' ? -1 : 0;
                if (depth == 0) break;
            }
            at = std::min(close + 1, sheet.size());
            continue;
        }
        close = std::min(sheet.find('}', open), sheet.size());
        const auto rules = declarations(std::string_view(sheet).substr(open + 1, close - open - 1));
        std::istringstream selectors{std::string(head)};
        for (std::string one; std::getline(selectors, one, ',');) {
            const std::string_view selector = stripped(one);
            if (!is_simple(selector)) {
                ++passed;
                continue;
            }
            for (const auto& [key, value] : rules) rules_[std::string(selector)][key] = value;
        }
        at = std::min(close + 1, sheet.size());
    }
    return passed;
}

std::map<std::string, std::string> SvgSheet::declared(const pugi::xml_node& node, const std::string& name) const {
    std::map<std::string, std::string> out;
    const auto apply = [&](const std::string& selector) {
        if (const auto rule = rules_.find(selector); rule != rules_.end())
            for (const auto& [key, value] : rule->second) out[key] = value;
    };
    if (!rules_.empty()) {
        apply(name);
        std::istringstream classes(node.attribute("class").value());
        for (std::string one; classes >> one;) apply("." + one);
        if (const auto id = node.attribute("id")) apply("#" + std::string(id.value()));
    }
    if (const auto style = node.attribute("style"))
        for (auto& [key, value] : declarations(style.value())) out[key] = value;
    return out;
}

SvgPaint svg_paint(const std::string& value, const SvgIds& ids) {
    using Kind = SvgPaint::Kind;
    std::string_view left = value;
    while (left.starts_with("url(")) {  // a fallback may be a reference again
        const std::size_t close = std::min(left.find(')'), left.size());
        std::string target(stripped(left.substr(4, close - 4)));
        std::erase_if(target, [](char c) { return c == '"' || c == '\''; });
        const auto at = target.starts_with('#') ? ids.find(target.substr(1)) : ids.end();
        if (at != ids.end()) return {local_name(at->second) == "pattern" ? Kind::pattern : Kind::gradient, {}};
        left = close < left.size() ? stripped(left.substr(close + 1)) : std::string_view();
        if (left.empty()) return {Kind::missing, {}};
    }
    const std::string colour = canonical(left);
    if (colour == "none" || colour == "transparent") return {};
    return {is_white(colour) ? Kind::white : Kind::flat, colour};
}

}  // namespace tuft::io
