#include "core/text/text.h"

#include <cstdint>

namespace tuft {
namespace {

/// Bytes of the character at `at`; 0 where there is none (The Unicode Standard 15, table 3-7).
std::size_t utf8_length(std::string_view text, std::size_t at) {
    const auto byte = [&](std::size_t i) { return static_cast<std::uint8_t>(text[at + i]); };
    const std::uint8_t first = byte(0);
    if (first < 0x80) return 1;
    const std::size_t n = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4 || at + n > text.size()) return 0;
    const std::uint8_t low = first == 0xe0 ? 0xa0 : first == 0xf0 ? 0x90 : 0x80;
    const std::uint8_t high = first == 0xed ? 0x9f : first == 0xf4 ? 0x8f : 0xbf;
    if (byte(1) < low || byte(1) > high) return 0;
    for (std::size_t i = 2; i < n; ++i)
        if ((byte(i) & 0xc0) != 0x80) return 0;
    return n;
}

}  // namespace

bool is_utf8(std::string_view text) {
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t n = utf8_length(text, at);
        if (n == 0) return false;
        at += n;
    }
    return true;
}

std::string to_utf8(std::string_view text) {
    if (is_utf8(text)) return std::string(text);
    std::string out;
    for (const char c : text) {
        const auto byte = static_cast<std::uint8_t>(c);
        if (byte < 0x80) {
            out += c;
        } else {
            out += static_cast<char>(0xc0 | byte >> 6);
            out += static_cast<char>(0x80 | (byte & 0x3f));
        }
    }
    return out;
}

std::string excerpt(std::string_view text, std::size_t most) {
    std::string_view head = text.substr(0, most + 4);
    // A character that the cut went through does not make the whole another encoding.
    for (int i = 0; i < 3 && head.size() < text.size() && !head.empty() && !is_utf8(head); ++i) head.remove_suffix(1);
    const std::string whole = to_utf8(is_utf8(head) ? head : text.substr(0, most + 4));
    std::string out;
    for (std::size_t at = 0; at < whole.size();) {
        const std::size_t n = utf8_length(whole, at);
        if (out.size() + n > most) return out + "...";
        const auto byte = static_cast<std::uint8_t>(whole[at]);
        if (byte < 0x20 || byte == 0x7f)
            out += '?';
        else
            out.append(whole, at, n);
        at += n;
    }
    return head.size() < text.size() ? out + "..." : out;
}

std::u32string utf32_of(std::string_view text) {
    const std::string utf8 = to_utf8(text);
    std::u32string out;
    for (std::size_t i = 0; i < utf8.size();) {
        const auto lead = static_cast<unsigned char>(utf8[i]);
        const int n = lead < 0x80 ? 1 : lead < 0xE0 ? 2 : lead < 0xF0 ? 3 : 4;
        char32_t code = n == 1 ? lead : lead & (0xFFu >> (n + 1));
        for (int k = 1; k < n; ++k) code = (code << 6) | (static_cast<unsigned char>(utf8[i + k]) & 0x3Fu);
        out.push_back(code);
        i += static_cast<std::size_t>(n);
    }
    return out;
}

std::string utf8_of(char32_t c) {
    std::string out;
    const auto byte = [&](char32_t v) { out.push_back(static_cast<char>(v)); };
    if (c < 0x80) {
        byte(c);
    } else if (c < 0x800) {
        byte(0xC0 | (c >> 6)), byte(0x80 | (c & 0x3F));
    } else if (c < 0x10000) {
        byte(0xE0 | (c >> 12)), byte(0x80 | ((c >> 6) & 0x3F)), byte(0x80 | (c & 0x3F));
    } else {
        byte(0xF0 | (c >> 18)), byte(0x80 | ((c >> 12) & 0x3F)), byte(0x80 | ((c >> 6) & 0x3F)),
            byte(0x80 | (c & 0x3F));
    }
    return out;
}

}  // namespace tuft
