#include "app/text/texts.h"

#include <cassert>

namespace tuft::app {

// Of the generated source.
std::span<const unsigned char> catalogue_en();
std::span<const unsigned char> catalogue_zh_CN();

std::size_t Catalogue::number(std::size_t at) const {
    assert(at + 4 <= bytes_.size());
    return std::size_t{bytes_[at]} | std::size_t{bytes_[at + 1]} << 8 | std::size_t{bytes_[at + 2]} << 16 |
           std::size_t{bytes_[at + 3]} << 24;
}

Catalogue::Catalogue(std::span<const unsigned char> mo) : bytes_(mo) {
    assert(number(0) == 0x950412de && "msgfmt --endianness=little");
    n_ = number(8);
    texts_ = number(12);
    translations_ = number(16);
}

/// Each table has length and place of its strings, which end with a zero.
std::string_view Catalogue::entry(std::size_t table, std::size_t i) const {
    const std::size_t length = number(table + 8 * i), at = number(table + 8 * i + 4);
    assert(i < n_ && at + length < bytes_.size());
    return {reinterpret_cast<const char*>(bytes_.data() + at), length};
}

std::string_view Catalogue::text(std::size_t i) const {
    return entry(texts_, i);
}

const char* Catalogue::translation(std::size_t i) const {
    return entry(translations_, i).data();
}

const char* Catalogue::find(std::string_view wanted) const {
    if (wanted.empty()) return nullptr;  // of which the catalogue's header is the translation
    std::size_t low = 0, high = n_;
    while (low < high) {
        const std::size_t middle = (low + high) / 2;
        if (text(middle) < wanted)
            low = middle + 1;
        else
            high = middle;
    }
    return low < n_ && text(low) == wanted ? translation(low) : nullptr;
}

const Catalogue& english_catalogue() {
    static const Catalogue catalogue(catalogue_en());
    return catalogue;
}

const Catalogue& chinese_catalogue() {
    static const Catalogue catalogue(catalogue_zh_CN());
    return catalogue;
}

const char* english_name(const char* name) {
    return english_catalogue().find(name);
}

const char* chinese_text(const char* english) {
    return chinese_catalogue().find(english);
}

const char* chinese_manual_text(const char* english) {
    const char* text = chinese_catalogue().find(std::string("manual\4") + english);
    return text ? text : english;
}

std::string all_chinese_text() {
    std::string all;
    for (std::size_t i = 0; i < chinese_catalogue().size(); ++i) all += chinese_catalogue().translation(i);
    return all;
}

}  // namespace tuft::app
