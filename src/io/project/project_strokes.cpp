#include <SQLiteCpp/SQLiteCpp.h>

#include <array>
#include <cstring>
#include <utility>

#include "io/project/project_db.h"
#include "io/project/sample_columns.h"
#include "stroke/journal/entry/entry_json.h"

namespace tuft::io {
namespace {

constexpr std::size_t kMostWord = 4096, kMostLabel = std::size_t{1} << 20,
                      kMostSettings = std::size_t{1} << 25;      // bytes
constexpr std::uintmax_t kLookEvery = std::uintmax_t{64} << 20;  // bytes of samples between two looks at what is free
constexpr Packing kSamples{.element = 8, .lag = 1, .level = 6};

std::vector<double> columns_of(const std::vector<stroke::StrokeSample>& samples) {
    const std::size_t n = samples.size();
    std::vector<double> out((has_roll(samples) ? kRolledColumns : kSampleColumns) * n);
    for (std::size_t i = 0; i < n; ++i) put_sample(samples[i], out, n, i);
    return out;
}

std::vector<stroke::StrokeSample> samples_of(const std::vector<double>& columns, std::size_t n) {
    std::vector<stroke::StrokeSample> samples(n);
    for (std::size_t i = 0; i < n; ++i) samples[i] = get_sample(columns, n, i);
    return samples;
}

std::array<double, 9> numbers_of(const stroke::Placement& p) {
    return {p.origin.x, p.origin.y, p.origin.z, p.right.x, p.right.y, p.right.z, p.down.x, p.down.y, p.down.z};
}

// Versions that do not know what the entry says must not read it as something else.
void raise_format_for(SQLite::Database& db, const stroke::JournalEntry& entry) {
    const stroke::StrokeSamples& t = stroke::samples_of(entry);
    const stroke::PaintStroke* stroke = entry.as<stroke::PaintStroke>();
    if (stroke::keeps_texels(stroke::kind_of(entry)) || entry.as<stroke::Fill>() || stroke::mask_of(entry) != 0 ||
        stroke::layer_of(entry) != stroke::kFirstLayer || (stroke && stroke->erases()))
        raise_format(db, kLayersFormat);
    if (stroke::on_palette(entry) || entry.as<stroke::WashPalette>()) raise_format(db, kPaletteFormat);
    if (t.flat && t.placement.mapping == stroke::SurfaceMapping::drape) raise_format(db, kDrapedFormat);
    if (!t.stencil.empty()) raise_format(db, kStencilFormat);
    if (has_roll(t.samples) || (stroke && (stroke->settings.roll != 0 || stroke->settings.roll_follow)))
        raise_format(db, kRolledFormat);
    if (entry.as<stroke::PartEdit>()) raise_format(db, kPartsFormat);
    const stroke::Fill* fill = entry.as<stroke::Fill>();
    const stroke::MaskEdit* mask = entry.as<stroke::MaskEdit>();
    if ((fill && fill->area &&
         (fill->area->edges != stroke::AreaEdges::facing || fill->area->gradient == stroke::AreaGradient::image)) ||
        (mask && mask->mask.kind == stroke::MaskKind::clear))
        raise_format(db, kEdgesFormat);
    if (fill && fill->area && !fill->area->under.empty()) raise_format(db, kUnderFormat);
}

}  // namespace

void store_strokes(SQLite::Database& db, const std::filesystem::path& path,
                   std::span<const stroke::JournalEntry> entries) {
    SQLite::Statement insert(db,
                             "INSERT INTO strokes(id, brush, ink, seed, label, settings, hidden, flat, "
                             "laying, placement, sample_count, samples) VALUES(?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    for (const stroke::JournalEntry& entry : entries) {
        const stroke::StrokeSamples& t = stroke::samples_of(entry);
        const std::vector<double> columns = columns_of(t.samples);
        const std::array<double, 9> placement = numbers_of(t.placement);
        try {
            stroke::check_samples(t);
        } catch (const Error& error) {
            throw Error(path.string(), Message("stroke {} is not stored: {}", entry.id, error.message()));
        }
        const std::vector<char> blob = pack(columns.data(), columns.size(), kSamples);
        insert.bind(1, static_cast<std::int64_t>(entry.id));
        insert.bind(2, stroke::brush_of(entry));
        insert.bind(3, stroke::ink_of(entry));
        insert.bind(4, static_cast<std::int64_t>(stroke::seed_of(entry)));
        insert.bind(5, entry.label);
        insert.bind(6, stroke::entry_json(entry));
        insert.bind(7, entry.hidden ? 1 : 0);
        insert.bind(8, t.flat ? 1 : 0);
        insert.bind(9, std::string(stroke::surface_mapping_name(t.placement.mapping)));
        insert.bind(10, placement.data(), static_cast<int>(sizeof placement));
        insert.bind(11, static_cast<std::int64_t>(t.samples.size()));
        insert.bind(12, blob.data(), static_cast<int>(blob.size()));
        insert.exec();
        insert.reset();
        raise_format_for(db, entry);
    }
}

namespace {

/// Where a stroke of the table lies on the model.
stroke::Placement placement_of(const SQLite::Column& mapping_word, const SQLite::Column& numbers, const Message& what,
                               const std::filesystem::path& path) {
    stroke::Placement placement;
    const auto mapping =
        stroke::surface_mapping_named(text_of(mapping_word, kMostWord, path, "the mapping of a stroke"));
    if (!mapping) throw Error(Message("{} is mapped onto the model in a way that is not known", what));
    placement.mapping = *mapping;
    std::array<double, 9> p{};
    if (numbers.getBytes() != static_cast<int>(sizeof p)) throw Error(Message("{} has no valid placement", what));
    std::memcpy(p.data(), numbers.getBlob(), sizeof p);
    placement.origin = {p[0], p[1], p[2]};
    placement.right = {p[3], p[4], p[5]};
    placement.down = {p[6], p[7], p[8]};
    return placement;
}

/// Unpacks the samples of the strokes of a table, and looks at the free memory from time to time.
class SampleReader {
  public:
    explicit SampleReader(const std::filesystem::path& path) : path_(path) {}

