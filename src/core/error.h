#pragma once

#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

/// Errors a user can cause. They are thrown where the bad value enters, carry
/// one line that says what is wrong and what to do, and are caught in `cli` and
/// `app` only. A broken invariant is an `assert`, never one of these.
namespace tuft {

/// The input or the machine made it impossible: the program exits with 1.
class Error : public std::runtime_error {
  public:
    explicit Error(const std::string& what) : std::runtime_error(what) {}
    /// "FILE: what".
    Error(const std::string& file, const std::string& what) : std::runtime_error(file + ": " + what) {}
    /// "FILE:LINE: what"; lines count from 1.
    Error(const std::string& file, long line, const std::string& what)
        : std::runtime_error(file + ":" + std::to_string(line) + ": " + what) {}
};

/// The command line is wrong: the program exits with 2.
class UsageError : public Error {
  public:
    using Error::Error;
};

/// Work was stopped by the user through a `Progress` callback.
class Cancelled : public std::exception {
  public:
    const char* what() const noexcept override { return "cancelled"; }
};

/// The candidate with the smallest edit distance to `name`, or "" when none is
/// within half of the name's length. For "unknown brush 'wolff', did you mean 'wolf'?".
std::string nearest_name(std::string_view name, std::span<const std::string> candidates);

}  // namespace tuft
