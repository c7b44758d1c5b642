#include "core/message.h"

#include <fmt/args.h>
#include <fmt/format.h>

namespace tuft {

std::string Message::text() const {
    return text([](const char*) { return nullptr; });
}

std::string Message::text(const Translate& translate) const {
    if (!translated_) return words_;
    const char* other = translate(words_.c_str());
    const std::string_view words = other ? std::string_view(other) : std::string_view(words_);
    if (arguments_.empty()) return std::string(words);
    fmt::dynamic_format_arg_store<fmt::format_context> store;
    for (const Message& argument : arguments_) store.push_back(argument.text(translate));
    return fmt::vformat(fmt::string_view(words.data(), words.size()), store);
}

Message join(std::span<const Message> messages) {
    Message all;
    for (const Message& message : messages) all = all.empty() ? message : Message("{}; {}", all, message);
    return all;
}

std::vector<std::string> texts(std::span<const Message> messages) {
    std::vector<std::string> all;
    for (const Message& message : messages) all.push_back(message.text());
    return all;
}

}  // namespace tuft
