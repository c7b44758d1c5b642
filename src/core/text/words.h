#pragma once

#include <string_view>
#include <vector>

/// \file
/// Words of a text that a person typed. Called by `writer`.
namespace tuft {

/// Returns the parts of a text between spaces, tabs, line ends and commas; views of it.
inline std::vector<std::string_view> split_words(std::string_view text) {
    constexpr std::string_view kBetween = " ,\t\n";
    std::vector<std::string_view> words;
    for (std::size_t at = text.find_first_not_of(kBetween); at != std::string_view::npos;
         at = text.find_first_not_of(kBetween, at)) {
        words.push_back(text.substr(at, text.find_first_of(kBetween, at) - at));
        at += words.back().size();
    }
    return words;
}

}  // namespace tuft
