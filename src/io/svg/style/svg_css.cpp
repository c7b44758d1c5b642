#include "io/svg/style/svg_css.h"

#include <algorithm>
#include <cctype>
#include <pugixml.hpp>
#include <sstream>

#include "core/error.h"
#include "io/strokes/inkml_marks.h"

namespace tuft::io {
namespace {

constexpr std::size_t kMostParts = 32;  // compounds of a selector
constexpr int kMostMatchSteps = 4096;   // of matching one selector with one element

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

bool is_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || static_cast<unsigned char>(c) >= 0x80;
}

std::string name_at(std::string_view text, std::size_t& at) {
    const std::size_t from = at;
    while (at < text.size() && is_name(text[at])) ++at;
    return std::string(text.substr(from, at - from));
}

pugi::xml_node element_before(pugi::xml_node node) {
    do node = node.previous_sibling();
    while (node && node.type() != pugi::node_element);
    return node;
}
pugi::xml_node element_after(pugi::xml_node node) {
    do node = node.next_sibling();
    while (node && node.type() != pugi::node_element);
    return node;
}

bool has_word(std::string_view list, std::string_view word) {
    std::istringstream words{std::string(list)};
    for (std::string one; words >> one;)
        if (one == word) return true;
    return false;
}

// The end of a rule that holds rules of its own.
std::size_t past_block(std::string_view sheet, std::size_t open) {
    std::size_t close = open;
    for (int depth = 0; close < sheet.size(); ++close) {
        depth += sheet[close] == '{' ? 1 : sheet[close] == '}' ? -1 : 0;
        if (depth == 0) break;
    }
    return std::min(close + 1, sheet.size());
}

}  // namespace

std::string_view stripped(std::string_view s) {
    const char* white = " \t\r\n\f";
    const auto from = s.find_first_not_of(white);
    return from == std::string_view::npos ? std::string_view() : s.substr(from, s.find_last_not_of(white) - from + 1);
}

SvgSheet::Block SvgSheet::block_of(std::string_view text) {
    Block out;
    while (!text.empty()) {
        const std::string_view one = text.substr(0, text.find(';'));
        text.remove_prefix(std::min(text.size(), one.size() + 1));
        const std::size_t colon = one.find(':');
        if (colon == std::string_view::npos) continue;
        std::string_view value = stripped(one.substr(colon + 1));
        bool important = false;
        if (const std::size_t mark = value.find('!'); mark != std::string_view::npos) {
            important = stripped(value.substr(mark + 1)) == "important";
            value = stripped(value.substr(0, mark));
        }
        out[std::string(stripped(one.substr(0, colon)))] = {std::string(value), important};
    }
    return out;
}

bool SvgSheet::read_attribute(std::string_view inside, Attribute& out) {
    std::size_t k = 0;
    while (k < inside.size() && (is_name(inside[k]) || inside[k] == ':')) out.name += inside[k++];
    if (out.name.empty()) return false;
    const std::string_view rest = stripped(inside.substr(k));
    if (rest.empty()) return true;
    out.how = rest[0];
    if (rest[0] != '=' &&
        (rest.size() < 2 || rest[1] != '=' || std::string_view("~|^$*").find(rest[0]) == std::string_view::npos))
        return false;
    std::string_view value = stripped(rest.substr(rest[0] == '=' ? 1 : 2));
    if (value.size() > 1 && (value[0] == '"' || value[0] == '\'') && value.back() == value[0])
        value = value.substr(1, value.size() - 2);
    out.value = value;
    return true;
}

bool SvgSheet::read_compound(std::string_view text, std::size_t& at, Compound& one) {
    const std::size_t from = at;
    if (text[at] == '*')
        ++at;
    else
        one.name = name_at(text, at);
    while (at < text.size()) {
        const char mark = text[at];
        if (mark == '[') {
            const std::size_t close = text.find(']', at);
            if (close == std::string_view::npos) return false;
            Attribute attribute{.name = {}, .value = {}};
            if (!read_attribute(stripped(text.substr(at + 1, close - at - 1)), attribute)) return false;
            one.attributes.push_back(std::move(attribute));
            at = close + 1;
            continue;
        }
        if (mark != '.' && mark != '#' && mark != ':') break;
        std::string name = name_at(text, ++at);
        if (name.empty()) return false;
        if (mark == '#') {
            if (!one.id.empty() && one.id != name) return false;
            one.id = name;
        } else if (mark == '.') {
            one.classes.push_back(name);
        } else if (name == "first-child" || name == "last-child" || name == "root") {
            one.pseudos.push_back(name);
        } else {
            return false;
        }
    }
    return at != from;
}

