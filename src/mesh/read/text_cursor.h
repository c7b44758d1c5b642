#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "core/message.h"

/// \file
/// Tokeniser for text model files. It reads token by token and line by line, and knows the line number for
/// messages. Used by the readers of `mesh`.
namespace tuft::mesh {

/// Lines end at LF, CR or CR LF. The cursor never reads past the text. Every call advances or reports the end, so
/// loops over it terminate.
class TextCursor {
  public:
    struct Syntax {
        char comment = '#';         ///< starts a comment that runs to the end of the line; 0: none
        bool continuation = false;  ///< a backslash at the end of a line joins the next one
    };
    TextCursor(std::span<const char> text, std::string file, Syntax syntax);

    /// Line number of the next token, from 1.
    long line() const { return line_; }
    /// Returns true at the end of the text.
    bool at_end() const { return at_ == end_; }
    /// Returns true when this line has another token.
    bool more();
    /// Advances to the start of the next line.
    void next_line();
    /// Advances to the next token. Returns false at the end of the text.
    bool skip_to_token();

    /// Returns the next token of this line, or "" when the line has no more.
    std::string_view word();
    /// Skips `n` characters of the next token. The rest of it becomes the next token.
    void skip(std::size_t n) { skip_blanks(), at_ += n; }
    /// Returns the rest of this line without blanks at its ends.
    std::string_view rest();
    /// Returns the next token as a number; NaN and infinities in any spelling are accepted. Throws `Error` when it
    /// is no number; `what` names the value in the message.
    double number(const char* what);
    /// Returns the next token as a whole number.
    std::int64_t integer(const char* what);
    /// Returns true when the token last read by `number` was spelled as a real number (has . or e).
    bool last_was_real() const { return last_was_real_; }

    /// Number of unread bytes.
    std::size_t left() const { return static_cast<std::size_t>(end_ - at_); }
    const char* position() const { return at_; }
    /// Throws `Error` with file and line.
    [[noreturn]] void fail(const Message& what) const;

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

/// Returns true when two ASCII words are equal but for case.
bool same_word(std::string_view a, std::string_view b);

/// Returns `token` shortened, printable and in quotes, for messages.
std::string in_quotes(std::string_view token);

}  // namespace tuft::mesh
