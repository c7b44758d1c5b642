#include "io/package/xml_entities.h"

#include <algorithm>
#include <cctype>
#include <map>

#include "core/error.h"

namespace tuft::io {
namespace {

constexpr int kMostNested = 16;                               // entities in entities
constexpr std::size_t kMostExpanded = std::size_t{64} << 20;  // bytes
constexpr std::size_t kMostEntities = 10'000;

using Entities = std::map<std::string, std::string, std::less<>>;

bool is_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.' || c == ':' ||
           static_cast<unsigned char>(c) >= 0x80;
}

// Past the end of what begins at `at` and ends with `close`; the end of the text where it does not end.
std::size_t past(std::string_view text, std::size_t at, std::string_view close) {
    const std::size_t end = text.find(close, at);
    return end == text.npos ? text.size() : end + close.size();
}

class Subset {
  public:
    Subset(std::string_view text, std::size_t at) : text_(text), at_(at) {}

    /// Reads declarations up to the closing bracket.
    Entities read() {
        Entities entities;
        while (at_ < text_.size() && text_[at_] != ']') {
            if (starts("<!--")) {
                at_ = past(text_, at_, "-->");
            } else if (starts("<!ENTITY") && entities.size() < kMostEntities) {
                at_ += 8;
                declare(entities);
            } else if (text_[at_] == '"' || text_[at_] == '\'') {
                quoted();
            } else {
                ++at_;
            }
        }
        return entities;
    }
    std::size_t end() const { return past(text_, at_, ">"); }

  private:
    bool starts(std::string_view word) const { return text_.substr(at_).starts_with(word); }
    void skip_blanks() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }
    std::string quoted() {
        const char quote = text_[at_++];
        const std::size_t end = std::min(text_.find(quote, at_), text_.size());
        std::string value(text_.substr(at_, end - at_));
        at_ = std::min(end + 1, text_.size());
        return value;
    }
    // ENTITY name "value"; parameter entities and those of other files are passed over.
    void declare(Entities& entities) {
        skip_blanks();
        const std::size_t begin = at_;
        while (at_ < text_.size() && is_name(text_[at_])) ++at_;
        std::string name(text_.substr(begin, at_ - begin));
        skip_blanks();
        if (name.empty() || at_ >= text_.size() || (text_[at_] != '"' && text_[at_] != '\'')) return;
        entities.emplace(std::move(name), quoted());
    }

    std::string_view text_;
    std::size_t at_;
};

class Expander {
  public:
    Expander(const Entities& entities, const std::string& source) : entities_(entities), source_(source) {}

    void append(std::string_view text, std::string& out, int depth = 0) {
        if (depth > kMostNested) throw Error(source_, "its entities refer to each other too deeply");
        for (std::size_t at = 0; at < text.size();) {
            const std::size_t next = std::min(text.find_first_of("&<", at), text.size());
            out.append(text.substr(at, next - at));
            at = next;
            if (at == text.size()) break;
            const std::string_view left = text.substr(at);
            std::size_t end = at + 1;
            if (left.starts_with("<!--")) {
                end = past(text, at, "-->");
            } else if (left.starts_with("<![CDATA[")) {
                end = past(text, at, "]]>");
            } else if (left[0] == '&') {
                while (end < text.size() && is_name(text[end])) ++end;
                const auto entity = entities_.find(text.substr(at + 1, end - at - 1));
                if (entity != entities_.end() && end < text.size() && text[end] == ';') {
                    if ((expanded_ += entity->second.size()) > kMostExpanded)
                        throw Error(source_, "what its entities repeat makes it too large");
                    append(entity->second, out, depth + 1);
                    at = end + 1;
                    continue;
                }
            }
            out.append(text.substr(at, end - at));
            at = end;
        }
    }

  private:
    const Entities& entities_;
    const std::string& source_;
    std::size_t expanded_ = 0;
};

}  // namespace

std::string expand_entities(std::string_view xml, const std::string& source) {
    const std::size_t doctype = xml.find("<!DOCTYPE"), open = xml.find_first_of("[>", std::min(doctype, xml.size()));
    if (doctype == xml.npos || open == xml.npos || xml[open] != '[') return std::string(xml);
    Subset subset(xml, open + 1);
    const Entities entities = subset.read();
    if (entities.empty()) return std::string(xml);
    std::string out(xml.substr(0, subset.end()));
    Expander(entities, source).append(xml.substr(subset.end()), out);
    return out;
}

}  // namespace tuft::io
