#include "app/widgets/titles.h"

#include <cstring>
#include <string_view>

namespace tuft::app {
namespace {

bool is_number(std::string_view text) {
    return !text.empty() && text.find_first_not_of("0123456789") == text.npos;
}

}  // namespace

std::string numbered_title(const Ui& ui, const std::string& name, const char* word) {
    const std::string given = std::string(word) + " ";
    const bool numbered = name.starts_with(given) && is_number(std::string_view(name).substr(given.size()));
    return numbered ? std::string(ui.tr(word)) + " " + name.substr(given.size()) : name;
}

std::string layer_title(const Ui& ui, const std::string& name) {
    // "NAME copy" and "NAME copy N", as `duplicate` and stroke::free_name make them.
    constexpr std::string_view kCopy = " copy";
    if (const std::size_t at = name.rfind(kCopy); at != std::string::npos && at > 0) {
        const std::string number = name.substr(at + kCopy.size());
        if (number.empty() || (number[0] == ' ' && is_number(std::string_view(number).substr(1))))
            return layer_title(ui, name.substr(0, at)) + " " + ui.tr("copy") + number;
    }
    return numbered_title(ui, name, "Layer");
}

std::string mask_title(const Ui& ui, const std::string& name) {
    for (const char* with : {" +", " \xc3\x97"})  // as paint's change_masks names two that are joined
        if (name.ends_with(with)) return mask_title(ui, name.substr(0, name.size() - std::strlen(with))) + with;
    return numbered_title(ui, name, "Mask");
}

}  // namespace tuft::app
