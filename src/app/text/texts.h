#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>

/// \file
/// Translations of the interface. `LANGUAGE.po` in this folder is compiled by msgfmt and built into the program
/// (embed_catalogues.cmake). Any thread.
namespace tuft::app {

/// A message catalogue as msgfmt writes it (GNU gettext manual, "The Format of GNU MO Files").
class Catalogue {
  public:
    /// `mo` must outlive this and be a catalogue (asserted).
    explicit Catalogue(std::span<const unsigned char> mo);

    std::size_t size() const { return n_; }
    /// Returns text i, after its context and '\4' where it has one, and its translation. Sorted by bytes.
    std::string_view text(std::size_t i) const;
    const char* translation(std::size_t i) const;
    /// Returns the translation of a text; nullptr where there is none. O(log size).
    const char* find(std::string_view text) const;

  private:
    std::string_view entry(std::size_t table, std::size_t i) const;
    std::size_t number(std::size_t at) const;

    std::span<const unsigned char> bytes_;
    std::size_t n_ = 0, texts_ = 0, translations_ = 0;
};

/// en.po: English names of shipped brushes, inks, pigments and materials.
const Catalogue& english_catalogue();
/// zh_CN.po
const Catalogue& chinese_catalogue();

/// Returns the English name of a shipped brush, ink, pigment or material; nullptr for another name.
const char* english_name(const char* name);
/// Returns the Chinese translation of an interface text; nullptr where there is none.
const char* chinese_text(const char* english);
/// Returns the Chinese translation of a title or text of the manual (context "manual"); the English one where there is
/// none.
const char* chinese_manual_text(const char* english);
/// Returns all Chinese texts in a row, for the glyphs of the font.
std::string all_chinese_text();

}  // namespace tuft::app
