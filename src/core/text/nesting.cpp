#include "core/text/nesting.h"

#include <algorithm>

#include "core/error.h"

namespace tuft {
namespace {

/// Where the string that starts at `at` ends: the place after its closing quotes, or the end of the
/// text.
std::size_t skip_toml_string(std::string_view text, std::size_t at) {
    const char quote = text[at];
    const std::string_view three(quote == '"' ? "\"\"\"" : "'''");
    if (text.substr(at).starts_with(three)) {
        for (std::size_t i = at + 3; i < text.size(); ++i) {
            if (text[i] == '\\' && quote == '"') {
                ++i;
            } else if (text.substr(i).starts_with(three)) {
                i += 3;
                // One or two quotes may stand before the closing three.
                for (int extra = 0; extra < 2 && i < text.size() && text[i] == quote; ++extra) ++i;
                return i;
            }
        }
        return text.size();
    }
    for (std::size_t i = at + 1; i < text.size(); ++i) {
        if (text[i] == '\n') return i;  // a fault, which the parser names
        if (text[i] == '\\' && quote == '"')
            ++i;
        else if (text[i] == quote)
            return i + 1;
    }
    return text.size();
}

}  // namespace

void check_toml_nesting(std::string_view text, const std::string& source) {
    int depth = 0, dots = 0;
    long line = 1;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (c == '"' || c == '\'') {
            const std::size_t end = skip_toml_string(text, i);
            line += std::count(text.begin() + static_cast<std::ptrdiff_t>(i),
                               text.begin() + static_cast<std::ptrdiff_t>(end), '\n');
            i = end - 1;
        } else if (c == '#') {
            while (i + 1 < text.size() && text[i + 1] != '\n' && text[i + 1] != '\r') ++i;
        } else if (c == '.') {
            if (++dots >= kDeepestToml)
                throw Error(source, line, Message("a key has more than {} parts", kDeepestToml));
        } else if (c == '[' || c == '{') {
            dots = 0;
            if (++depth > kDeepestToml)
                throw Error(source, line, Message("arrays and tables are nested more than {} deep", kDeepestToml));
        } else if (c == ']' || c == '}') {
            dots = 0;
            depth = std::max(0, depth - 1);
        } else if (c == '\n' || c == '=' || c == ',') {
            dots = 0;
            line += c == '\n';
        }
    }
}

void check_json_nesting(std::string_view text, const std::string& source) {
    int depth = 0;
    bool quoted = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted) {
            if (c == '\\')
                ++i;
            else if (c == '"')
                quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '{' || c == '[') {
            if (++depth > kDeepestJson)
                throw Error(source, Message("its JSON is nested more than {} deep", kDeepestJson));
        } else if (c == '}' || c == ']') {
            --depth;
        }
    }
}

}  // namespace tuft
