#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <bit>
#include <utility>

#include "core/hash.h"
#include "io/project/project_db.h"
#include "stroke/layers/palette.h"

namespace tuft::io {
namespace {

constexpr Packing kTiles{.element = 4, .lag = 1, .level = 1};

// The first layer is where projects without layers have their texels; the others have tables
// that are like it with the layer's id before (project_schema.cpp).
constexpr std::uintmax_t kCheckEvery = std::uintmax_t{128} << 20;  // bytes of texels between two looks at what is free
constexpr std::size_t kMostPigmentText = std::size_t{1} << 20;

/// Projects of format 1 have only the open film.
bool has_films(SQLite::Database& db) {
    return db.tableExists("films");
}
bool has_layers(SQLite::Database& db) {
    return db.tableExists("layer_tiles");
}

/// A pigment as an ink of its own, which has a text form already.
std::string pigment_text(const ink::Pigment& pigment) {
    ink::Ink alone;
    alone.name = pigment.name;
    alone.parts.push_back({pigment, 1.0});
    return ink::ink_toml(alone);
}

/// Rows of one layer, written and read.
class LayerRows {
  public:
    LayerRows(SQLite::Database& db, std::uint32_t layer) : db_(db), layer_(layer) {}

    void store_tile(const ink::TileSnapshot& tile) {
        const std::size_t open = std::popcount(tile.planes) * atlas::kTileTexels;
        SQLite::Statement& s = statement(
            tile_, first() ? "INSERT INTO tiles VALUES(?, ?, ?)" : "INSERT INTO layer_tiles VALUES(?, ?, ?, ?)");
        insert(s, {static_cast<std::int64_t>(tile.slot), tile.planes}, tile.amounts.data(), open);
        if (tile.under.empty()) return;
        if (first() && !film_) {
            create_table(db_, "films");
            raise_format(db_, kFilmsFormat);
        }
        SQLite::Statement& f = statement(
            film_, first() ? "INSERT INTO films VALUES(?, ?, ?, ?)" : "INSERT INTO layer_films VALUES(?, ?, ?, ?, ?)");
        const float* from = tile.amounts.data() + open;
        for (const ink::FilmPlanes& p : tile.under) {
            const std::size_t count = std::popcount(p.planes) * atlas::kTileTexels;
            insert(f, {static_cast<std::int64_t>(tile.slot), p.film, p.planes}, from, count);
            from += count;
        }
    }

    /// Puts all tiles of the layer into its canvas.
    void load(ink::Canvas& canvas, const std::filesystem::path& path, const ProgressFn& progress) {
        SQLite::Statement tile(db_,
                               first() ? "SELECT slot, planes, amounts FROM tiles ORDER BY slot"
                                       : "SELECT slot, planes, amounts FROM layer_tiles WHERE layer = ? ORDER BY slot");
        if (!first()) tile.bind(1, static_cast<std::int64_t>(layer_));
        const bool films = !first() || has_films(db_);
        std::uintmax_t bytes = 0, checked = 0;
        while (tile.executeStep()) {
            tuft::report(progress, "reading", 0);
            const std::int64_t slot = tile.getColumn(0).getInt64();
            const std::int64_t planes = tile.getColumn(1).getInt64();
            if (slot < 0 || slot >= static_cast<std::int64_t>(canvas.n_slots()) || planes < 0 || planes > 255)
                damaged(path, "a tile lies outside the atlas");
            ink::TileSnapshot snapshot{
                .slot = static_cast<std::uint32_t>(slot), .planes = static_cast<std::uint8_t>(planes), .amounts = {}};
            const Message what("{}: the project is damaged: tile {}", path.string(), slot);
            append(snapshot, tile.getColumn(2), snapshot.planes, what);
            if (films) load_films(snapshot, what);
            bytes += sizeof(float) * snapshot.amounts.size();
            if (bytes - checked > kCheckEvery) check_memory(path, bytes - std::exchange(checked, bytes));
            canvas.restore(snapshot);
        }
    }

  private:
    bool first() const { return layer_ == stroke::kFirstLayer; }

