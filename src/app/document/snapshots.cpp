#include "app/document/snapshots.h"

#include <nlohmann/json.hpp>

namespace tuft::app {

SnapshotLine line_of(const io::Attachment& a) {
    SnapshotLine line{.id = a.name, .name = a.name};
    try {
        const nlohmann::json j = nlohmann::json::parse(a.about);
        line.name = j.value("name", line.name);
        // Nothing but whole numbers: the conversion from 1e300 is undefined.
        if (const auto at = j.find("made"); at != j.end() && at->is_number_integer())
            line.made = at->get<std::int64_t>();
        if (const auto at = j.find("strokes"); at != j.end() && at->is_number_unsigned())
            line.strokes = at->get<std::size_t>();
    } catch (const nlohmann::json::exception&) {
        // It is listed by its number.
    }
    return line;
}

std::string about_text(const SnapshotLine& line) {
    return nlohmann::json{{"name", line.name}, {"made", line.made}, {"strokes", line.strokes}}.dump();
}

}  // namespace tuft::app
