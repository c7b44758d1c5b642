#include "stroke/journal/entry/brush_action.h"

#include <cmath>
#include <type_traits>

#include "core/error.h"
#include "ink/exchange/reservoir.h"

namespace tuft::stroke {

namespace {

/// Calls `number(name, value, usual)` for each number of a change, const or not.
template <class Change, class Number>
void for_each_number(Change& change, Number number) {
    std::visit(
        [&](auto& kind) {
            using Kind = std::remove_cvref_t<decltype(kind)>;
            if constexpr (requires { kind.depth; }) {
                number("depth", kind.depth, Kind{}.depth);
                number("amount", kind.amount, Kind{}.amount);
                number("side", kind.side, Kind{}.side);
            }
            if constexpr (requires { kind.time; }) number("time", kind.time, Kind{}.time);
        },
        change);
}

}  // namespace

std::vector<ChangeNumber> numbers_of(const BrushChange& change) {
    std::vector<ChangeNumber> numbers;
    for_each_number(change, [&](const char* name, double value, double usual) {
        numbers.push_back({name, value, usual});
    });
    return numbers;
}

bool set_number(BrushChange& change, std::string_view name, double value) {
    bool found = false;
    for_each_number(change, [&](const char* own, double& number, double) {
        if (name == own) number = value, found = true;
    });
    return found;
}

void check_change(const BrushChange& change) {
    const double most = std::holds_alternative<Dip>(change) ? ink::kMostLevel : 1.0;
    for_each_number(change, [&](const std::string_view name, double value, double) {
        if (name == "depth" && !(value >= 0 && value <= 1))
            throw Error("the depth of a dip or wipe is a part of the tuft, 0 to 1");
        if (name == "amount" && !(value >= 0 && value <= most))
            throw Error("the amount of a wipe is 0 to 1, of a dip 0 to 1.5, above 1 dripping wet");
        if (name == "side" && !(std::abs(value) <= 1))
            throw Error("the side of a dip or wipe is a part of the tuft's width, -1 to 1");
        if (name == "time" && !(value >= 0 && value <= kLongestWait))
            throw Error(Message("a dip takes 0 to {} seconds in the dish", static_cast<int>(kLongestWait)));
    });
}

}  // namespace tuft::stroke
