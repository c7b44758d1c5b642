#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace pugi {
class xml_node;
}

/// \file
/// Style sheets of SVG drawings: selectors and the cascade (CSS 2.1, chapters 5 and 6). Called by svg_scene.cpp only.
/// Any thread.
namespace tuft::io {

/// Returns the text without white space at both ends.
std::string_view stripped(std::string_view text);

/// Properties by name.
using SvgDeclarations = std::map<std::string, std::string>;

/// Rules of style sheets. A selector is made of element names, `*`, `.class`, `#id`, attributes (`[a]`, `[a=v]`,
/// `[a~=v]`, `[a|=v]`, `[a^=v]`, `[a$=v]`, `[a*=v]`) and `:first-child`, `:last-child`, `:root`, joined by blanks, `>`,
/// `+` and `~`.
class SvgSheet {
  public:
    /// Adds the rules of a sheet. Returns the number of skipped rules: at-rules and other selectors.
    std::size_t add(std::string_view sheet);
    /// Returns the properties that apply to an element besides its attributes, by specificity and order. The element's
    /// `style` outranks every rule; `!important` outranks both.
    SvgDeclarations declared(const pugi::xml_node& element) const;
    /// Returns the number of rules.
    std::size_t size() const { return rules_.size(); }

  private:
    enum class Joint : std::uint8_t { none, inside, child, next, after };
    struct Attribute {
        std::string name, value;
        char how = 0;  ///< 0: is there; '=': equal; '~', '|', '^', '$', '*' as in CSS
    };
    /// One compound selector, and how it is joined to the one on its left.
    struct Compound {
        Joint joint = Joint::none;
        std::string name, id;  ///< empty: any
        std::vector<std::string> classes, pseudos;
        std::vector<Attribute> attributes;
    };
    struct Rule {
        std::vector<Compound> selector;
        std::uint32_t specificity = 0;
        std::size_t block = 0;
    };
    struct Value {
        std::string text;
        bool important = false;
    };
    using Block = std::map<std::string, Value>;

    static Block block_of(std::string_view text);
    // Each returns false for what this program does not know. `at` moves to the end of what was read.
    static bool read_attribute(std::string_view inside, Attribute& out);
    static bool read_compound(std::string_view text, std::size_t& at, Compound& one);
    static bool read_joint(std::string_view text, std::size_t& at, Joint& joint);
    static bool read_selector(std::string_view text, std::vector<Compound>& out);
    static bool fits(const Compound& one, const pugi::xml_node& node);
    static bool fits(const std::vector<Compound>& selector, std::size_t last, const pugi::xml_node& node, int& budget);

    std::vector<Block> blocks_;
    std::vector<Rule> rules_;  // in the order of the file
};

}  // namespace tuft::io
