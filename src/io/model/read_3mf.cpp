#include "io/model/read_3mf.h"

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/system/interrupt.h"
#include "io/package/xml_fault.h"
#include "io/package/xml_numbers.h"
#include "io/package/zip.h"
#include "io/scene/file_scene.h"
#include "mesh/read/text_cursor.h"

namespace tuft::io {
namespace {

using Mat4 = glm::dmat4;
using pugi::xml_node;

constexpr int kDeepest = 64;                                  // of components in components
constexpr std::size_t kMostCopies = 1'000'000;                // of objects
constexpr std::size_t kMostTriangles = std::size_t{1} << 26;  // and vertices, with those of all copies
constexpr std::size_t kMostParts = 256;                       // of the package that hold objects
constexpr std::size_t kMostColours = 256;                     // more are shades, not parts

struct Texture {
    std::vector<Vec2f> uvs;
    std::uint32_t material = kNone;
};

/// What a property id stands for.
struct Property {
    std::vector<std::uint32_t> materials;  ///< by index: base materials and colours
    std::optional<Texture> texture;
};

/// One model part of the package.
struct Part {
    std::unique_ptr<pugi::xml_document> document;
    double metres = 1e-3;
    std::map<std::string, xml_node> objects;
    std::map<std::string, Property> properties;
};

double metres_of(std::string_view unit) {
    constexpr std::array<std::pair<std::string_view, double>, 6> units{{{"micron", 1e-6},
                                                                        {"millimeter", 1e-3},
                                                                        {"centimeter", 1e-2},
                                                                        {"inch", 0.0254},
                                                                        {"foot", 0.3048},
                                                                        {"meter", 1}}};
    for (const auto& [name, metres] : units)
        if (name == unit) return metres;
    return 1e-3;
}

xml_node child(const xml_node& node, std::string_view name) {
    for (const xml_node& c : node.children())
        if (local_part(c.name()) == name) return c;
    return {};
}

/// An attribute by its name without prefix.
std::string_view attribute(const xml_node& node, std::string_view name) {
    for (const pugi::xml_attribute& a : node.attributes()) {
        if (local_part(a.name()) == name) return a.value();
    }
    return {};
}

/// Names of parts begin with a slash, those of ZIP entries do not.
std::string entry_name(std::string_view path) {
    return std::string(path.starts_with('/') ? path.substr(1) : path);
}

class Reader {
  public:
    Reader(const std::vector<char>& bytes, std::string file) : file_(file), zip_(bytes, std::move(file)) {}

    FileScene run() {
        const Part& root = part(root_part());
        const xml_node model = root.document->document_element();
        out_.stated_unit = root.metres;
        for (const xml_node& item : child(model, "build").children()) {
            if (local_part(item.name()) == "item") add_copy(root_, item, Mat4(1.0), 0, "");
        }
        if (left_out_ > 0)
            out_.warnings.push_back(
                Message("composite materials and multiple properties are not read; {} groups of them were left out",
                        left_out_));
        return std::move(out_);
    }

  private:
    [[noreturn]] void fail(const Message& what) const { throw Error(file_, what); }

    std::string root_part() {
        root_.clear();
        if (zip_.has("_rels/.rels")) {
            const std::vector<char> bytes = zip_.read("_rels/.rels");
            pugi::xml_document rels;
            if (rels.load_buffer(bytes.data(), bytes.size()))
                for (const xml_node& relation : rels.document_element().children())
                    if (attribute(relation, "Type").ends_with("/3dmodel"))
                        root_ = entry_name(attribute(relation, "Target"));
        }
        if (root_.empty() || !zip_.has(root_))
            for (const auto& [name, entry] : zip_.entries())
                if (name.ends_with(".model")) root_ = name;
        if (root_.empty()) fail("is a ZIP archive without a 3MF model");
        return root_;
    }

    const Part& part(const std::string& name) {
        const auto [it, is_new] = parts_.try_emplace(name);
        if (!is_new) return it->second;
        if (parts_.size() > kMostParts) fail(Message("has more than {} parts with objects", kMostParts));
        Part& made = it->second;
        const std::vector<char> bytes = zip_.read(name);
        made.document = std::make_unique<pugi::xml_document>();
        const auto parsed = made.document->load_buffer(bytes.data(), bytes.size());
        if (!parsed) fail(Message("{} is not well-formed XML: {}", mesh::in_quotes(name), xml_fault(parsed)));
        const xml_node model = made.document->document_element();
        if (local_part(model.name()) != "model") fail(Message("{} is no 3MF model", mesh::in_quotes(name)));
        made.metres = metres_of(attribute(model, "unit"));
        const xml_node resources = child(model, "resources");
        std::map<std::string, std::string> pictures;  // texture2d by id
        for (const xml_node& r : resources.children()) {
            const std::string id(attribute(r, "id"));
            if (local_part(r.name()) == "object") made.objects.emplace(id, r);
            if (local_part(r.name()) == "texture2d") pictures.emplace(id, entry_name(attribute(r, "path")));
        }
        for (const xml_node& r : resources.children()) add_property(made, r, pictures);
        return made;
    }

