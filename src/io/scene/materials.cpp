#include "io/scene/materials.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <set>
#include <span>

#include "core/error.h"
#include "core/files/files.h"
#include "core/text/text.h"
#include "io/image/image.h"
#include "io/scene/mtl_material.h"
#include "io/scene/scene_document.h"
#include "mesh/read/text_cursor.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

constexpr std::size_t kMaxLibraries = 64;
constexpr std::size_t kMaxStatements = 1000;  // of an entry
constexpr std::string_view kUdim = "<UDIM>";

/// Where a file of that name lies in the folder; nothing when it is not there.
std::optional<fs::path> find_beside(const fs::path& folder, std::string name) {
    std::replace(name.begin(), name.end(), '\\', '/');
    std::error_code ec;
    for (const fs::path& candidate : {fs::path(name), fs::path(name).filename()}) {
        if (candidate.empty() || candidate.is_absolute()) continue;
        const fs::path file = folder / candidate;
        if (fs::is_regular_file(file, ec) && lies_within(folder, file)) return file;
    }
    return std::nullopt;
}

struct MtlEntry {
    Vec3f colour{1};
    std::string picture;
    std::vector<MtlStatement> statements;
};

void read_library(const fs::path& file, std::map<std::string, MtlEntry>& entries) {
    const std::vector<char> bytes = read_file(file, kMaxPictureBytes);
    mesh::TextCursor text(bytes, file.string(), {.comment = '#', .continuation = true});
    MtlEntry* entry = nullptr;
    for (; text.skip_to_token(); text.next_line()) {
        const std::string_view key = text.word();
        const std::string rest(text.rest());
        if (mesh::same_word(key, "newmtl")) {
            entry = &entries.try_emplace(to_utf8(rest)).first->second;
            continue;
        }
        if (!entry || entry->statements.size() >= kMaxStatements) continue;
        entry->statements.emplace_back(key, rest);
        if (mesh::same_word(key, "Kd")) {
            const char* at = rest.c_str();
            for (int c = 0; c < 3; ++c) {
                char* end = nullptr;
                const float value = std::strtof(at, &end);
                entry->colour[c] = end == at ? 0 : std::isfinite(value) ? std::clamp(value, 0.0f, 1.0f) : 1;
                at = end;
            }
        } else if (mesh::same_word(key, "map_Kd")) {
            entry->picture = picture_name(rest);
        }
    }
}

/// Each picture is read once, and reported once when that fails.
class Pictures {
  public:
    Pictures(fs::path folder, std::vector<Message>& warnings) : folder_(std::move(folder)), warnings_(warnings) {}

    std::shared_ptr<const mesh::Picture> get(const std::string& name, std::size_t most_pixels = kMaxPicturePixels) {
        const std::optional<fs::path> file = find_beside(folder_, name);
        const auto [it, is_new] = read_.try_emplace(file ? file->string() : name);
        if (is_new && file) it->second = read(*file, most_pixels);
        if (is_new && !file)
            warnings_.push_back(
                Message("the picture {} is not in the model's folder; its faces go without", mesh::in_quotes(name)));
        return it->second;
    }

    /// Says that pictures on tiles of a map other than that of colours are not read.
    void leave_out_tiles(const std::string& name) {
        if (read_.try_emplace(name).second)
            warnings_.push_back(
                Message("the pictures {} are not read: only those of colours may lie on tiles", mesh::in_quotes(name)));
    }

  private:
    std::shared_ptr<const mesh::Picture> read(const fs::path& file, std::size_t most_pixels) {
        try {
            return decode_picture(file.filename().string(), read_file(file, kMaxPictureBytes), most_pixels);
        } catch (const std::exception& e) {
            warnings_.push_back(Message("{}; its faces go without", message_of(e)));
            return nullptr;
        }
    }

    fs::path folder_;
    std::vector<Message>& warnings_;
    std::map<std::string, std::shared_ptr<const mesh::Picture>> read_;
};

/// Where a name has its `<UDIM>`; npos: nowhere.
std::size_t place_of_number(const std::string& name) {
    const auto at = std::search(name.begin(), name.end(), kUdim.begin(), kUdim.end(),
                                [](char a, char b) { return std::toupper(static_cast<unsigned char>(a)) == b; });
    return at == name.end() ? name.npos : static_cast<std::size_t>(at - name.begin());
}

