#include "io/model/read_vrml.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/system/interrupt.h"
#include "io/model/read_x3d.h"

namespace tuft::io {
namespace {

using pugi::xml_node;

constexpr int kDeepestVrml = 256;
constexpr std::size_t kMostVrmlNodes = 4'000'000;
constexpr std::size_t kMostVrmlFields = 16'000'000;
constexpr std::size_t kLongestName = 1000;
constexpr std::size_t kLongestInMessage = 40;

bool is_space(char c) {
    return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == ',';
}
bool is_bracket(char c) {
    return c == '[' || c == ']' || c == '{' || c == '}';
}
bool is_number(std::string_view word) {
    return !word.empty() &&
           (std::isdigit(static_cast<unsigned char>(word[0])) || word[0] == '-' || word[0] == '+' || word[0] == '.');
}

/// Words, brackets and quoted strings of a file; white space, commas and comments are passed over.
class Words {
  public:
    Words(std::string_view text, const std::string& file) : text_(text), file_(file) { find(); }

    /// The next word, with its quotes; empty at the end.
    std::string_view peek() const { return word_; }
    std::string_view take() {
        const std::string_view word = word_;
        at_ += word.size();
        find();
        return word;
    }
    void expect(std::string_view word) {
        if (word_ != word)
            fail(Message("'{}' is expected, not '{}'", std::string(word),
                         std::string(word_.substr(0, kLongestInMessage))));
        take();
    }
    [[noreturn]] void fail(const Message& fault) const {
        long line = 1;
        for (std::size_t i = 0; i < at_; ++i)  // a line ends with LF, CR or both
            if (text_[i] == '\n' || (text_[i] == '\r' && (i + 1 == text_.size() || text_[i + 1] != '\n'))) ++line;
        throw Error(file_, Message("line {}: {}", line, fault));
    }

  private:
    void find() {
        while (at_ < text_.size() && (is_space(text_[at_]) || text_[at_] == '#'))
            at_ = text_[at_] == '#' ? std::min(text_.find_first_of("\r\n", at_), text_.size()) : at_ + 1;
        std::size_t end = at_;
        if (end < text_.size() && text_[end] == '"') {
            for (++end; end < text_.size() && text_[end] != '"'; ++end)
                if (text_[end] == '\\') ++end;
            if (end >= text_.size()) {
                word_ = {};
                fail("a string has no end");
            }
            ++end;
        } else if (end < text_.size() && is_bracket(text_[end])) {
            ++end;
        } else {
            while (end < text_.size() && !is_space(text_[end]) && !is_bracket(text_[end]) && text_[end] != '"' &&
                   text_[end] != '#')
                ++end;
        }
        word_ = text_.substr(at_, end - at_);
    }

    std::string_view text_;
    const std::string& file_;
    std::size_t at_ = 0;
    std::string_view word_;
};

/// Makes the tree that X3D's XML would have: fields of values become attributes, nodes become elements.
class TreeBuilder {
  public:
    TreeBuilder(std::string_view text, const std::string& file) : words_(text, file) {}

    pugi::xml_document build() {
        pugi::xml_document document;
        xml_node root = document.append_child("X3D");
        head_ = root.append_child("head");
        xml_node scene = root.append_child("Scene");
        while (!words_.peek().empty()) add_statement(scene, 0);
        return document;
    }

  private:
    struct Named {
        std::string kind, name;
        int times = 0;  // that the file gives the name
    };

    std::string name() {
        const std::string_view word = words_.peek();
        if (word.empty() || is_bracket(word[0]) || word[0] == '"' || is_number(word))
            words_.fail(Message("a name is expected, not '{}'", std::string(word.substr(0, kLongestInMessage))));
        if (word.size() > kLongestName) words_.fail("a name has more than 1000 letters");
        return std::string(words_.take());
    }

    void add_statement(xml_node& parent, int depth) {
        const std::string_view word = words_.peek();
        if (add_declaration(parent)) return;
        if (word == "PROFILE") {
            words_.take();
            words_.take();
        } else if (word == "COMPONENT" || word == "IMPORT" || word == "EXPORT") {
            words_.take();
            words_.take();
            skip_alias();
        } else if (word == "META") {
            for (int k = 0; k < 3; ++k) words_.take();
        } else if (word == "UNIT") {
            words_.take();
            xml_node unit = head_.append_child("unit");
            unit.append_attribute("category") = std::string(words_.take()).c_str();
            unit.append_attribute("name") = std::string(words_.take()).c_str();
            unit.append_attribute("conversionFactor") = std::string(words_.take()).c_str();
        } else {
            add_node(parent, depth);
        }
    }

    void skip_alias() {
        if (words_.peek() != "AS") return;
        words_.take();
        words_.take();
    }

    /// Prototypes and routes, which may stand among statements and among fields.
    bool add_declaration(xml_node& parent) {
        const std::string_view word = words_.peek();
        if (word == "ROUTE") {
            for (int k = 0; k < 4; ++k) words_.take();
            return true;
        }
        if (word != "PROTO" && word != "EXTERNPROTO") return false;
        const bool is_here = word == "PROTO";
        words_.take();
        name();
        skip_brackets("[");
        if (is_here)
            skip_brackets("{");
        else if (words_.peek() == "[")
            skip_brackets("[");
        else
            words_.take();
        parent.append_child("ProtoDeclare");
        return true;
    }

