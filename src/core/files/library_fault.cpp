#include "core/files/library_fault.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <span>
#include <string>

#include "core/files/system_message.h"
#include "core/text/text.h"

namespace tuft {
namespace {

constexpr std::size_t kLongest = 160;  // bytes of a library's words in a message

std::string lower_case(std::string_view words) {
    std::string lower(words);
    std::transform(lower.begin(), lower.end(), lower.begin(), [](unsigned char c) { return std::tolower(c); });
    return lower;
}

bool contains_any(const std::string& lower, std::span<const char* const> phrases) {
    return std::any_of(phrases.begin(), phrases.end(),
                       [&](const char* phrase) { return lower.find(phrase) != std::string::npos; });
}

// Of libpng, libjpeg, libtiff, OpenEXR, OpenImageIO, Assimp, nlohmann::json, tinygltf and toml++.
constexpr const char* kEndsEarly[] = {
    "end of file",       "end-of-file",     "end of input",     "end of stream", "end of data", "unexpected eof",
    "premature end",     "truncated",       "read past",        "reading past",  "read error",  "failed to read",
    "too short",         "not enough data", "no more data",     "ran out of",    "early eof",   "out of data",
    "file is too small", "not enough room", "insufficient data"};
constexpr const char* kDiskFull[] = {"no space left", "disk is full", "disk full"};
constexpr const char* kNotPermitted[] = {"permission denied", "access denied", "operation not permitted"};
constexpr const char* kNoMemory[] = {"bad_alloc", "out of memory", "not enough memory", "insufficient memory"};
constexpr const char* kNotSupported[] = {"unsupported",      "not supported",   "not implemented",
                                         "does not support", "unknown version", "version not"};
constexpr const char* kUnknownFormat[] = {"no suitable reader", "unknown file format", "unknown format",
                                          "bad magic",          "magic number",        "wrong signature",
                                          "file signature",     "not an image"};

Message with_detail(const char* kind, std::string_view words) {
    return Message("{} ({})", Message(kind), excerpt(words, kLongest));
}

std::string_view trimmed(std::string_view words) {
    const auto is_space = [](char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; };
    while (!words.empty() && is_space(words.front())) words.remove_prefix(1);
    while (!words.empty() && (is_space(words.back()) || words.back() == '.')) words.remove_suffix(1);
    return words;
}

}  // namespace

Message library_fault(std::string_view words) {
    words = trimmed(words);
    const std::string lower = lower_case(words);
    if (words.empty()) return "it is damaged";
    if (contains_any(lower, kDiskFull)) return system_message(ENOSPC);
    if (contains_any(lower, kNotPermitted)) return system_message(EACCES);
    if (contains_any(lower, kNoMemory)) return "there is not enough memory";
    if (contains_any(lower, kEndsEarly)) return "it ends too early";
    if (contains_any(lower, kNotSupported)) return with_detail("it uses what cannot be read here", words);
    if (contains_any(lower, kUnknownFormat)) return with_detail("its format is unknown", words);
    return with_detail("it is damaged", words);
}

Message toml_fault(std::string_view words) {
    words = trimmed(words);
    const std::string lower = lower_case(words);
    if (contains_any(lower, kEndsEarly)) return "it ends too early";
    if (lower.find("redefine") != std::string::npos) return with_detail("a name is given twice", words);
    if (lower.find("utf-8") != std::string::npos) return "it is no text in UTF-8";
    return with_detail("this is not TOML", words);
}

}  // namespace tuft
