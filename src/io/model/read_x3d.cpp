#include "io/model/read_x3d.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <pugixml.hpp>
#include <set>
#include <span>
#include <string>
#include <string_view>

#include "core/error.h"
#include "core/system/interrupt.h"
#include "io/package/xml_fault.h"
#include "io/package/xml_numbers.h"
#include "io/scene/file_scene.h"
#include "mesh/read/text_cursor.h"

namespace tuft::io {
namespace {

using Mat4 = glm::dmat4;
using pugi::xml_node;

constexpr int kDeepest = 256;
constexpr std::size_t kMostKinds = 64, kNamedKinds = 5;     // of nodes that are skipped: told, named in an error
constexpr std::size_t kMostNodes = 4'000'000;               // visited, each USE of one counted
constexpr std::size_t kMostCorners = std::size_t{1} << 27;  // and points, with those of each USE

/// Whole numbers of one polygon or strip after the other, each ended by -1.
using Lists = std::vector<std::vector<std::int32_t>>;

Lists lists_of(std::string_view text) {
    Lists out(1);
    NumberList numbers(text);
    while (const auto value = numbers.next<std::int32_t>()) {
        if (*value < 0)
            out.emplace_back();
        else
            out.back().push_back(*value);
    }
    if (out.back().empty()) out.pop_back();
    return out;
}

std::vector<double> numbers_of(std::string_view text) {
    std::vector<double> out;
    NumberList numbers(text);
    while (const auto value = numbers.next<double>()) out.push_back(*value);
    return out;
}

Vec3 vec3_of(const pugi::xml_attribute& a, const Vec3& other) {
    const std::vector<double> n = numbers_of(std::string_view(a.value()).substr(0, 1000));
    return n.size() == 3 ? Vec3(n[0], n[1], n[2]) : other;
}

Mat4 rotation_of(const pugi::xml_attribute& a, double sign = 1) {
    const std::vector<double> n = numbers_of(std::string_view(a.value()).substr(0, 1000));
    if (n.size() != 4) return Mat4(1.0);
    const Vec3 axis(n[0], n[1], n[2]);
    const double length = glm::length(axis);
    if (!(length > 0) || !std::isfinite(n[3])) return Mat4(1.0);
    return glm::mat4_cast(glm::angleAxis(sign * n[3], axis / length));
}

Mat4 moved(const Vec3& by) {
    Mat4 m(1.0);
    m[3] = glm::dvec4(by, 1);
    return m;
}

/// T C R SR S -SR -C, as in ISO/IEC 19775-1, 10.4.4.
Mat4 transform_of(const xml_node& node) {
    const Vec3 centre = vec3_of(node.attribute("center"), Vec3(0)), scale = vec3_of(node.attribute("scale"), Vec3(1));
    Mat4 scaled(1.0);
    for (int k = 0; k < 3; ++k) scaled[k][k] = scale[k];
    return moved(vec3_of(node.attribute("translation"), Vec3(0)) + centre) * rotation_of(node.attribute("rotation")) *
           rotation_of(node.attribute("scaleOrientation")) * scaled *
           rotation_of(node.attribute("scaleOrientation"), -1) * moved(-centre);
}

/// The name that a file gives a node; read_vrml.cpp sets "#2" behind the second node of one name.
std::string name_of(const xml_node& node) {
    std::string name = node.attribute("DEF").value();
    std::replace(name.begin(), name.end(), '#', '_');
    return name;
}

/// The first text of an MFString, or all of it where there are no quotes.
std::vector<std::string> strings_of(std::string_view text) {
    std::vector<std::string> out;
    for (std::size_t at = text.find('"'); at != text.npos; at = text.find('"', at)) {
        const std::size_t end = text.find('"', at + 1);
        if (end == text.npos) break;
        out.emplace_back(text.substr(at + 1, end - at - 1));
        at = end + 1;
    }
    if (out.empty() && !text.empty()) out.emplace_back(text);
    return out;
}

/// Faces of a geometry node over its points.
struct Geometry {
    std::vector<double> points, uvs, colours;
    std::size_t channels = 3;  ///< of a colour
    Lists faces, face_uvs;     ///< the latter empty: as the faces
};

class Reader {
  public:
    Reader(const pugi::xml_document& document, std::string file) : document_(document), file_(std::move(file)) {}