    void skip_brackets(std::string_view first) {
        words_.expect(first);
        for (std::size_t open = 1; open > 0;) {
            const std::string_view word = words_.take();
            if (word.empty()) words_.fail("the file ends within brackets");
            if (word == "[" || word == "{") ++open;
            if (word == "]" || word == "}") --open;
        }
    }

    void add_node(xml_node& parent, int depth) {
        if (depth > kDeepestVrml) words_.fail("nodes lie more than 256 deep");
        if (++n_nodes_ > kMostVrmlNodes) words_.fail("there are more than four million nodes");
        if (n_nodes_ % 4096 == 0) check_interrupt();
        const std::string first = name();
        if (first == "NULL") {
            parent.append_child(pugi::node_element);  // counts among the children of a switch
            return;
        }
        if (first == "USE") {
            const std::string used = name();
            add_use(parent, used);
            return;
        }
        std::string defined;
        if (first == "DEF") defined = name();
        const std::string kind = first == "DEF" ? name() : first;
        xml_node node = parent.append_child(kind.c_str());
        if (!defined.empty()) {
            // A later node of the same name takes it over; the tree knows each name once. No name of a file has a '#'.
            Named& named = named_[defined];
            named = {kind, named.times == 0 ? defined : defined + "#" + std::to_string(named.times + 1),
                     named.times + 1};
            node.append_attribute("DEF") = named.name.c_str();
        }
        words_.expect("{");
        while (words_.peek() != "}") {
            if (words_.peek().empty()) words_.fail("the file ends within a node");
            add_field(node, depth);
        }
        words_.take();
    }

    /// In XML a node that is used has the kind of the one that it stands for.
    void add_use(xml_node& parent, const std::string& used) {
        const auto named = named_.find(used);
        if (named == named_.end()) {
            parent.append_child(pugi::node_element);  // counts among the children of a switch
            return;
        }
        parent.append_child(named->second.kind.c_str()).append_attribute("USE") = named->second.name.c_str();
    }

    void add_field(xml_node& node, int depth) {
        if (++n_fields_ > kMostVrmlFields) words_.fail("there are more than sixteen million fields");
        if (n_fields_ % 4096 == 0) check_interrupt();
        if (add_declaration(node)) return;
        std::string field = name();
        if (field == "eventIn" || field == "eventOut" || field == "inputOnly" || field == "outputOnly") {
            name();
            name();
            if (words_.peek() == "IS") skip_is();
            return;
        }
        if (field == "field" || field == "exposedField" || field == "initializeOnly" || field == "inputOutput") {
            name();
            field = name();
        }
        if (words_.peek() == "IS") return skip_is();
        // What a collision is computed with instead of the shape is not seen, but its nodes may be used elsewhere.
        xml_node proxy;
        if (field == "proxy") proxy = head_.append_child("proxy");
        add_value(proxy ? proxy : node, field, depth);
    }

    void skip_is() {
        words_.take();
        name();
    }

    void add_value(xml_node& node, const std::string& field, int depth) {
        std::string text;
        const auto add_word = [&] {
            if (!text.empty()) text += ' ';
            text += words_.take();
        };
        const auto is_value = [&] { return is_number(words_.peek()) || words_.peek().starts_with('"'); };
        if (words_.peek() == "[") {
            words_.take();
            while (words_.peek() != "]") {
                if (words_.peek().empty()) words_.fail("the file ends within brackets");
                if (is_value())
                    add_word();
                else if (words_.peek() == "TRUE" || words_.peek() == "FALSE")
                    words_.take();
                else
                    add_node(node, depth + 1);
            }
            words_.take();
        } else if (words_.peek() == "TRUE" || words_.peek() == "FALSE") {
            text = words_.take() == "TRUE" ? "true" : "false";
        } else if (words_.peek().starts_with('"')) {
            add_word();
        } else if (is_value()) {
            while (is_number(words_.peek())) add_word();
        } else {
            add_node(node, depth + 1);
        }
        if (!text.empty()) node.append_attribute(field.c_str()) = text.c_str();
    }

    Words words_;
    xml_node head_;
    std::map<std::string, Named> named_;
    std::size_t n_nodes_ = 0, n_fields_ = 0;
};

}  // namespace

mesh::PolygonSoup read_vrml(const std::vector<char>& bytes, const std::filesystem::path& path) {
    const std::string file = path.string();
    std::string_view text(bytes.data(), bytes.size());
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // the mark of UTF-8
    if (text.starts_with("\x1f\x8b")) throw Error(file, "is compressed; unpack it with gunzip first");
    if (text.starts_with("#VRML V1.0"))
        throw Error(file, "is VRML 1.0, which tuft does not read; export it as VRML 2.0 (VRML97), X3D or GLB");
    if (!text.starts_with("#VRML V2.0") && !text.starts_with("#X3D V"))
        throw Error(file, "not VRML: the first line is neither '#VRML V2.0 utf8' nor '#X3D V3.x utf8'");
    const pugi::xml_document document = TreeBuilder(text, file).build();
    mesh::PolygonSoup soup = read_x3d_tree(document, path);
    const xml_node head = document.first_child().child("head");
    if (text.starts_with("#VRML") && !head.find_child_by_attribute("unit", "category", "length")) soup.stated_unit = 0;
    return soup;
}

}  // namespace tuft::io
