#include "io/project/attachments.h"

#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "io/project/project_db.h"
#include "io/project/sample_columns.h"
#include "io/scene/json_number.h"
#include "stroke/journal/entry/entry_json.h"

namespace tuft::io {
namespace {

constexpr Packing kTextPacking{.element = 1, .lag = 1, .level = 6}, kNumberPacking{.element = 8, .lag = 1, .level = 6};
constexpr std::size_t kMostEntryText = std::size_t{1} << 28, kMostNumbers = std::size_t{1} << 28;

constexpr char kRolledMark = '2';

// At the head of the bytes: sizes of what follows.
struct SnapshotHead {
    char magic[8] = {'T', 'U', 'F', 'T', 'S', 'N', 'A', '1'};  ///< '2' at its end: with a column of rolls
    std::uint64_t text = 0;                                    ///< bytes of the entries' JSON
    std::uint64_t packed_text = 0;                             ///< bytes that it is packed into, which follow
    std::uint64_t numbers = 0;                                 ///< of all samples; packed, they fill the rest
};

nlohmann::json snapshot_json(const stroke::JournalEntry& entry) {
    const stroke::StrokeSamples& t = stroke::samples_of(entry);
    const stroke::Placement& p = t.placement;
    return {{"id", entry.id},
            {"brush", stroke::brush_of(entry)},
            {"ink", stroke::ink_of(entry)},
            {"seed", stroke::seed_of(entry)},
            {"label", entry.label},
            {"hidden", entry.hidden},
            {"flat", t.flat},
            {"laying", std::string(stroke::surface_mapping_name(p.mapping))},
            {"placement",
             {p.origin.x, p.origin.y, p.origin.z, p.right.x, p.right.y, p.right.z, p.down.x, p.down.y, p.down.z}},
            {"samples", t.samples.size()},
            {"entry", stroke::entry_json(entry)}};
}

stroke::EntryColumns columns_of(const nlohmann::json& j) {
    stroke::EntryColumns columns{.id = whole_number<std::uint64_t>(j.at("id")),
                                 .hidden = j.at("hidden").get<bool>(),
                                 .brush = j.at("brush").get<std::string>(),
                                 .ink = j.at("ink").get<std::string>(),
                                 .label = j.at("label").get<std::string>(),
                                 .seed = whole_number<std::uint64_t>(j.at("seed")),
                                 .trace = {.flat = j.at("flat").get<bool>()}};
    const auto mapping = stroke::surface_mapping_named(j.at("laying").get<std::string>());
    const auto p = j.at("placement").get<std::array<double, 9>>();
    if (!mapping || !std::all_of(p.begin(), p.end(), [](double x) { return std::isfinite(x); }))
        throw Error("its place on the model cannot be read");
    columns.trace.placement = {
        .origin = {p[0], p[1], p[2]}, .right = {p[3], p[4], p[5]}, .down = {p[6], p[7], p[8]}, .mapping = *mapping};
    return columns;
}

void append(std::vector<char>& out, const void* data, std::size_t bytes) {
    const auto* first = static_cast<const char*>(data);
    out.insert(out.end(), first, first + bytes);
}

}  // namespace

std::vector<char> pack_entries(std::span<const stroke::JournalEntry> entries) {
    nlohmann::json all = nlohmann::json::array();
    std::vector<double> numbers;
    std::size_t n = 0;
    bool rolled = false;
    for (const stroke::JournalEntry& s : entries) {
        all.push_back(snapshot_json(s));
        n += stroke::samples_of(s).samples.size();
        rolled = rolled || has_roll(stroke::samples_of(s).samples);
    }
    numbers.resize((rolled ? kRolledColumns : kSampleColumns) * n);
    std::size_t i = 0;
    for (const stroke::JournalEntry& s : entries)
        for (const stroke::StrokeSample& t : stroke::samples_of(s).samples) put_sample(t, numbers, n, i++);
    // Labels of files may be no readable text.
    const std::string text = all.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
    const std::vector<char> packed_text = pack(text.data(), text.size(), kTextPacking),
                            packed = pack(numbers.data(), numbers.size(), kNumberPacking);
    SnapshotHead head;
    if (rolled) head.magic[7] = kRolledMark;
    head.text = text.size();
    head.packed_text = packed_text.size();
    head.numbers = numbers.size();
    std::vector<char> out;
    append(out, &head, sizeof head);
    append(out, packed_text.data(), packed_text.size());
    append(out, packed.data(), packed.size());
    return out;
}

std::vector<stroke::JournalEntry> unpack_entries(std::span<const char> bytes, const Message& what) {
    SnapshotHead head, expected;
    if (bytes.size() < sizeof head) throw Error(Message("{} is damaged: it ends too soon", what));
    std::memcpy(&head, bytes.data(), sizeof head);
    const std::size_t rest = bytes.size() - sizeof head;
    const bool rolled = head.magic[7] == kRolledMark;
    if (rolled) expected.magic[7] = kRolledMark;
    const std::size_t columns_per_sample = rolled ? kRolledColumns : kSampleColumns;
    if (std::memcmp(head.magic, expected.magic, sizeof head.magic) != 0 || head.packed_text > rest ||
        head.text > kMostEntryText || head.numbers > kMostNumbers || head.numbers % columns_per_sample != 0)
        throw Error(Message("{} is damaged: its head makes no sense", what));
    const char *text_blob = bytes.data() + sizeof head, *blob = text_blob + head.packed_text;
    check_packed(text_blob, head.packed_text, head.text, what);
    check_packed(blob, rest - head.packed_text, head.numbers * sizeof(double), what);
    std::string text(head.text, '\0');
    std::vector<double> numbers(head.numbers);
    unpack(text_blob, head.packed_text, text.data(), text.size(), kTextPacking, what);
    unpack(blob, rest - head.packed_text, numbers.data(), numbers.size(), kNumberPacking, what);
    if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        throw Error(Message("{} has numbers that are not finite", what));
    const std::size_t n = numbers.size() / columns_per_sample;
    std::vector<stroke::JournalEntry> entries;
    std::size_t at = 0;
    try {
        for (const nlohmann::json& j : nlohmann::json::parse(text)) {
            stroke::EntryColumns columns = columns_of(j);
            const auto count = whole_number<std::size_t>(j.at("samples"));
            if (count > n - at) throw Error("it has more samples than are stored");
            for (std::size_t k = 0; k < count; ++k, ++at) columns.trace.samples.push_back(get_sample(numbers, n, at));
            entries.push_back(stroke::entry_of(std::move(columns), j.at("entry").get<std::string>()));
        }
    } catch (const nlohmann::json::exception&) {
        throw Error(Message("{} is damaged: an entry cannot be read", what));
    } catch (const Error& error) {
        throw Error(Message("{} is damaged: {}", what, error.message()));
    }
    return entries;
}

void store_attachment(SQLite::Database& db, const std::string& kind, const Attachment& a) {
    remove_attachment(db, kind, a.name);
    SQLite::Statement insert(db, "INSERT INTO presets(kind, name, toml) VALUES(?, ?, ?)");
    insert.bind(1, kind);
    insert.bind(2, a.name);
    insert.bind(3, std::to_string(a.bytes.size()) + "\n" + a.about);
    insert.exec();
    put_array_bytes(db, {kind.c_str(), a.name.c_str()}, a.bytes.data(), {a.bytes.size(), 1},
                    {.element = 1, .lag = 1, .level = 1});
}

void remove_attachment(SQLite::Database& db, const std::string& kind, const std::string& name) {
    for (const char* sql :
         {"DELETE FROM presets WHERE kind = ? AND name = ?", "DELETE FROM arrays WHERE owner = ? AND name = ?"}) {
        SQLite::Statement s(db, sql);
        s.bind(1, kind);
        s.bind(2, name);
        s.exec();
    }
}

std::vector<Attachment> load_attachments(SQLite::Database& db, const std::filesystem::path& path,
                                         const std::string& kind) {
    std::vector<Attachment> found;
    SQLite::Statement select(db, "SELECT name, toml FROM presets WHERE kind = ? ORDER BY name LIMIT ?");
    select.bind(1, kind);
    select.bind(2, static_cast<int>(kMostAttachments));
    while (select.executeStep()) {
        const std::string about = select.getColumn(1).getString();
        const std::size_t line = about.find('\n');
        const std::uint64_t bytes = std::strtoull(about.c_str(), nullptr, 10);
        if (line == std::string::npos || about.size() > kMostAbout || bytes > kMostAttachmentBytes)
            damaged(path, Message("what is said of a {} cannot be read", kind));
        Attachment& a = found.emplace_back(Attachment{select.getColumn(0).getString(), about.substr(line + 1)});
        a.bytes = get_array<char>(db, path, kind.c_str(), a.name.c_str(), {.element = 1, .lag = 1, .level = 1}, bytes);
        if (a.bytes.size() != bytes) damaged(path, Message("a {} is not there", kind));
    }
    return found;
}

}  // namespace tuft::io