bool SvgSheet::read_joint(std::string_view text, std::size_t& at, Joint& joint) {
    const auto skip_blanks = [&] {
        while (at < text.size() && std::isspace(static_cast<unsigned char>(text[at]))) ++at;
    };
    const std::size_t blank = at;
    skip_blanks();
    if (at == text.size()) return true;
    joint = Joint::inside;
    if (text[at] != '>' && text[at] != '+' && text[at] != '~') return at != blank;
    joint = text[at] == '>' ? Joint::child : text[at] == '+' ? Joint::next : Joint::after;
    ++at;
    skip_blanks();
    return at < text.size();
}

bool SvgSheet::read_selector(std::string_view text, std::vector<Compound>& out) {
    text = stripped(text);
    Joint joint = Joint::none;
    for (std::size_t at = 0; at < text.size();) {
        Compound one{.joint = joint};
        if (!read_compound(text, at, one)) return false;
        out.push_back(std::move(one));
        if (out.size() > kMostParts) return false;
        if (at < text.size() && !read_joint(text, at, joint)) return false;
    }
    return !out.empty();
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
        if (!head.empty() && head.front() == '@') {
            ++passed;
            at = past_block(sheet, open);
            continue;
        }
        const std::size_t close = std::min(sheet.find('}', open), sheet.size());
        blocks_.push_back(block_of(std::string_view(sheet).substr(open + 1, close - open - 1)));
        std::istringstream selectors{std::string(head)};
        for (std::string one; std::getline(selectors, one, ',');) {
            Rule rule{.block = blocks_.size() - 1};
            if (!read_selector(one, rule.selector)) {
                ++passed;
                continue;
            }
            for (const Compound& c : rule.selector)
                rule.specificity +=
                    (c.id.empty() ? 0u : 1u << 20) + (c.name.empty() ? 0u : 1u) +
                    (static_cast<std::uint32_t>(c.classes.size() + c.attributes.size() + c.pseudos.size()) << 10);
            rules_.push_back(std::move(rule));
        }
        at = std::min(close + 1, sheet.size());
    }
    return passed;
}

bool SvgSheet::fits(const Compound& one, const pugi::xml_node& node) {
    if (!one.name.empty() && one.name != local_name(node)) return false;
    if (!one.id.empty() && one.id != node.attribute("id").value()) return false;
    for (const std::string& name : one.classes)
        if (!has_word(node.attribute("class").value(), name)) return false;
    for (const std::string& pseudo : one.pseudos) {
        if (pseudo == "first-child" && element_before(node)) return false;
        if (pseudo == "last-child" && element_after(node)) return false;
        if (pseudo == "root" && node.parent().type() == pugi::node_element) return false;
    }
    for (const Attribute& a : one.attributes) {
        const auto own = node.attribute(a.name.c_str());
        if (!own) return false;
        const std::string_view value = own.value(), wanted = a.value;
        const bool fit = a.how == 0       ? true
                         : a.how == '='   ? value == wanted
                         : a.how == '~'   ? has_word(value, wanted)
                         : a.how == '|'   ? value == wanted || value.starts_with(std::string(wanted) + "-")
                         : wanted.empty() ? false
                         : a.how == '^'   ? value.starts_with(wanted)
                         : a.how == '$'   ? value.ends_with(wanted)
                                          : value.find(wanted) != value.npos;
        if (!fit) return false;
    }
    return true;
}

bool SvgSheet::fits(const std::vector<Compound>& selector, std::size_t last, const pugi::xml_node& node, int& budget) {
    if (--budget < 0 || node.type() != pugi::node_element || !fits(selector[last], node)) return false;
    if (last == 0) return true;
    switch (selector[last].joint) {
        case Joint::child:
            return fits(selector, last - 1, node.parent(), budget);
        case Joint::next:
            return fits(selector, last - 1, element_before(node), budget);
        case Joint::after:
            for (pugi::xml_node other = element_before(node); other && budget > 0; other = element_before(other))
                if (fits(selector, last - 1, other, budget)) return true;
            return false;
        default:
            for (pugi::xml_node other = node.parent(); other && budget > 0; other = other.parent())
                if (fits(selector, last - 1, other, budget)) return true;
            return false;
    }
}

SvgDeclarations SvgSheet::declared(const pugi::xml_node& node) const {
    std::vector<const Rule*> own;
    for (const Rule& rule : rules_) {
        int budget = kMostMatchSteps;
        if (fits(rule.selector, rule.selector.size() - 1, node, budget)) own.push_back(&rule);
    }
    std::stable_sort(own.begin(), own.end(),
                     [](const Rule* a, const Rule* b) { return a->specificity < b->specificity; });
    std::map<std::string, Value> all;
    const auto apply = [&](const Block& block) {
        for (const auto& [key, value] : block)
            if (Value& to = all[key]; value.important || !to.important) to = value;
    };
    for (const Rule* rule : own) apply(blocks_[rule->block]);
    if (const auto style = node.attribute("style")) apply(block_of(style.value()));
    SvgDeclarations out;
    for (auto& [key, value] : all) out[key] = std::move(value.text);
    return out;
}

}  // namespace tuft::io