    void add_property(Part& part, const xml_node& r, const std::map<std::string, std::string>& pictures) {
        const std::string_view kind = local_part(r.name());
        Property property;
        if (kind == "basematerials") {
            for (const xml_node& base : r.children()) property.materials.push_back(add_base(base));
        } else if (kind == "colorgroup") {
            for (const xml_node& colour : r.children()) property.materials.push_back(add_colour(colour));
        } else if (kind == "texture2dgroup") {
            property.texture = Texture{};
            for (const xml_node& c : r.children()) {
                NumberList u(attribute(c, "u")), v(attribute(c, "v"));
                property.texture->uvs.emplace_back(u.next<float>().value_or(0.0f), v.next<float>().value_or(0.0f));
            }
            const auto picture = pictures.find(std::string(attribute(r, "texid")));
            if (picture != pictures.end()) property.texture->material = add_picture(picture->second);
        } else {
            if (kind == "compositematerials" || kind == "multiproperties") ++left_out_;
            return;
        }
        part.properties.emplace(std::string(attribute(r, "id")), std::move(property));
    }

    static void set_colour(FileMaterial& m, std::string_view text) {
        std::array<unsigned, 4> channels{255, 255, 255, 255};
        if (!text.starts_with('#')) return;
        for (std::size_t k = 0; k < 4 && 3 + 2 * k <= text.size(); ++k)
            std::from_chars(text.data() + 1 + 2 * k, text.data() + 3 + 2 * k, channels[k], 16);
        for (int c = 0; c < 3; ++c) m.colour[c] = static_cast<float>(channels[static_cast<std::size_t>(c)]) / 255;
        if (channels[3] > 0) m.alpha = static_cast<float>(channels[3]) / 255;
    }

    std::uint32_t add_base(const xml_node& base) {
        FileMaterial m{.name = std::string(attribute(base, "name"))};
        set_colour(m, attribute(base, "displaycolor"));
        out_.materials.push_back(std::move(m));
        return static_cast<std::uint32_t>(out_.materials.size()) - 1;
    }

    std::uint32_t add_colour(const xml_node& colour) {
        const std::string text(attribute(colour, "color"));
        if (const auto found = colours_.find(text); found != colours_.end()) return found->second;
        if (colours_.size() == kMostColours) {
            if (!many_colours_)
                out_.warnings.push_back(Message(
                    "more than {} colours of faces, too many to be groups; the others go without", kMostColours));
            many_colours_ = true;
            return kNone;
        }
        FileMaterial m{.name = text};
        set_colour(m, text);
        out_.materials.push_back(std::move(m));
        return colours_[text] = static_cast<std::uint32_t>(out_.materials.size()) - 1;
    }

    std::uint32_t add_picture(const std::string& name) {
        if (const auto found = pictures_.find(name); found != pictures_.end()) return found->second;
        FileMaterial m{.name = std::filesystem::path(name).stem().string(), .picture = name};
        if (zip_.has(name)) m.picture_bytes = zip_.read(name);
        if (m.picture_bytes.empty()) {
            out_.warnings.push_back(
                Message("the picture {} is not in the package; its faces go without", mesh::in_quotes(name)));
            m.picture.clear();
        }
        out_.materials.push_back(std::move(m));
        return pictures_[name] = static_cast<std::uint32_t>(out_.materials.size()) - 1;
    }

    static Mat4 transform_of(const xml_node& node) {
        const std::string_view text = attribute(node, "transform");
        Mat4 m(1.0);
        NumberList numbers(text);
        for (int i = 0; i < 12 && !text.empty(); ++i) {
            const auto value = numbers.next<double>();
            if (!value) return Mat4(1.0);
            m[i / 3][i % 3] = *value;  // points are rows there
        }
        return m;
    }