    FileScene run() {
        const xml_node root = document_.document_element();
        if (local_part(root.name()) != "X3D") throw Error(file_, "not X3D: the outermost element is not <X3D>");
        Mat4 frame(1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1);
        for (const xml_node& unit : root.child("head").children("unit"))
            if (std::string_view(unit.attribute("category").value()) == "length")
                out_.stated_unit *= metres_of(unit.attribute("conversionFactor").value());
        if (!(out_.stated_unit > 0 && std::isfinite(out_.stated_unit))) out_.stated_unit = 1;
        frame = out_.stated_unit * frame;
        frame[3][3] = 1;
        index(root);
        visit(root.child("Scene"), frame, "", 0);
        for (const std::string& kind : skipped_)
            out_.warnings.push_back(Message("<{}> is not read and was skipped", kind));
        if (out_.counts.empty() && !skipped_.empty()) {
            std::string kinds;
            std::size_t n = 0;
            for (const std::string& kind : skipped_)
                if (++n <= kNamedKinds) kinds += (kinds.empty() ? "<" : ", <") + kind + ">";
            if (n > kNamedKinds) kinds += ", ...";
            throw Error(file_, Message("has no faces that are read: of {} none are", kinds));
        }
        if (!out_.colours.empty()) out_.colours.resize(out_.points.size(), {255, 255, 255, 255});
        return std::move(out_);
    }

  private:
    static double metres_of(std::string_view text) {
        const double metres = NumberList(text).next<double>().value_or(1);
        return metres > 0 && std::isfinite(metres) ? metres : 1;
    }

    void index(const xml_node& root) {
        for (xml_node n = root; n;) {  // in the order of the file, without recursion
            if (const char* name = n.attribute("DEF").value(); *name) defined_.emplace(name, n);
            if (n.first_child()) {
                n = n.first_child();
                continue;
            }
            while (n && n != root && !n.next_sibling()) n = n.parent();
            n = n == root ? xml_node() : n.next_sibling();
        }
    }

    void skip(std::string_view kind) {
        if (skipped_.size() < kMostKinds) skipped_.insert(std::string(kind.substr(0, 60)));
    }

    /// The node itself, or the one that it says to use.
    xml_node target_of(const xml_node& node) const {
        const char* name = node.attribute("USE").value();
        if (!*name) return node;
        const auto found = defined_.find(name);
        return found == defined_.end() || found->second.name() != std::string_view(node.name()) ? xml_node()
                                                                                                : found->second;
    }
    xml_node child(const xml_node& node, const char* name) const { return target_of(node.child(name)); }

    void visit(const xml_node& node, const Mat4& world, const std::string& object, int depth) {
        if (depth > kDeepest) throw Error(file_, "its nodes do not form a tree, or one deeper than 256");
        std::int64_t chosen = -1, at = 0;
        const std::string_view kind = node.name();
        if (kind == "Switch")
            chosen = NumberList(node.attribute("whichChoice").value()).next<std::int32_t>().value_or(-1);
        if (kind == "LOD") chosen = 0;
        for (const xml_node& c : node.children()) {
            if (++visited_ > kMostNodes) throw Error(file_, "has more than four million nodes");
            if (visited_ % 4096 == 0) check_interrupt();
            const std::string_view child_kind = c.name();
            const bool counts = !child_kind.starts_with("Metadata") && child_kind != "ProtoDeclare";
            if ((kind == "Switch" || kind == "LOD") && counts && at++ != chosen) continue;
            visit_one(target_of(c), world, object, depth);
        }
    }

    void visit_one(const xml_node& node, const Mat4& world, const std::string& object, int depth) {
        const std::string_view kind = node.name();
        if (kind == "Inline" || kind == "ProtoDeclare") skip(kind);
        if (kind == "Shape") return add_shape(node, world, object);
        if (kind != "Transform" && kind != "Group" && kind != "StaticGroup" && kind != "Anchor" &&
            kind != "Collision" && kind != "Switch" && kind != "LOD" && kind != "Billboard")
            return;
        std::string name = object;
        // Names of groups below a named transform say less than its own.
        if (std::string own = name_of(node); !own.empty() && (kind == "Transform" || object.empty())) {
            name = std::move(own);
            for (const std::string_view suffix : {"_ifs_TRANSFORM", "_TRANSFORM"})  // of Blender's exporter
                if (name.ends_with(suffix)) {
                    name.resize(name.size() - suffix.size());
                    break;
                }
        }
        visit(node, kind == "Transform" ? world * transform_of(node) : world, name, depth + 1);
    }

