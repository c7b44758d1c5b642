#include "brush/preset/geometry.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "core/error.h"
#include "core/files/files.h"
#include "mesh/read/text_cursor.h"

namespace tuft::brush {

namespace {

namespace fs = std::filesystem;

class GeometryReader {
  public:
    GeometryReader(std::string_view text, const std::string& source)
        : source_(source), text_({text.data(), text.size()}, source, {.comment = '#', .continuation = true}) {}

    Geometry read() {
        while (text_.skip_to_token()) {
            const std::string_view key = text_.word();
            if (key == "v")
                read_point();
            else if (key == "f")
                read_face();
            else if (key == "l")
                read_line();
            text_.next_line();
        }
        if (out_.triangles.empty() == out_.lines.empty())
            throw Error(source_, "a geometry has either faces (f) or lines (l)");
        if (!out_.triangles.empty()) check_closed();
        return std::move(out_);
    }

  private:
    void read_point() {
        Vec3 p;
        for (int k = 0; k < 3; ++k) p[k] = text_.number("a coordinate");
        if (!(std::abs(p.x) <= kLargestGeometry && std::abs(p.y) <= kLargestGeometry &&
              std::abs(p.z) <= kLargestGeometry))
            text_.fail(Message("a point must be within {} mm of the mouth", static_cast<int>(kLargestGeometry)));
        if (out_.points.size() == kMostPoints) text_.fail(Message("a geometry has at most {} points", kMostPoints));
        out_.points.push_back(p + 0.0);
    }

    /// Of `v`, `v/vt`, `v//vn`, `v/vt/vn` only the point counts.
    std::uint32_t read_index() {
        const std::string_view token = text_.word();
        std::int64_t at = 0;
        const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), at);
        if (error != std::errc() || (end != token.data() + token.size() && *end != '/'))
            text_.fail(Message("{} is not a point number", mesh::in_quotes(token)));
        const auto n = static_cast<std::int64_t>(out_.points.size());
        if (at < 0 && at >= -n) return static_cast<std::uint32_t>(n + at);
        if (at <= 0 || at > n) text_.fail(Message("point {} does not exist above this line", at));
        return static_cast<std::uint32_t>(at - 1);
    }

    void read_face() {
        const std::uint32_t first = read_index();
        std::uint32_t last = read_index(), corners = 2;
        for (; text_.more(); ++corners) {
            const std::uint32_t next = read_index();
            if (out_.triangles.size() == kMostTriangles)
                text_.fail(Message("a geometry has at most {} triangles", kMostTriangles));
            if (first != last && last != next && next != first) out_.triangles.push_back({first, last, next});
            last = next;
        }
        if (corners < 3) text_.fail("a face needs three points");
    }

    void read_line() {
        std::vector<std::uint32_t> line;
        while (text_.more()) {
            line.push_back(read_index());
            if (++line_points_ > kMostPoints) text_.fail(Message("a geometry has at most {} points", kMostPoints));
        }
        if (line.size() < 2) text_.fail("a line needs two points");
        out_.lines.push_back(std::move(line));
    }

    /// Each edge belongs to one triangle on each side, and the volume is positive.
    void check_closed() const {
        std::vector<std::pair<std::uint32_t, std::uint32_t>> there, back;
        double volume = 0;
        for (const auto& t : out_.triangles) {
            for (int k = 0; k < 3; ++k) {
                there.emplace_back(t[k], t[(k + 1) % 3]);
                back.emplace_back(t[(k + 1) % 3], t[k]);
            }
            volume += glm::dot(out_.points[t[0]], glm::cross(out_.points[t[1]], out_.points[t[2]]));
        }
        std::sort(there.begin(), there.end());
        std::sort(back.begin(), back.end());
        if (there != back || std::adjacent_find(there.begin(), there.end()) != there.end())
            throw Error(source_,
                        "the surface of a geometry must be closed and turned one way: every edge between two faces");
        if (!(volume > 0)) throw Error(source_, "the surface of a geometry must not be inside out");
    }

    const std::string& source_;
    mesh::TextCursor text_;
    Geometry out_;
    std::size_t line_points_ = 0;
};

}  // namespace

Box Geometry::bounds() const {
    Box box;
    for (const Vec3& p : points) box.add(p);
    return box;
}

Geometry parse_geometry(std::string_view text, const std::string& source) {
    if (text.size() > kMostGeometryBytes)
        throw Error(source, Message("a geometry has at most {} bytes", kMostGeometryBytes));
    return GeometryReader(text, source).read();
}

Geometry read_geometry(const fs::path& folder, const std::string& name, const std::string& source) {
    const fs::path own = folder.empty() ? fs::path(".") : folder, file = own / name;
    std::error_code ec;
    const fs::path root = fs::weakly_canonical(own, ec);
    const fs::path whole = ec ? fs::path{} : fs::weakly_canonical(file, ec);
    const bool inside = !ec && !fs::path(name).is_absolute() &&
                        std::mismatch(root.begin(), root.end(), whole.begin(), whole.end()).first == root.end();
    if (!inside) throw Error(source, Message("the geometry \"{}\" must lie in the folder of the brush", name));
    const std::vector<char> bytes = read_file(file, kMostGeometryBytes);
    return parse_geometry({bytes.data(), bytes.size()}, file.string());
}

std::string geometry_text(const Geometry& geometry) {
    std::string out;
    char text[96];
    for (const Vec3& p : geometry.points) {
        std::snprintf(text, sizeof text, "v %.9g %.9g %.9g\n", p.x, p.y, p.z);
        out += text;
    }
    for (const auto& t : geometry.triangles) {
        std::snprintf(text, sizeof text, "f %u %u %u\n", t[0] + 1, t[1] + 1, t[2] + 1);
        out += text;
    }
    for (const std::vector<std::uint32_t>& line : geometry.lines) {
        out += "l";
        for (const std::uint32_t i : line) out += " " + std::to_string(i + 1);
        out += "\n";
    }
    return out;
}

Geometry scaled(const Geometry& geometry, double factor) {
    Geometry out = geometry;
    for (Vec3& p : out.points) p *= factor;
    return out;
}

}  // namespace tuft::brush
