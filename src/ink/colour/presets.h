#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/toml_text.h"
#include "core/message.h"
#include "ink/spectra/spectrum.h"

/// \file
/// Reading and writing of preset files. Internal to `ink/colour`.
namespace tuft::ink::preset {

/// A table of a preset file, with errors that name file and line.
class Reader {
  public:
    Reader(const toml::table& table, const std::string& source) : table_(table), source_(source) {}

    /// Throws `Error` for any other key.
    void only(std::initializer_list<std::string_view> keys) const;
    bool has(std::string_view key) const { return table_.contains(key); }
    /// Returns a number within [lo, hi]. Without a `fallback` the key must be there. Throws `Error` with the line.
    double number(std::string_view key, double lo, double hi, std::optional<double> fallback) const;
    Rgb rgb(std::string_view key, double lo, double hi) const;
    /// A list of `min` to `max` numbers.
    std::vector<float> numbers(std::string_view key, std::size_t min, std::size_t max, double lo, double hi) const;
    std::string text(std::string_view key, std::optional<std::string> fallback) const;
    [[noreturn]] void fail(long line, const Message& what) const;
    long line() const { return table_.source().begin.line; }
    /// Returns the line of a key, from 1.
    long line_of(std::string_view key) const;

  private:
    double in_range(const toml::node& node, std::string_view key, double lo, double hi) const;
    const toml::array& array(std::string_view key) const;

    const toml::table& table_;
    const std::string& source_;
};

/// Names of the files in models/`folder`, sorted.
std::vector<std::string> list(const char* folder);

/// Text of a preset, the file that it comes from, and its name.
struct Text {
    std::string text, source, name;
};
/// Loads the preset of that name in models/`folder`, or the file when the name ends in ".toml". `kind` is its noun
/// in messages.
Text load(std::string_view name, const char* folder, const char* kind);

std::string quoted(const std::string& text);  ///< TOML basic string
std::string shortest(double v);               ///< TOML number
std::string shortest_float(float v);          ///< fewest digits that read back as the same float
/// Returns the shortest number of units that, read back and multiplied by `unit`, gives the same value: a replayed
/// project has the same bits.
std::string shortest_in(float v, double unit);
std::string shortest_in(double v, double unit);
std::string list_text(std::span<const float> values);

}  // namespace tuft::ink::preset