    /// A build item or a component: what it refers to, placed.
    void add_copy(const std::string& from, const xml_node& node, const Mat4& parent, int depth,
                  const std::string& name_above) {
        if (depth > kDeepest) fail("its components do not form a tree, or one deeper than 64");
        if (++copies_ > kMostCopies) fail("has more than a million copies of objects");
        if (copies_ % 1024 == 0) check_interrupt();
        const std::string_view path = attribute(node, "path");
        const std::string where = path.empty() ? from : entry_name(path);
        const Part& in = part(where);
        const std::string id(attribute(node, "objectid"));
        const auto found = in.objects.find(id);
        if (found == in.objects.end()) fail(Message("object {} is not in the file", mesh::in_quotes(id)));
        const xml_node& object = found->second;
        const Mat4 world = parent * transform_of(node);
        std::string name(attribute(object, "name"));
        if (name.empty()) name = name_above.empty() ? "object " + id : name_above;
        if (const xml_node inside = child(object, "mesh")) add_mesh(in, object, inside, world, name);
        for (const xml_node& component : child(object, "components").children())
            if (local_part(component.name()) == "component") add_copy(where, component, world, depth + 1, name);
    }

    struct Appearance {
        std::uint32_t material = kNone;
        const Texture* texture = nullptr;
    };

    Appearance appearance_of(const Part& in, std::string_view pid, std::size_t index) const {
        const auto property = in.properties.find(std::string(pid));
        if (property == in.properties.end()) return {};
        const Property& p = property->second;
        if (p.texture) return {p.texture->material, &*p.texture};
        return {index < p.materials.size() ? p.materials[index] : kNone, nullptr};
    }

    std::uint32_t part_of(const std::string& object, std::uint32_t material) {
        const auto [it, is_new] =
            part_index_.try_emplace({object, material}, static_cast<std::uint32_t>(out_.parts.size()));
        if (is_new) out_.parts.push_back({.object = object, .material = material});
        return it->second;
    }

    void add_mesh(const Part& in, const xml_node& object, const xml_node& node, const Mat4& world,
                  const std::string& name) {
        const auto base = static_cast<std::uint32_t>(out_.points.size());
        for (const xml_node& v : child(node, "vertices").children()) {
            if (out_.points.size() >= kMostTriangles) fail("has too many vertices");
            glm::dvec4 p(0, 0, 0, 1);
            constexpr std::array<const char*, 3> names{"x", "y", "z"};
            for (int k = 0; k < 3; ++k)
                p[k] = NumberList(v.attribute(names[static_cast<std::size_t>(k)]).value()).next<double>().value_or(NAN);
            out_.points.push_back(in.metres * Vec3(world * p));
        }
        const std::size_t n_points = out_.points.size() - base;
        const bool mirrored = glm::determinant(glm::dmat3(world)) < 0;
        const auto index_of = [](const xml_node& t, const char* key, std::size_t other) {
            const auto value = NumberList(t.attribute(key).value()).next<std::uint32_t>();
            return value ? std::size_t{*value} : other;
        };
        const std::string object_pid(attribute(object, "pid"));
        const std::size_t object_index = index_of(object, "pindex", 0);
        for (const xml_node& t : child(node, "triangles").children()) {
            if (out_.counts.size() >= kMostTriangles) fail("has too many triangles");
            std::array<std::uint32_t, 3> corners{};
            constexpr std::array<const char*, 3> keys{"v1", "v2", "v3"}, property_keys{"p1", "p2", "p3"};
            const std::string_view own = t.attribute("pid").value();
            const std::size_t first = index_of(t, "p1", object_index);
            const Appearance appearance = appearance_of(in, own.empty() ? object_pid : own, first);
            std::array<Vec2f, 3> uvs{Vec2f(NAN), Vec2f(NAN), Vec2f(NAN)};
            for (std::size_t k = 0; k < 3; ++k) {
                const std::size_t v = index_of(t, keys[k], n_points);
                if (v >= n_points)
                    fail(Message("a triangle of object {} has a vertex that is not there", mesh::in_quotes(name)));
                const std::size_t at = mirrored ? 2 - k : k;
                corners[at] = base + static_cast<std::uint32_t>(v);
                const std::size_t p = index_of(t, property_keys[k], first);
                if (appearance.texture && p < appearance.texture->uvs.size()) uvs[at] = appearance.texture->uvs[p];
            }
            out_.add_polygon(part_of(name, appearance.material), corners,
                             appearance.texture ? std::span<const Vec2f>(uvs) : std::span<const Vec2f>());
        }
    }

    std::string file_, root_;
    Zip zip_;
    std::map<std::string, Part> parts_;
    std::map<std::string, std::uint32_t> colours_, pictures_;
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> part_index_;
    FileScene out_;
    std::size_t copies_ = 0, left_out_ = 0;
    bool many_colours_ = false;
};

}  // namespace

mesh::PolygonSoup read_3mf(const std::vector<char>& bytes, const std::filesystem::path& path) {
    return soup_of(Reader(bytes, path.string()).run(), path);
}

}  // namespace tuft::io
