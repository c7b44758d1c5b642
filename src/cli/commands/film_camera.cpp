#include "cli/commands/film_camera.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "cli/arguments/options.h"
#include "cli/steps/steps.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/files/toml_text.h"
#include "core/text/text.h"

namespace tuft::cli {
namespace {

constexpr std::size_t kMostBytes = std::size_t{1} << 20;
constexpr std::size_t kMostKeys = 10'000;

struct NamedView {
    const char* name;
    double azimuth, elevation;  // degrees
};
constexpr std::array kNamedViews{NamedView{"front", 0, 0},  NamedView{"right", 90, 0}, NamedView{"back", 180, 0},
                                 NamedView{"left", 270, 0}, NamedView{"top", 0, 90},   NamedView{"bottom", 0, -90}};

View view_named(const std::string& name, const View& otherwise) {
    View view = otherwise;
    if (name == "view") return view;
    for (const NamedView& known : kNamedViews) {
        if (name != known.name) continue;
        view.azimuth = known.azimuth;
        view.elevation = known.elevation;
        return view;
    }
    throw UsageError("--camera: '" + excerpt(name) +
                     "' is not still, turntable, a view (front, right, back, left, top, bottom, view) or a .toml file");
}

std::vector<std::string> split(const std::string& text) {
    std::vector<std::string> words(1);
    for (const char c : text)
        if (c == ',')
            words.emplace_back();
        else
            words.back() += c;
    return words;
}

/// A key of the file.
class KeyReader {
  public:
    KeyReader(const toml::table& table, const std::string& source) : table_(table), source_(source) {
        for (const auto& [key, node] : table)
            if (std::find(kKeys.begin(), kKeys.end(), key.str()) == kKeys.end())
                fail(node, Message("unknown key '{}' in a key frame", std::string(key.str())));
    }

    void number(const char* key, double& out, double lo, double hi) const {
        if (const toml::node* node = table_.get(key)) out = value_of(*node, key, lo, hi);
    }
    void point(const char* key, std::vector<double>& out) const {
        const toml::node* node = table_.get(key);
        if (!node) return;
        const toml::array* row = node->as_array();
        if (!row || row->size() != 3) fail(*node, Message("'{}' must be a row of {} numbers", std::string(key), 3));
        out.clear();
        for (const toml::node& n : *row) out.push_back(value_of(n, key, -kFarthestMm, kFarthestMm));
    }
    bool has(const char* key) const { return table_.contains(key); }
    [[noreturn]] void fail(const toml::node& node, const Message& what) const {
        throw Error(source_, static_cast<long>(node.source().begin.line), what);
    }
    const toml::table& table() const { return table_; }

  private:
    static constexpr std::array<std::string_view, 5> kKeys{"at", "azimuth", "elevation", "zoom", "target"};

    double value_of(const toml::node& node, const char* key, double lo, double hi) const {
        const auto v = node.value<double>();
        if (!node.is_number() || !v || !(*v >= lo && *v <= hi))
            fail(node, Message("'{}' has a value that is no number from {} to {}", std::string(key),
                               fmt::format("{}", lo), fmt::format("{}", hi)));
        return *v;
    }

    const toml::table& table_;
    const std::string& source_;
};

render::CameraPath read_path(const std::string& file, const View& otherwise, const stroke::Model& model) {
    const std::vector<char> bytes = read_file(file, kMostBytes);
    const std::string_view text(bytes.data(), bytes.size());
    const toml::table root = parse_toml(text, file);
    const toml::array* keys = root["key"].as_array();
    if (root.size() != 1 || !keys || keys->empty() || !keys->is_homogeneous(toml::node_type::table))
        throw Error(file, "must have [[key]] tables and nothing else");
    if (keys->size() > kMostKeys) throw Error(file, "has too many key frames");
    render::CameraPath path;
    for (const toml::node& node : *keys) {
        const KeyReader key(*node.as_table(), file);
        View view = otherwise;
        double at = 0;
        if (!key.has("at")) key.fail(node, "a key frame needs 'at', the part of the film, 0 to 1");
        key.number("at", at, 0, 1);
        key.number("azimuth", view.azimuth, -kMostDegrees, kMostDegrees);
        key.number("elevation", view.elevation, -90, 90);
        key.number("zoom", view.zoom, 0.05, 100);
        key.point("target", view.target_mm);
        if (!path.empty() && !(at > path.back().at)) key.fail(node, "'at' must rise from key frame to key frame");
        path.push_back({at, picture_options(view, model).view});
    }
    return path;
}

}  // namespace

render::CameraPath camera_path(const std::string& camera, const View& view, const stroke::Model& model) {
    const render::View own = picture_options(view, model).view;
    if (camera == "still") return {{1, own}};
    if (camera == "turntable") return render::turntable_path(own);
    if (std::filesystem::path(camera).extension() == ".toml") return read_path(camera, view, model);
    std::vector<render::View> views;
    for (const std::string& name : split(camera)) views.push_back(picture_options(view_named(name, view), model).view);
    return render::standing_path(views);
}

}  // namespace tuft::cli
