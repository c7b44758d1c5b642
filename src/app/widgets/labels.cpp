#include "app/widgets/labels.h"

#include <map>
#include <set>
#include <sstream>

namespace tuft::app {
namespace {

bool is_inside_character(char c) {
    return (static_cast<unsigned char>(c) & 0xc0) == 0x80;
}

// As much of the beginning as fits, with "..." and `tail` after it.
std::string beginning(const std::string& text, const LabelSpace& room, const std::string& tail = "") {
    if (tail.empty() && room.width_of(text) <= room.width) return text;
    std::size_t end = text.size();
    while (end > 0 && room.width_of(text.substr(0, end) + "..." + tail) > room.width) {
        do --end;
        while (end > 0 && is_inside_character(text[end]));
    }
    return text.substr(0, end) + "..." + tail;
}

// As much of the end as fits, whole words where there are some.
std::string ending(const std::string& text, const LabelSpace& room) {
    std::size_t begin = 0;
    while (begin < text.size() && room.width_of("..." + text.substr(begin)) > room.width) {
        do ++begin;
        while (begin < text.size() && is_inside_character(text[begin]));
    }
    const std::size_t word = begin == 0 ? 0 : text.find(' ', begin - 1);
    return "..." + text.substr(word == text.npos ? begin : begin == 0 ? 0 : word + 1);
}

// Words in lines, each as long as it can be; what is left goes into the last line.
std::vector<std::string> broken(const std::string& name, const LabelSpace& room) {
    std::vector<std::string> lines;
    std::istringstream words(name);
    for (std::string word; words >> word;) {
        const bool fits = !lines.empty() && room.width_of(lines.back() + " " + word) <= room.width;
        if (!lines.empty() && (fits || lines.size() == room.lines))
            lines.back() += " " + word;
        else
            lines.push_back(word);
    }
    if (lines.empty()) lines.emplace_back();
    return lines;
}

std::string joined(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines) text += (text.empty() ? "" : "\n") + line;
    return text;
}

// `shorten` is done to the last line, and to each that is too wide.
template <class Shorten>
std::string label(const std::string& name, const LabelSpace& room, const Shorten& shorten) {
    std::vector<std::string> lines = broken(name, room);
    for (std::size_t i = 0; i < lines.size(); ++i)
        lines[i] = i + 1 == lines.size() ? shorten(lines[i]) : beginning(lines[i], room);
    return joined(lines);
}

}  // namespace

std::vector<std::string> make_distinct(const std::vector<std::string>& names, const LabelSpace& room) {
    std::vector<std::string> labels;
    std::map<std::string, std::set<std::string>> names_of;
    for (const std::string& name : names) {
        labels.push_back(label(name, room, [&](const std::string& line) { return beginning(line, room); }));
        names_of[labels.back()].insert(name);
    }
    std::map<std::string, std::string> label_of;  // by name
    std::set<std::string> taken;
    for (const auto& [text, same] : names_of)
        if (same.size() == 1) taken.insert(text), label_of[*same.begin()] = text;
    for (const auto& [text, same] : names_of) {
        if (same.size() == 1) continue;
        for (const std::string& name : same) {
            std::string other = label(name, room, [&](const std::string& line) {
                return room.width_of(line) <= room.width ? line : ending(line, room);
            });
            for (int n = 1; taken.contains(other); ++n)
                other = label(name, room,
                              [&](const std::string& line) { return beginning(line, room, std::to_string(n)); });
            taken.insert(other);
            label_of[name] = other;
        }
    }
    for (std::size_t i = 0; i < names.size(); ++i) labels[i] = label_of[names[i]];
    return labels;
}

std::string lines_of(const std::vector<std::string>& texts, float width,
                     const std::function<float(const std::string&)>& width_of) {
    std::string all, line;
    for (const std::string& text : texts) {
        std::string longer = line + text;
        const std::size_t end = longer.find_last_not_of(' ') + 1;
        if (!line.empty() && width_of(longer.substr(0, end)) > width) {
            line.resize(line.find_last_not_of(' ') + 1);
            all += line + '\n';
            longer = text;
        }
        line = std::move(longer);
    }
    return all + line;
}

}  // namespace tuft::app
