#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

/// \file
/// The texts of the interface in other languages: `LANGUAGE.po` in this folder, compiled by msgfmt and built into the
/// program (embed_catalogues.cmake), so that it finds them wherever it is installed.
namespace tuft::app {

/// A catalogue as msgfmt writes it (GNU gettext manual, "The Format of GNU MO Files").
class Catalogue {
  public:
    /// The bytes must outlive this. Asserts that they are a catalogue.
    explicit Catalogue(std::span<const unsigned char> mo);

    std::size_t size() const { return n_; }
    /// Text i, with its context and '\4' before it where it has one, and its translation. Sorted by bytes.
    std::string_view text(std::size_t i) const;
    const char* translation(std::size_t i) const;
    /// nullptr where there is none. O(log size).
    const char* find(std::string_view text) const;

  private:
    std::string_view entry(std::size_t table, std::size_t i) const;
    std::size_t number(std::size_t at) const;

    std::span<const unsigned char> bytes_;
    std::size_t n_ = 0, texts_ = 0, translations_ = 0;
};

/// en.po: what shipped brushes, inks, pigments and materials are called in English.
const Catalogue& english_catalogue();
/// zh_CN.po
const Catalogue& chinese_catalogue();

/// English for the name of a shipped brush, ink, pigment or material, nullptr when it is none.
const char* english_name(const char* name);
/// Chinese for an English text of the interface, nullptr when there is none.
const char* chinese_text(const char* english);
/// Chinese for a title or a text of the built-in manual (context "manual"); English where there is none.
const char* chinese_manual_text(const char* english);
/// All Chinese texts in a row, for the font.
std::string all_chinese_text();

}  // namespace tuft::app