    SQLite::Statement& statement(std::optional<SQLite::Statement>& s, const char* sql) {
        if (!s) s.emplace(db_, sql);
        return *s;
    }

    void insert(SQLite::Statement& s, std::initializer_list<std::int64_t> keys, const float* amounts,
                std::size_t count) {
        const std::vector<char> blob = pack(amounts, count, kTiles);
        int column = 1;
        if (!first()) s.bind(column++, static_cast<std::int64_t>(layer_));
        for (const std::int64_t key : keys) s.bind(column++, key);
        s.bindNoCopy(column, blob.data(), static_cast<int>(blob.size()));
        s.exec();
        s.reset();
    }

    static void append(ink::TileSnapshot& tile, const SQLite::Column& blob, std::uint8_t planes, const Message& what) {
        const std::size_t count = std::popcount(planes) * atlas::kTileTexels;
        tile.amounts.resize(tile.amounts.size() + count);
        unpack(blob.getBlob(), static_cast<std::size_t>(blob.getBytes()),
               tile.amounts.data() + tile.amounts.size() - count, count, kTiles, what);
    }

    void load_films(ink::TileSnapshot& tile, const Message& what) {
        SQLite::Statement& s =
            statement(film_, first() ? "SELECT film, planes, amounts FROM films WHERE slot = ? ORDER BY film"
                                     : "SELECT film, planes, amounts FROM layer_films WHERE slot = ? AND layer = ? "
                                       "ORDER BY film");
        s.bind(1, static_cast<std::int64_t>(tile.slot));
        if (!first()) s.bind(2, static_cast<std::int64_t>(layer_));
        while (s.executeStep()) {
            const std::int64_t film = s.getColumn(0).getInt64(), planes = s.getColumn(1).getInt64();
            if (film < 0 || film > ink::kFilms || planes <= 0 || planes > 255)
                throw Error(Message("{} has a film that cannot be", what));
            tile.under.push_back({static_cast<std::uint8_t>(film), static_cast<std::uint8_t>(planes)});
            append(tile, s.getColumn(2), tile.under.back().planes, what);
        }
        s.reset();
    }