    std::vector<stroke::StrokeSample> read(std::int64_t count, const SQLite::Column& blob, const Message& what) {
        if (count < 0 || count > kMaxSamples) throw Error(Message("{} has an impossible number of samples", what));
        const auto size = static_cast<std::size_t>(blob.getBytes());
        const auto n_samples = static_cast<std::size_t>(count);
        const bool rolled = packed_bytes(blob.getBlob(), size) > kSampleColumns * n_samples * sizeof(double);
        const std::size_t numbers = (rolled ? kRolledColumns : kSampleColumns) * n_samples;
        check_packed(blob.getBlob(), size, numbers * sizeof(double), what);
        // Its columns, and them as they are unpacked, go again.
        bytes_ += sizeof(stroke::StrokeSample) * static_cast<std::uintmax_t>(count);
        if (const auto now = 3 * numbers * sizeof(double); bytes_ - checked_ + now > kLookEvery)
            check_memory(path_, bytes_ - std::exchange(checked_, bytes_) + now);
        std::vector<double> fields(numbers);
        unpack(blob.getBlob(), size, fields.data(), numbers, kSamples, what);
        return samples_of(fields, n_samples);
    }

  private:
    const std::filesystem::path& path_;
    std::uintmax_t bytes_ = 0, checked_ = 0;  // of all samples; of those that memory was looked at for
};

}  // namespace

std::vector<stroke::JournalEntry> load_strokes(SQLite::Database& db, const std::filesystem::path& path,
                                               const ProgressFn& progress) {
    const std::int64_t n = db.execAndGet("SELECT count(*) FROM strokes").getInt64();
    if (n > kMaxEntries) damaged(path, Message("it has {} strokes, more than the {} that are read", n, kMaxEntries));
    check_memory(path, static_cast<std::uintmax_t>(n) * sizeof(stroke::JournalEntry));
    SQLite::Statement select(db,
                             "SELECT id, brush, ink, seed, label, settings, hidden, flat, laying, placement, "
                             "sample_count, samples FROM strokes ORDER BY ordinal");
    std::vector<stroke::JournalEntry> entries;
    SampleReader samples(path);
    while (select.executeStep()) {
        report(progress, "reading", 0);
        stroke::EntryColumns columns;
        stroke::StrokeSamples& t = columns.trace;
        columns.id = static_cast<std::uint64_t>(select.getColumn(0).getInt64());
        const Message what("{}: the project is damaged: stroke {}", path.string(), columns.id);
        const auto text = [&](int column, std::size_t most, const char* of_what) {
            return text_of(select.getColumn(column), most, path, of_what);
        };
        columns.brush = text(1, kMostWord, "the brush of a stroke");
        columns.ink = text(2, kMostWord, "the ink of a stroke");
        columns.seed = static_cast<std::uint64_t>(select.getColumn(3).getInt64());
        columns.label = text(4, kMostLabel, "the label of a stroke");
        const std::string json = text(5, kMostSettings, "the settings of a stroke");
        columns.hidden = select.getColumn(6).getInt() != 0;
        t.flat = select.getColumn(7).getInt() != 0;
        t.placement = placement_of(select.getColumn(8), select.getColumn(9), what, path);
        t.samples = samples.read(select.getColumn(10).getInt64(), select.getColumn(11), what);
        stroke::JournalEntry entry = stroke::entry_of(std::move(columns), json);
        try {
            stroke::check_samples(stroke::samples_of(entry));
        } catch (const Error& error) {
            throw Error(Message("{}: {}", what, error.message()));
        }
        entries.push_back(std::move(entry));
    }
    return entries;
}

}  // namespace tuft::io
