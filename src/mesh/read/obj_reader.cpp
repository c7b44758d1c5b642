#include <algorithm>
#include <charconv>
#include <unordered_set>

#include "core/error.h"
#include "core/text/text.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/read/soup_builder.h"
#include "mesh/read/text_cursor.h"

// Wavefront OBJ as in "Object Files (.obj)", Wavefront Technologies, Appendix B1, with what
// programs add to it: vertex colours after the position, inline comments.
namespace tuft::mesh {
namespace {

class ObjReader {
  public:
    ObjReader(const std::vector<char>& bytes, const std::string& file)
        : file_(file), text_(bytes, file, {.comment = '#', .continuation = true}), builder_(file, "line") {}

    PolygonSoup read() {
        while (text_.skip_to_token()) {
            read_line();
            text_.next_line();
        }
        const std::size_t n = builder_.soup.points.size();
        if (highest_ > n)
            throw Error(file_, highest_line_,
                        Message("the face uses vertex {}, but the file has only {}", highest_, n));
        if (free_form_.count)
            builder_.soup.warnings.push_back(
                free_form_.text("lines of free-form curves or surfaces are not read", "line"));
        if (bad_uv_index_.count)
            builder_.soup.warnings.push_back(
                bad_uv_index_.text("faces use texture coordinates that do not exist", "line"));
        finish_colours();
        PolygonSoup soup = builder_.finish();
        if (soup.material_libraries.empty()) soup.material_names.clear();
        name_parts(soup);
        return soup;
    }

  private:
    void read_line();
    void read_vertex();
    void read_face();
    void read_corner();
    void set_group(std::string& part);
    std::uint32_t current_group();
    void name_parts(PolygonSoup& soup) const;
    void report_empty(PolygonSoup& soup) const;
    void finish_colours();
    std::uint32_t point_index(std::int64_t written);

    /// What `o`, `g` and `usemtl` named last, and the groups so far.
    struct Groups {
        std::string object, group, material;
        std::uint32_t current = kNone;
        bool changed = false;
        std::vector<ScenePart> parts;                     ///< by group
        std::vector<std::string> named;                   ///< objects and groups, in the order of the file
        std::unordered_set<std::string> seen, has_faces;  ///< the same, and those with faces
    };
    /// The face being read.
    struct Face {
        std::vector<std::uint32_t> corners;
        std::vector<Vec2f> uvs;
        bool uv_missing = false;
    };