/// Pictures on UDIM tiles.
class TilePictures {
  public:
    TilePictures(const mesh::PolygonSoup& soup, Pictures& pictures, std::vector<Message>& warnings)
        : soup_(soup), pictures_(pictures), warnings_(warnings) {}

    /// `group`: whose faces the pictures are for.
    std::vector<mesh::PictureTile> get(const std::string& name, std::size_t group) {
        const std::size_t at = place_of_number(name);
        std::vector<mesh::PictureTile> tiles;
        for (const std::uint32_t udim : tiles_of(group)) {
            std::string file = name;
            file.replace(at, kUdim.size(), std::to_string(udim));
            const bool is_new = !read_.contains(file);
            if (is_new && (read_.size() >= kMostPictureTiles || n_pixels_ >= kMaxTilePixels)) {
                warnings_.push_back(Message("{} has more or larger tiles than are read; their faces go without",
                                            mesh::in_quotes(name)));
                break;
            }
            read_.insert(file);
            const auto picture = pictures_.get(file, std::min(kMaxPicturePixels, kMaxTilePixels - n_pixels_));
            if (!picture) continue;
            tiles.push_back({udim, picture});
            if (!is_new) continue;
            n_pixels_ += static_cast<std::size_t>(picture->width) * static_cast<std::size_t>(picture->height);
        }
        return tiles;
    }

  private:
    const std::set<std::uint32_t>& tiles_of(std::size_t group) {
        if (of_group_.empty()) find_tiles();
        return of_group_[group];
    }

    void find_tiles() {
        of_group_.resize(std::max<std::size_t>(1, soup_.group_names.size()));
        for (std::size_t p = 0; p < soup_.n_polygons() && !soup_.corner_uvs.empty(); ++p) {
            const std::size_t begin = soup_.polygon_start[p], n = soup_.polygon_start[p + 1] - begin;
            const std::uint32_t udim = mesh::udim_at(std::span(soup_.corner_uvs).subspan(begin, n));
            const std::size_t group = soup_.polygon_groups.empty() ? 0 : soup_.polygon_groups[p];
            if (udim != 0 && group < of_group_.size()) of_group_[group].insert(udim);
        }
    }

    const mesh::PolygonSoup& soup_;
    Pictures& pictures_;
    std::vector<Message>& warnings_;
    std::vector<std::set<std::uint32_t>> of_group_;
    std::set<std::string> read_;
    std::size_t n_pixels_ = 0;
};

std::map<std::string, MtlEntry> read_libraries(mesh::PolygonSoup& soup, const fs::path& folder) {
    std::map<std::string, MtlEntry> entries;
    soup.material_libraries.resize(std::min(soup.material_libraries.size(), kMaxLibraries));
    for (const std::string& name : soup.material_libraries) {
        const std::optional<fs::path> file = find_beside(folder, name);
        if (!file) {
            soup.warnings.push_back(
                Message("the material library {} is not in the model's folder", mesh::in_quotes(name)));
            continue;
        }
        try {
            read_library(*file, entries);
        } catch (const std::exception& e) {
            soup.warnings.push_back(message_of(e));
        }
    }
    return entries;
}

/// Whether a picture may be a map of normals: a grey one is a map of heights.
bool has_colour(const mesh::Picture& picture) {
    for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3)
        if (picture.rgb[i] != picture.rgb[i + 1] || picture.rgb[i] != picture.rgb[i + 2]) return true;
    return false;
}

/// Completes the scene that the reader has named the parts of.
void add_materials(mesh::PolygonSoup& soup, const std::map<std::string, MtlEntry>& entries, Pictures& pictures) {
    SceneBuilder builder;
    std::map<const mesh::Picture*, int> textures;
    std::vector<const mesh::Picture*> picture_of;
    const auto is_of_colours = [&](const std::string& name) {
        return std::ranges::any_of(entries, [&](const auto& entry) { return entry.second.picture == name; });
    };
    const auto texture_of = [&](const std::string& name) {
        if (place_of_number(name) != name.npos) {
            if (!is_of_colours(name)) pictures.leave_out_tiles(name);
            return -1;
        }
        const auto picture = pictures.get(name);
        if (!picture) return -1;
        const auto [it, is_new] = textures.try_emplace(picture.get(), -1);
        const auto* bytes = reinterpret_cast<const unsigned char*>(picture->bytes.data());
        if (is_new) {
            it->second = builder.add_texture(picture->name, {bytes, picture->bytes.size()});
            picture_of.push_back(picture.get());
        }
        return it->second;
    };
    std::map<std::string, int> indices;
    for (mesh::ScenePart& part : soup.scene->parts) {
        const auto entry = entries.find(part.material);
        if (entry == entries.end()) continue;
        const auto [index, is_new] = indices.try_emplace(part.material, -1);
        if (is_new) {
            MtlAsGltf made = gltf_of_mtl(part.material, entry->second.statements, texture_of);
            const auto normal = made.material.find("normalTexture");
            if (normal != made.material.end() && !has_colour(*picture_of[(*normal)["index"].get<std::size_t>()]))
                made.material.erase(normal);
            index->second = builder.add_material(std::move(made.material));
            builder.keep_statements(index->second, std::move(made.statements));
        }
        part.own_material = index->second;
    }
    *soup.scene = builder.finish(std::move(soup.scene->parts), "model");
}

}  // namespace