    std::uint32_t material_of(const xml_node& appearance) {
        const xml_node material = child(appearance, "Material"), picture = child(appearance, "ImageTexture");
        if (!material && !picture) return kNone;
        const auto key = std::pair(material.hash_value(), picture.hash_value());
        const auto [it, is_new] = materials_.try_emplace(key, static_cast<std::uint32_t>(out_.materials.size()));
        if (!is_new) return it->second;
        FileMaterial m{.name = name_of(material)};
        if (m.name.empty()) m.name = name_of(appearance);
        if (m.name.empty()) m.name = name_of(picture);
        if (m.name.starts_with("MA_")) m.name.erase(0, 3);  // of Blender's exporter
        if (m.name.empty()) m.name = "material " + std::to_string(out_.materials.size() + 1);
        m.colour = Vec3f(vec3_of(material.attribute("diffuseColor"), Vec3(0.8)));
        const auto transparency = NumberList(material.attribute("transparency").value()).next<float>();
        if (transparency && *transparency < 1) m.alpha = 1 - *transparency;
        for (const std::string& name : strings_of(picture.attribute("url").value()))
            if (m.picture.empty() && name.find("://") == name.npos && !name.starts_with("data:")) m.picture = name;
        out_.materials.push_back(std::move(m));
        return it->second;
    }

    void add_shape(const xml_node& shape, const Mat4& world, const std::string& object) {
        const xml_node appearance = child(shape, "Appearance");
        for (const xml_node& c : shape.children()) {
            const xml_node node = target_of(c);
            const std::string_view kind = node.name();
            Geometry g;
            if (kind == "IndexedFaceSet") {
                g.faces = lists_of(node.attribute("coordIndex").value());
                g.face_uvs = lists_of(node.attribute("texCoordIndex").value());
            } else if (kind.ends_with("Set") &&
                       (kind.find("Triangle") != kind.npos || kind.find("Quad") != kind.npos)) {
                g.faces = faces_of(node, kind);
            } else {
                if (!kind.empty() && kind != "Appearance" && !kind.starts_with("Metadata")) skip(kind);
                continue;
            }
            add_geometry(node, std::move(g), material_of(appearance), world, object);
        }
    }

    /// Of sets of triangles and quads, strips and fans.
    Lists faces_of(const xml_node& node, std::string_view kind) const {
        const bool indexed = kind.starts_with("Indexed");
        const bool strip = kind.find("Strip") != kind.npos, fan = kind.find("Fan") != kind.npos;
        Lists runs;
        if (indexed) {
            runs = lists_of(node.attribute("index").value());
        } else {
            // The points in the order of the file, in runs of so many each.
            const std::size_t n = numbers_of(child(node, "Coordinate").attribute("point").value()).size() / 3;
            std::vector<double> counts = numbers_of(node.attribute(strip ? "stripCount" : "fanCount").value());
            if (!strip && !fan) counts = {static_cast<double>(n)};
            std::size_t at = 0;
            for (const double count : counts) {
                std::vector<std::int32_t>& run = runs.emplace_back();
                for (double k = 0; k < count && at < n; ++k) run.push_back(static_cast<std::int32_t>(at++));
            }
        }
        const std::size_t each = kind.find("Quad") != kind.npos ? 4 : 3;
        Lists out;
        for (const std::vector<std::int32_t>& run : runs) {
            if (strip || fan) {
                for (std::size_t i = 2; i < run.size(); ++i)
                    out.push_back(fan            ? std::vector{run[0], run[i - 1], run[i]}
                                  : (i % 2 == 0) ? std::vector{run[i - 2], run[i - 1], run[i]}
                                                 : std::vector{run[i - 1], run[i - 2], run[i]});
                continue;
            }
            for (std::size_t i = 0; i + each <= run.size(); i += each)
                out.emplace_back(run.begin() + static_cast<std::ptrdiff_t>(i),
                                 run.begin() + static_cast<std::ptrdiff_t>(i + each));
        }
        return out;
    }