    std::string file_;
    TextCursor text_;
    SoupBuilder builder_;
    std::vector<Vec2f> uvs_;
    std::vector<Vec3f> colours_;
    Groups groups_;
    Face face_;
    std::size_t highest_ = 0;  ///< highest vertex number used by a face before it was read,
    long highest_line_ = 0;    ///< and where
    Tally free_form_, bad_uv_index_;
};

void ObjReader::read_line() {
    const std::string_view key = text_.word();
    if (same_word(key, "v")) {
        read_vertex();
    } else if (same_word(key, "f") || same_word(key, "fo")) {
        read_face();
    } else if (same_word(key, "vt")) {
        const double u = text_.number("a texture coordinate");
        const double v = text_.more() ? text_.number("a texture coordinate") : 0.0;
        uvs_.emplace_back(u, v);
    } else if (same_word(key, "o")) {
        set_group(groups_.object);
    } else if (same_word(key, "g")) {
        set_group(groups_.group);
    } else if (same_word(key, "usemtl")) {
        set_group(groups_.material);
    } else if (same_word(key, "mtllib")) {
        builder_.soup.material_libraries.emplace_back(text_.rest());
    } else if (same_word(key, "curv") || same_word(key, "curv2") || same_word(key, "surf")) {
        free_form_.add(text_.line());
    }
}

void ObjReader::set_group(std::string& part) {
    part = std::string(text_.rest());
    if (const std::size_t comment = part.find(" #"); comment != part.npos) part.resize(comment);
    groups_.changed = true;
    if (&part != &groups_.material && !part.empty() && groups_.seen.insert(part).second) groups_.named.push_back(part);
}

/// Groups are made by their first face: `o`, `g` and `usemtl` one after the other name one, not
/// three.
std::uint32_t ObjReader::current_group() {
    if (!groups_.changed) return groups_.current;
    groups_.changed = false;
    std::string name;
    for (const std::string* s : {&groups_.object, &groups_.group, &groups_.material})
        if (!s->empty() && *s != name) name += (name.empty() ? "" : " / ") + *s;
    for (const std::string* s : {&groups_.object, &groups_.group}) groups_.has_faces.insert(*s);
    groups_.current = name.empty() ? kNone : builder_.group(name, groups_.material);
    if (groups_.current != kNone && groups_.current == groups_.parts.size())
        groups_.parts.push_back({.object = to_utf8(groups_.object),
                                 .group = to_utf8(groups_.group),
                                 .material = to_utf8(groups_.material)});
    return groups_.current;
}

void ObjReader::name_parts(PolygonSoup& soup) const {
    report_empty(soup);
    if (soup.group_names.empty()) return;
    soup.scene = std::make_shared<SourceScene>();
    soup.scene->parts = groups_.parts;
    soup.scene->parts.resize(soup.group_names.size());
}

void ObjReader::report_empty(PolygonSoup& soup) const {
    constexpr std::size_t kMostNames = 5;
    std::string names;
    std::size_t n = 0;
    for (const std::string& name : groups_.named) {
        // Maya writes "g default" before the vertices of each object.
        if (groups_.has_faces.contains(name) || name == "default") continue;
        if (++n <= kMostNames) names += (n > 1 ? ", " : "") + in_quotes(name);
    }
    if (n > kMostNames) names += ", ...";
    if (n > 0)
        soup.warnings.push_back(Message(
            n == 1 ? "{} group has no faces and is left out: {}" : "{} groups have no faces and are left out: {}", n,
            names));
}

void ObjReader::read_vertex() {
    const long line = text_.line();
    double values[7];
    int n = 0;
    while (n < 7 && text_.more()) values[n++] = text_.number("a coordinate");
    if (n < 3) text_.fail("a vertex needs three coordinates");
    builder_.add_point({values[0], values[1], values[2]}, line);
    if (n >= 6) {  // x y z r g b, or x y z w r g b
        colours_.resize(builder_.soup.points.size() - 1, Vec3f(1));
        colours_.emplace_back(values[n - 3], values[n - 2], values[n - 1]);
    }
}

std::uint32_t ObjReader::point_index(std::int64_t written) {
    const auto n = static_cast<std::int64_t>(builder_.soup.points.size());
    if (written < 0 && written >= -n) return static_cast<std::uint32_t>(n + written);
    if (written <= 0 || written >= kNone) text_.fail(Message("the face uses vertex {}, which does not exist", written));
    if (written > n && static_cast<std::size_t>(written) > highest_) {
        highest_ = static_cast<std::size_t>(written);
        highest_line_ = text_.line();
    }
    return static_cast<std::uint32_t>(written - 1);
}

/// One of `v`, `v/vt`, `v//vn`, `v/vt/vn`; the normal is not used.
void ObjReader::read_corner() {
    const std::string_view token = text_.word();
    const char* end = token.data() + token.size();
    std::int64_t position = 0, uv = 0;
    auto [p, ec] = std::from_chars(token.data(), end, position);
    if (ec != std::errc()) text_.fail(Message("{} is not a vertex number", in_quotes(token)));
    if (p != end && *p == '/' && p + 1 != end && p[1] != '/') {
        const auto second = std::from_chars(p + 1, end, uv);
        p = second.ptr;
    }
    if (p != end && *p != '/' && *p != '#')
        text_.fail(Message("{} is not a face corner such as 1, 1/2 or 1/2/3", in_quotes(token)));
    face_.corners.push_back(point_index(position));
    const auto n = static_cast<std::int64_t>(uvs_.size());
    const std::int64_t i = uv < 0 ? n + uv : uv - 1;
    const bool exists = uv != 0 && i >= 0 && i < n;
    if (uv != 0 && !exists) bad_uv_index_.add(text_.line());
    face_.uv_missing = face_.uv_missing || !exists;
    face_.uvs.push_back(exists ? uvs_[static_cast<std::size_t>(i)] : Vec2f(0));
}

void ObjReader::read_face() {
    const long line = text_.line();
    face_.corners.clear();
    face_.uvs.clear();
    face_.uv_missing = false;
    while (text_.more()) read_corner();
    if (face_.uv_missing) face_.uvs.clear();
    builder_.add_polygon(face_.corners, face_.uvs, current_group(), line);
}

void ObjReader::finish_colours() {
    if (colours_.empty()) return;
    colours_.resize(builder_.soup.points.size(), Vec3f(1));
    const bool is_real =
        std::all_of(colours_.begin(), colours_.end(), [](const Vec3f& c) { return !(c.r > 1 || c.g > 1 || c.b > 1); });
    builder_.soup.point_colours.reserve(colours_.size());
    for (const Vec3f& c : colours_)
        builder_.soup.point_colours.push_back(colour_from({c.r, c.g, c.b, is_real ? 1.0 : 255.0}, is_real));
}

}  // namespace

PolygonSoup read_obj(const std::vector<char>& bytes, const std::filesystem::path& path) {
    return ObjReader(bytes, path.string()).read();
}

}  // namespace tuft::mesh
