#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include "core/message.h"

/// \file
/// Errors that a user can cause. A function throws one where the bad value enters. The text is one line: what is
/// wrong and what to do. Only `cli` and `app` catch them. A broken invariant is an `assert`.
namespace tuft {

/// The input or the machine does not allow the work: the program exits with 1. `what` is the message in English.
class Error : public std::runtime_error {
  public:
    explicit Error(Message message) : std::runtime_error(message.text()), message_(std::move(message)) {}
    /// "FILE: what".
    Error(const std::string& file, const Message& what) : Error(Message("{}: {}", file, what)) {}
    /// "FILE:LINE: what"; lines count from 1.
    Error(const std::string& file, long line, const Message& what) : Error(Message("{}:{}: {}", file, line, what)) {}

    const Message& message() const { return message_; }

  private:
    Message message_;
};

/// The command line is wrong: the program exits with 2.
class UsageError : public Error {
  public:
    using Error::Error;
};

/// The user stopped the work through a `Progress` callback.
class Cancelled : public std::exception {
  public:
    const char* what() const noexcept override { return "cancelled"; }
};

/// Returns the candidate with the smallest edit distance to `name`. Returns "" when no candidate is within half of
/// the name's length. Used for "unknown brush 'wolff', did you mean 'wolf'?".
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);
/// Returns ", did you mean 'NAME'?" for the end of a sentence, "" without a name.
Message did_you_mean(const std::string& name);

/// Returns the message for a person of an exception of any kind.
Message message_of(const std::exception& error);

}  // namespace tuft