    SQLite::Database& db_;
    std::uint32_t layer_;
    std::optional<SQLite::Statement> tile_, film_;
};

/// Hash of the amounts, whichever pigments the canvas knows besides.
std::uint64_t hash_of_texels(const ink::Canvas& canvas) {
    std::uint64_t h = 0;
    for (const std::uint32_t slot : canvas.touched_slots()) {
        const ink::TileSnapshot tile = canvas.snapshot(slot);
        if (tile.amounts.empty()) continue;
        const std::uint64_t place = std::uint64_t{slot} << 8 | tile.planes;
        h = hash_bytes(&place, sizeof place, h);
        h = hash_bytes(tile.under.data(), tile.under.size() * sizeof(ink::FilmPlanes), h);
        h = hash_bytes(tile.amounts.data(), tile.amounts.size() * sizeof(float), h);
    }
    return h;
}

/// Of a single layer as its canvas has it; empty ones do not count.
std::uint64_t hash_of(std::vector<stroke::LayerTexels> layers, const std::vector<ink::Pigment>& pigments) {
    std::sort(layers.begin(), layers.end(), [](const auto& a, const auto& b) { return a.layer < b.layer; });
    ink::Canvas none;
    for (const ink::Pigment& p : pigments) none.add_pigment(p);
    std::uint64_t h = none.hash();
    for (const stroke::LayerTexels& layer : layers) {
        if (layer.layer == stroke::kFirstLayer) {
            h = layer.canvas->hash();
        } else if (const std::uint64_t of_texels = hash_of_texels(*layer.canvas)) {
            const std::uint64_t part[] = {layer.layer, of_texels};
            h = hash_bytes(part, sizeof part, h);
        }
    }
    return h;
}

}  // namespace

void raise_format(SQLite::Database& db, int format) {
    if (db.execAndGet("PRAGMA user_version").getInt() < format)
        db.exec("PRAGMA user_version = " + std::to_string(format));
}

StoredTexels store_canvases(SQLite::Database& db, std::span<const stroke::LayerTexels> layers) {
    db.exec("DELETE FROM tiles; DELETE FROM pigments;");
    if (has_films(db)) db.exec("DELETE FROM films;");
    if (has_layers(db)) db.exec("DELETE FROM layer_tiles; DELETE FROM layer_films;");
    StoredTexels stored;
    // Layers know the same pigments, some of them not all yet.
    std::vector<ink::Pigment> pigments;
    for (const stroke::LayerTexels& layer : layers) {
        if (layer.layer != stroke::kPaletteLayer) stored.n_slots = layer.canvas->n_slots();
        if (layer.canvas->pigments().size() > pigments.size()) pigments = layer.canvas->pigments();
    }
    stored.hash = hash_of({layers.begin(), layers.end()}, pigments);
    SQLite::Statement pigment(db, "INSERT INTO pigments(plane, name, toml) VALUES(?, ?, ?)");
    for (std::size_t p = 0; p < pigments.size(); ++p) {
        pigment.bind(1, static_cast<std::int64_t>(p));
        pigment.bind(2, pigments[p].name);
        pigment.bind(3, pigment_text(pigments[p]));
        pigment.exec();
        pigment.reset();
    }
    for (const stroke::LayerTexels& layer : layers) {
        const bool first = layer.layer == stroke::kFirstLayer;
        const std::vector<std::uint32_t> slots = layer.canvas->touched_slots();
        if (!first && !slots.empty()) {
            create_table(db, "layer_tiles");
            create_table(db, "layer_films");
            raise_format(db, layer.layer == stroke::kPaletteLayer ? kPaletteFormat : kLayersFormat);
        }
        LayerRows rows(db, layer.layer);
        for (const std::uint32_t slot : slots) rows.store_tile(layer.canvas->snapshot(slot));
    }
    return stored;
}

std::vector<stroke::LayerCanvas> load_canvases(SQLite::Database& db, const std::filesystem::path& path,
                                               std::size_t n_slots, std::uint64_t& hash, const ProgressFn& progress) {
    std::vector<stroke::LayerCanvas> layers;
    const auto add = [&](std::uint32_t id) -> ink::Canvas& {
        const std::size_t slots = id == stroke::kPaletteLayer ? stroke::make_palette().texels.n_slots() : n_slots;
        return layers.emplace_back(stroke::LayerCanvas{id, ink::Canvas(slots)}).canvas;
    };
    add(stroke::kFirstLayer);
    if (has_layers(db)) {
        SQLite::Statement ids(db, "SELECT DISTINCT layer FROM layer_tiles ORDER BY layer LIMIT " +
                                      std::to_string(stroke::kMaxLayers + 1));
        while (ids.executeStep()) {
            const std::int64_t id = ids.getColumn(0).getInt64();
            const std::size_t most = stroke::kMaxLayers + (id == stroke::kPaletteLayer ? 1 : 0);
            if (id <= stroke::kFirstLayer || id >= std::int64_t{kNone} || layers.size() >= most)
                damaged(path, "it has tiles of a layer that cannot be");
            add(static_cast<std::uint32_t>(id));
        }
    }
    SQLite::Statement pigment(db, "SELECT toml FROM pigments ORDER BY plane");
    for (std::size_t n = 0; pigment.executeStep(); ++n) {
        if (n >= ink::kMaxPigments) damaged(path, "it has too many pigments");
        const ink::Ink alone =
            ink::parse_ink(text_of(pigment.getColumn(0), kMostPigmentText, path, "a pigment"), path.string());
        if (alone.parts.empty()) damaged(path, "a pigment is none");
        for (stroke::LayerCanvas& layer : layers) layer.canvas.add_pigment(alone.parts.at(0).pigment);
    }
    for (stroke::LayerCanvas& layer : layers) LayerRows(db, layer.layer).load(layer.canvas, path, progress);
    std::vector<stroke::LayerTexels> texels;
    texels.reserve(layers.size());
    for (const stroke::LayerCanvas& layer : layers) texels.push_back({layer.layer, &layer.canvas});
    hash = hash_of(texels, layers.front().canvas.pigments());
    return layers;
}

}  // namespace tuft::io
