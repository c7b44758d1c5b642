#include "mesh/read/text_cursor.h"

#include <charconv>
#include <cmath>
#include <limits>

#include "core/error.h"

namespace tuft::mesh {
namespace {

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\v' || c == '\f';
}
bool is_line_end(char c) {
    return c == '\n' || c == '\r';
}
bool is_space(char c) {
    return is_blank(c) || is_line_end(c);
}
char lower(char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c;
}

}  // namespace

TextCursor::TextCursor(std::span<const char> text, std::string file, Syntax syntax)
    : at_(text.data()), end_(text.data() + text.size()), file_(std::move(file)), syntax_(syntax) {
    if (text.size() >= 3 && std::string_view(at_, 3) == "\xEF\xBB\xBF") at_ += 3;
}

void TextCursor::fail(const Message& what) const {
    throw Error(file_, line_, what);
}

bool TextCursor::token_ends(const char* p) const {
    if (p == end_ || is_space(*p)) return true;
    return syntax_.continuation && *p == '\\' && p + 1 != end_ && is_line_end(p[1]);
}

void TextCursor::end_line() {
    if (at_ == end_) return;
    const char c = *at_++;
    if (c == '\r' && at_ != end_ && *at_ == '\n') ++at_;
    ++line_;
}

void TextCursor::skip_blanks() {
    while (at_ != end_) {
        if (is_blank(*at_)) {
            ++at_;
        } else if (*at_ == '\\' && syntax_.continuation) {
            const char* p = at_ + 1;
            while (p != end_ && is_blank(*p)) ++p;
            if (p == end_ || !is_line_end(*p)) return;
            at_ = p;
            end_line();
        } else {
            return;
        }
    }
}

bool TextCursor::more() {
    skip_blanks();
    return at_ != end_ && !is_line_end(*at_) && (syntax_.comment == 0 || *at_ != syntax_.comment);
}

void TextCursor::next_line() {
    // A comment that ends in a backslash is not continued: exporters write Windows paths there.
    bool in_comment = false;
    while (at_ != end_ && !is_line_end(*at_)) {
        in_comment = in_comment || (syntax_.comment != 0 && *at_ == syntax_.comment);
        if (*at_ == '\\' && syntax_.continuation && !in_comment) {
            const char* before = at_;
            skip_blanks();
            if (at_ != before) continue;
        }
        ++at_;
    }
    end_line();
}

bool TextCursor::skip_to_token() {
    while (at_ != end_) {
        if (more()) return true;
        next_line();
    }
    return false;
}

std::string_view TextCursor::word() {
    if (!more()) return {};
    const char* begin = at_;
    while (!token_ends(at_)) ++at_;
    return {begin, static_cast<std::size_t>(at_ - begin)};
}

std::string_view TextCursor::rest() {
    skip_blanks();
    const char* begin = at_;
    while (at_ != end_ && !is_line_end(*at_)) ++at_;
    const char* last = at_;
    while (last != begin && is_blank(last[-1])) --last;
    return {begin, static_cast<std::size_t>(last - begin)};
}

double TextCursor::number(const char* what) {
    if (!more()) fail(Message("the line ends where {} should be", what));
    const char* begin = at_;
    const char* p = *begin == '+' ? begin + 1 : begin;
    double value = 0;
    const auto [stop, ec] = std::from_chars(p, end_, value);
    at_ = stop;
    if (ec == std::errc::invalid_argument || !token_ends(stop)) {
        while (!token_ends(at_)) ++at_;
        const std::string_view token(begin, static_cast<std::size_t>(at_ - begin));
        // Old Windows programs write 1.#QNAN, -1.#IND and 1.#INF.
        if (ec == std::errc() && token.find(".#") != token.npos) return std::numeric_limits<double>::quiet_NaN();
        const bool comment_follows = ec == std::errc() && *stop == syntax_.comment;
        if (!comment_follows) fail(Message("{} is not a number ({} was expected)", in_quotes(token), what));
        at_ = stop;
    }
    const std::string_view spelled(begin, static_cast<std::size_t>(stop - begin));
    last_was_real_ = spelled.find_first_of(".eE") != spelled.npos;
    if (ec == std::errc::result_out_of_range) {
        const bool tiny = spelled.find("e-") != spelled.npos || spelled.find("E-") != spelled.npos;
        return tiny ? 0.0 : std::numeric_limits<double>::infinity();
    }
    return value;
}

std::int64_t TextCursor::integer(const char* what) {
    const double value = number(what);
    if (!(std::abs(value) <= 9e15) || value != std::floor(value))
        fail(Message("a whole number was expected for {}", what));
    return static_cast<std::int64_t>(value);
}

bool same_word(std::string_view a, std::string_view b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        if (lower(a[i]) != lower(b[i])) return false;
    return true;
}

std::string in_quotes(std::string_view token) {
    std::string out = "'";
    for (const char c : token.substr(0, 24)) out += c >= ' ' && c <= '~' ? c : '?';
    if (token.size() > 24) out += "...";
    return out + "'";
}

}  // namespace tuft::mesh