std::shared_ptr<const mesh::Picture> decode_picture(std::string name, std::vector<char> bytes,
                                                    std::size_t most_pixels) {
    if (bytes.size() > kMaxPictureBytes) throw Error(name, "is larger than a picture may be");
    if (bytes.size() >= 4 && std::memcmp(bytes.data(), "\x76\x2f\x31\x01", 4) == 0)
        throw Error(name, "is an EXR picture, not a PNG, JPEG or TIFF");
    const Image8 image = decode_image8(bytes, name, most_pixels);
    auto picture = std::make_shared<mesh::Picture>();
    picture->name = std::move(name);
    picture->bytes = std::move(bytes);
    picture->width = image.width;
    picture->height = image.height;
    const std::size_t n = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
    const auto channels = static_cast<std::size_t>(image.channels);
    picture->rgb.resize(3 * n);
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t c = 0; c < 3; ++c)
            picture->rgb[3 * i + c] = image.pixels[channels * i + (channels >= 3 ? c : 0)];
    return picture;
}

std::shared_ptr<const mesh::Picture> read_picture_beside(const fs::path& folder, const std::string& name,
                                                         std::vector<Message>& warnings) {
    return Pictures(folder, warnings).get(name);
}

bool lies_within(const fs::path& folder, const fs::path& file) {
    std::error_code ec;
    const fs::path root = fs::weakly_canonical(folder, ec);
    if (ec) return false;
    const fs::path whole = fs::weakly_canonical(file, ec);
    return !ec && std::mismatch(root.begin(), root.end(), whole.begin(), whole.end()).first == root.end();
}

void read_materials(mesh::PolygonSoup& soup, const fs::path& model) {
    const fs::path folder = model.has_parent_path() ? model.parent_path() : fs::path(".");
    const std::vector<std::string> names = std::move(soup.material_names);
    soup.material_names.clear();
    if (names.empty() || !soup.materials.empty()) return;
    const bool by_library = !soup.material_libraries.empty();
    const std::map<std::string, MtlEntry> entries = read_libraries(soup, folder);
    Pictures pictures(folder, soup.warnings);
    TilePictures tiles(soup, pictures, soup.warnings);
    bool any = false;
    std::vector<mesh::Material> materials(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
        const auto found = entries.find(to_utf8(names[i]));
        if (found != entries.end()) {
            const MtlEntry& entry = found->second;
            if (place_of_number(entry.picture) != std::string::npos) {
                materials[i].tiles = tiles.get(entry.picture, i);
                if (!materials[i].tiles.empty()) materials[i].picture = materials[i].tiles.front().picture;
            } else if (!entry.picture.empty()) {
                materials[i].picture = pictures.get(entry.picture);
            }
            if (!materials[i].picture) materials[i].colour = entry.colour;
            any = true;
        } else if (!by_library && !names[i].empty()) {
            materials[i].picture = pictures.get(names[i]);
            any = any || materials[i].picture;
        }
    }
    if (any) soup.materials = std::move(materials);
    if (any && by_library && soup.scene) add_materials(soup, entries, pictures);
    drop_plain_materials(soup);
}

void drop_plain_materials(mesh::PolygonSoup& soup) {
    const auto plain = [&](const mesh::Material& m) { return !m.picture && m.colour == soup.materials[0].colour; };
    if (soup.materials.empty() || !std::all_of(soup.materials.begin(), soup.materials.end(), plain)) return;
    const Vec3f c = soup.materials[0].colour;
    if (c.r == c.g && c.g == c.b) soup.materials.clear();
}

}  // namespace tuft::io
