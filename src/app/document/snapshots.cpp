#include "app/document/snapshots.h"

#include <nlohmann/json.hpp>

namespace tuft::app {

SnapshotLine line_of(const io::Attachment& a) {
    SnapshotLine line{.id = a.name, .name = a.name};
    try {
        const nlohmann::json j = nlohmann::json::parse(a.about);
        line.name = j.value("name", line.name);
        line.made = j.value("made", std::int64_t{0});
        line.strokes = j.value("strokes", std::size_t{0});
    } catch (const nlohmann::json::exception&) {
        // It is listed by its number.
    }
    return line;
}

std::string about_text(const SnapshotLine& line) {
    return nlohmann::json{{"name", line.name}, {"made", line.made}, {"strokes", line.strokes}}.dump();
}

}  // namespace tuft::app
