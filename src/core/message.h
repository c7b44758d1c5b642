#pragma once

#include <concepts>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

/// \file
/// Sentences for a person that have a translation. What throws or reports one keeps its words and its arguments apart;
/// the interface that shows it chooses the language.
namespace tuft {

/// English words with places for arguments, or a text that is the same in every language, such as a file's name.
class Message {
  public:
    /// Returns the words in another language, nullptr where it has none.
    using Translate = std::function<const char*(const char* english)>;

    Message() = default;
    /// A text that is the same in every language.
    Message(std::string verbatim) : words_(std::move(verbatim)) {}
    Message(std::string_view verbatim) : words_(verbatim) {}
    /// Words in English. With arguments they are a format of fmt: {} is the next argument, {1} the second. A
    /// translation writes {0}, {1} where its order is another one. An argument is a number, a text or a `Message`.
    template <class... Arguments>
    Message(const char* english, Arguments&&... arguments) : words_(english), translated_(true) {
        (arguments_.push_back(argument(std::forward<Arguments>(arguments))), ...);
    }

    /// The parts of a message that a file keeps.
    Message(std::string words, bool translated, std::vector<Message> arguments)
        : words_(std::move(words)), translated_(translated), arguments_(std::move(arguments)) {}
    const std::string& words() const { return words_; }
    bool translated() const { return translated_; }
    std::span<const Message> arguments() const { return arguments_; }

    bool empty() const { return words_.empty(); }
    /// In English.
    std::string text() const;
    /// In another language; in English where that has no words for it. Its arguments are translated too.
    std::string text(const Translate& translate) const;

    bool operator==(const Message&) const = default;

  private:
    template <class T>
    static Message argument(T&& value) {
        if constexpr (std::same_as<std::remove_cvref_t<T>, char>)
            return Message(std::string(1, value));
        else if constexpr (std::integral<std::remove_cvref_t<T>> || std::floating_point<std::remove_cvref_t<T>>)
            return Message(std::to_string(value));
        else
            return Message(std::forward<T>(value));
    }

    std::string words_;
    bool translated_ = false;
    std::vector<Message> arguments_;
};

/// The messages in a row: "A; B; C".
Message join(std::span<const Message> messages);
/// Each in English, as the command line shows them.
std::vector<std::string> texts(std::span<const Message> messages);

}  // namespace tuft
