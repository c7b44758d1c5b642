#include "stroke/journal/recorded_stroke.h"

#include <charconv>

#include "core/error.h"
#include "core/overloaded.h"

namespace tuft::stroke {

EntryKind kind_of(const Preparation& preparation) {
    return std::visit([](const auto& content) { return kind_of(EntryContent(content)); }, preparation);
}

std::string preparation_text(const Preparation& preparation) {
    std::string text = name_of(kind_of(preparation));
    const BrushAction* action = std::get_if<BrushAction>(&preparation);
    if (!action) return text;
    if (!action->ink.empty()) text += ":" + action->ink;
    for (const ChangeNumber& n : numbers_of(action->what)) {
        if (n.value == n.usual) continue;
        char number[40];
        *std::to_chars(number, number + sizeof number - 1, n.value).ptr = 0;
        text += std::string(",") + n.name + "=" + number;
    }
    return text;
}

namespace {

Preparation preparation_named(EntryKind kind, const std::string& text) {
    if (kind == EntryKind::dry) return Dry{};
    if (kind == EntryKind::wash) return WashPalette{};
    if (kind == EntryKind::fill) return Fill{};
    if (kind == EntryKind::stroke || keeps_texels(kind)) throw Error(Message("'{}' is no brush action", text));
    return BrushAction{.what = change_of(kind)};
}

}  // namespace

Preparation preparation_of(const std::string& text) {
    std::size_t end = std::min(text.find(','), text.size());
    const std::string head = text.substr(0, end);
    const std::size_t colon = std::min(head.find(':'), head.size());
    Preparation preparation = preparation_named(entry_kind_of(head.substr(0, colon)), text);
    BrushAction* action = std::get_if<BrushAction>(&preparation);
    const bool dips = action && std::holds_alternative<Dip>(action->what);
    if (colon + 1 < head.size() && !dips) throw Error(Message("'{}': only a dip names an ink", text));
    if (colon < head.size() && dips) action->ink = head.substr(colon + 1);
    while (end < text.size()) {
        const std::size_t next = std::min(text.find(',', end + 1), text.size());
        const std::string part = text.substr(end + 1, next - end - 1);
        const std::size_t equal = part.find('=');
        const std::string name = part.substr(0, std::min(equal, part.size()));
        double value = 0;
        if (!action || equal == std::string::npos || !set_number(action->what, name, value))
            throw Error(
                Message("'{}' in '{}' is none of depth=PART, amount=PART and side=PART of a dip or wipe, or "
                        "time=SECONDS of a dip",
                        part, text));
        const char* last = part.data() + part.size();
        const auto [rest, error] = std::from_chars(part.data() + equal + 1, last, value);
        if (error != std::errc{} || rest != last) throw Error(Message("'{}' in '{}' is no number", part, text));
        set_number(action->what, name, value);
        end = next;
    }
    if (action) check_change(action->what);
    return preparation;
}

}  // namespace tuft::stroke