    void add_geometry(const xml_node& node, Geometry g, std::uint32_t material, const Mat4& world,
                      const std::string& object) {
        g.points = numbers_of(child(node, "Coordinate").attribute("point").value());
        g.uvs = numbers_of(child(node, "TextureCoordinate").attribute("point").value());
        if (xml_node colour = child(node, "Color")) g.colours = numbers_of(colour.attribute("color").value());
        if (xml_node colour = child(node, "ColorRGBA")) {
            g.colours = numbers_of(colour.attribute("color").value());
            g.channels = 4;
        }
        const std::string_view per_vertex = node.attribute("colorPerVertex").value();
        if (per_vertex == "false" || node.attribute("colorIndex")) g.colours.clear();
        const std::size_t n = g.points.size() / 3;
        const auto base = static_cast<std::uint32_t>(out_.points.size());
        if (out_.points.size() + n > kMostCorners) throw Error(file_, "has too many vertices");
        for (std::size_t i = 0; i < n; ++i)
            out_.points.push_back(
                Vec3(world * glm::dvec4(g.points[3 * i], g.points[3 * i + 1], g.points[3 * i + 2], 1)));
        add_colours(g, base, n);
        const bool clockwise = std::string_view(node.attribute("ccw").value()) == "false";
        const bool turned = clockwise != (glm::determinant(glm::dmat3(world)) < 0);
        if (g.faces.empty()) return;
        const auto [it, is_new] =
            part_index_.try_emplace({object, material}, static_cast<std::uint32_t>(out_.parts.size()));
        if (is_new) out_.parts.push_back({.object = object, .material = material});
        add_faces(g, base, it->second, turned);
    }

    void add_faces(const Geometry& g, std::uint32_t base, std::uint32_t part, bool turned) {
        const std::size_t n = g.points.size() / 3;
        std::vector<std::uint32_t> corners;
        std::vector<Vec2f> uvs;
        for (std::size_t f = 0; f < g.faces.size(); ++f) {
            const std::vector<std::int32_t>& face = g.faces[f];
            const std::vector<std::int32_t>& at = f < g.face_uvs.size() ? g.face_uvs[f] : face;
            const bool has_uvs = !g.uvs.empty() && at.size() == face.size() && (g.face_uvs.empty() || &at != &face);
            if (out_.corners.size() + face.size() > kMostCorners) throw Error(file_, "has too many faces");
            corners.clear();
            uvs.clear();
            for (std::size_t k = 0; k < face.size(); ++k) {
                const std::size_t c = turned ? face.size() - 1 - k : k;
                if (static_cast<std::size_t>(face[c]) >= n)
                    throw Error(file_, Message("a face uses point {}, but there are only {}", face[c], n));
                corners.push_back(base + static_cast<std::uint32_t>(face[c]));
                const auto uv = has_uvs ? 2 * static_cast<std::size_t>(at[c]) : g.uvs.size();
                if (has_uvs)
                    uvs.push_back(uv + 1 < g.uvs.size()
                                      ? Vec2f(static_cast<float>(g.uvs[uv]), static_cast<float>(g.uvs[uv + 1]))
                                      : Vec2f(NAN));
            }
            out_.add_polygon(part, corners, uvs);
        }
    }

    void add_colours(const Geometry& g, std::uint32_t base, std::size_t n) {
        if (g.colours.empty()) return;
        out_.colours.resize(base, {255, 255, 255, 255});
        for (std::size_t i = 0; i < n; ++i) {
            std::array<std::uint8_t, 4> bytes{255, 255, 255, 255};
            for (std::size_t c = 0; c < 3; ++c) {
                const std::size_t at = i * g.channels + c;
                if (at < g.colours.size() && g.colours[at] >= 0)
                    bytes[c] = static_cast<std::uint8_t>(std::lround(255 * std::min(g.colours[at], 1.0)));
            }
            out_.colours.push_back(bytes);
        }
    }

    const pugi::xml_document& document_;
    std::string file_;
    std::map<std::string, xml_node, std::less<>> defined_;
    std::map<std::pair<std::size_t, std::size_t>, std::uint32_t> materials_;
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> part_index_;
    std::set<std::string> skipped_;
    FileScene out_;
    std::size_t visited_ = 0;
};

}  // namespace

mesh::PolygonSoup read_x3d(const std::vector<char>& bytes, const std::filesystem::path& path) {
    pugi::xml_document document;
    const auto parsed = document.load_buffer(bytes.data(), bytes.size());
    if (!parsed) throw Error(path.string(), Message("not well-formed XML: {}", xml_fault(parsed)));
    return read_x3d_tree(document, path);
}

mesh::PolygonSoup read_x3d_tree(const pugi::xml_document& document, const std::filesystem::path& path) {
    return soup_of(Reader(document, path.string()).run(), path);
}

}  // namespace tuft::io
