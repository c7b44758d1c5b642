#include "stroke/journal.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/error.h"

namespace tuft::stroke {

std::string to_json(const Settings& s) {
    return nlohmann::json{{"spine", s.spine},     {"footprint", s.footprint}, {"contact", s.contact},
                          {"spacing", s.spacing}, {"lead", s.lead}}
        .dump();
}

Settings settings_from_json(const std::string& json) {
    try {
        const auto j = nlohmann::json::parse(json);
        Settings s;
        s.spine = j.value("spine", s.spine);
        s.footprint = j.value("footprint", s.footprint);
        s.contact = j.value("contact", s.contact);
        s.spacing = j.value("spacing", s.spacing);
        s.lead = j.value("lead", s.lead);
        if (!(s.spacing > 0 && s.spacing < 1000)) throw Error("spacing is out of range");
        return s;
    } catch (const nlohmann::json::exception&) {
        throw Error("the settings of a stroke cannot be read: " + json.substr(0, 80));
    }
}

const Stroke& Journal::append(Stroke stroke) {
    stroke.id = next_id_++;
    undone_.clear();
    strokes_.push_back(std::move(stroke));
    return strokes_.back();
}

void Journal::restore(Stroke stroke) {
    next_id_ = std::max(next_id_, stroke.id + 1);
    strokes_.push_back(std::move(stroke));
}

bool Journal::undo() {
    if (strokes_.empty()) return false;
    undone_.push_back(std::move(strokes_.back()));
    strokes_.pop_back();
    return true;
}

bool Journal::redo() {
    if (undone_.empty()) return false;
    strokes_.push_back(std::move(undone_.back()));
    undone_.pop_back();
    return true;
}

}  // namespace tuft::stroke
