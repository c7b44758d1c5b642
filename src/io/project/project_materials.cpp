#include <SQLiteCpp/SQLiteCpp.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "core/text/nesting.h"
#include "io/project/project_db.h"
#include "io/scene/json_number.h"
#include "io/scene/materials.h"

namespace tuft::io {
namespace {

constexpr Packing kBytes{.element = 1, .lag = 1};
constexpr std::size_t kMaxTable = std::size_t{1} << 26;
constexpr std::size_t kMaxPictures = 4096;

std::string picture_array(std::size_t i) {
    return "picture " + std::to_string(i);
}

}  // namespace

std::vector<char> get_bytes(SQLite::Database& db, const std::filesystem::path& path, const std::string& name,
                            std::size_t most) {
    SQLite::Statement select(db, "SELECT count FROM arrays WHERE owner = 'mesh' AND name = ?");
    select.bind(1, name);
    if (!select.executeStep()) return {};
    const std::int64_t count = select.getColumn(0).getInt64();
    if (count < 0 || static_cast<std::uint64_t>(count) > most) damaged(path, Message("array '{}' is too large", name));
    return get_array<char>(db, path, "mesh", name.c_str(), kBytes, static_cast<std::size_t>(count));
}

void store_materials(SQLite::Database& db, const mesh::TriangleMesh& mesh) {
    if (mesh.materials.empty()) return;
    std::map<const mesh::Picture*, std::size_t> index;
    nlohmann::json names = nlohmann::json::array(), table = nlohmann::json::array();
    const auto put = [&](const mesh::Picture& picture) {
        const auto [it, is_new] = index.try_emplace(&picture, index.size());
        if (is_new) {
            names.push_back(picture.name);
            put_array(db, "mesh", picture_array(it->second).c_str(), picture.bytes, kBytes);
        }
        return it->second;
    };
    bool tiled = false;
    for (const mesh::Material& m : mesh.materials) {
        tiled = tiled || !m.tiles.empty();
        nlohmann::json row{{"colour", {m.colour.r, m.colour.g, m.colour.b}}, {"tinted", m.tinted}};
        if (m.picture) row["picture"] = put(*m.picture);
        for (const mesh::PictureTile& tile : m.tiles) row["tiles"].push_back({tile.udim, put(*tile.picture)});
        table.push_back(std::move(row));
    }
    const std::string text = nlohmann::json{{"materials", table}, {"pictures", names}}.dump(
        -1, ' ', false, nlohmann::json::error_handler_t::replace);
    put_array(db, "mesh", "materials", std::vector<char>(text.begin(), text.end()), kBytes);
    raise_format(db, tiled ? kTilesFormat : kColoursFormat);
}

void load_materials(SQLite::Database& db, const std::filesystem::path& path, mesh::TriangleMesh& mesh) {
    const std::vector<char> text = get_bytes(db, path, "materials", kMaxTable);
    if (text.empty()) return;
    std::vector<std::shared_ptr<const mesh::Picture>> pictures;
    try {
        check_json_nesting({text.data(), text.size()}, path.string());
        const nlohmann::json j = nlohmann::json::parse(text.begin(), text.end());
        const auto names = j.at("pictures").get<std::vector<std::string>>();
        if (names.size() > kMaxPictures) damaged(path, "it has too many pictures");
        for (std::size_t i = 0; i < names.size(); ++i)
            pictures.push_back(decode_picture(names[i], get_bytes(db, path, picture_array(i), kMaxPictureBytes)));
        for (const nlohmann::json& row : j.at("materials")) {
            mesh::Material m{.tinted = row.at("tinted").get<bool>()};
            for (int c = 0; c < 3; ++c) {
                const auto value = row.at("colour").at(static_cast<std::size_t>(c)).get<float>();
                if (!(value >= 0 && value <= 1)) damaged(path, "a material has no valid colour");
                m.colour[c] = value;
            }
            if (row.contains("picture")) m.picture = pictures.at(whole_number<std::size_t>(row["picture"]));
            if (row.contains("tiles"))
                for (const nlohmann::json& tile : row["tiles"])
                    m.tiles.push_back(
                        {whole_number<std::uint32_t>(tile.at(0)), pictures.at(whole_number<std::size_t>(tile.at(1)))});
            if (!std::ranges::is_sorted(m.tiles, std::less_equal<>{}, &mesh::PictureTile::udim))
                damaged(path, "the pictures of a material's tiles are not in order");
            mesh.materials.push_back(std::move(m));
        }
    } catch (const nlohmann::json::exception&) {
        damaged(path, "its materials cannot be read");
    } catch (const std::out_of_range&) {
        damaged(path, "a material has a picture that does not exist");
    }
    if (mesh.materials.size() != (mesh.triangle_groups.empty() ? 1 : mesh.group_names.size()))
        damaged(path, "its materials do not fit its groups");
}

}  // namespace tuft::io
