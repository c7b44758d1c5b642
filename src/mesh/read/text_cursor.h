#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

/// Reading model files that are text: token by token, line by line, with the line
/// number at hand for messages. Internal to `mesh`.
namespace tuft::mesh {

/// Lines end at LF, CR or CR LF. Never reads past the text; every call moves on or
/// reports the end, so loops over it end.
class TextCursor {
  public:
    struct Syntax {
        char comment = '#';         ///< starts a comment that runs to the end of the line; 0: none
        bool continuation = false;  ///< a backslash at the end of a line joins the next one
    };
    TextCursor(std::span<const char> text, std::string file, Syntax syntax);

    /// The line of the next token, from 1.
    long line() const { return line_; }
    /// Whether the text is used up.
    bool at_end() const { return at_ == end_; }
    /// Whether another token stands on this line.
    bool more();
    /// Goes to the start of the next line.
    void next_line();
    /// Goes on until a token is next; false at the end of the text.
    bool skip_to_token();

    /// Next token of this line, or "" when the line has no more.
    std::string_view word();
    /// Goes on by `n` characters of the next token, of which the rest is a token then.
    void skip(std::size_t n) { skip_blanks(), at_ += n; }
    /// The rest of this line without blanks at its ends.
    std::string_view rest();
    /// Next token as a number; NaN and infinities in any spelling pass through.
    /// `what` names the value in the message when there is no number.
    double number(const char* what);
    /// Next token as a whole number.
    std::int64_t integer(const char* what);
    /// Whether the token last read by `number` was spelled as a real number (has . or e).
    bool last_was_real() const { return last_was_real_; }

    /// Bytes that are left.
    std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
    const char* position() const { return at_; }
    /// Throws `Error` with file and line.
    [[noreturn]] void fail(const std::string& what) const;

  private:
    void skip_blanks();
    void end_line();
    bool token_ends(const char* p) const;

    const char* at_;
    const char* end_;
    std::string file_;
    Syntax syntax_;
    long line_ = 1;
    bool last_was_real_ = false;
};

/// Whether two ASCII words are the same but for case.
bool same_word(std::string_view a, std::string_view b);

/// `token` shortened and made printable, in quotes, for messages.
std::string in_quotes(std::string_view token);

}  // namespace tuft::mesh
