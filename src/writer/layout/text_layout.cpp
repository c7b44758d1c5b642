#include "writer/layout/text_layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "core/error.h"
#include "core/text/units.h"

namespace tuft::writer {
namespace {

constexpr double kBetweenScripts = 0.25;  // parts of the side

/// Length that a glyph takes on its line or in its column, metres.
double advance_of(const Glyph& glyph, const LayoutOptions& options) {
    const double own = options.direction == Direction::vertical ? glyph.down : glyph.advance;
    return (options.spacing * own + glyph.after) / kSide * options.side;
}

struct CodeRange {
    char32_t first, last;
};
template <std::size_t N>
bool is_in(const CodeRange (&ranges)[N], char32_t code) {
    return std::any_of(std::begin(ranges), std::end(ranges),
                       [&](const CodeRange& r) { return code >= r.first && code <= r.last; });
}

bool is_without_form(char32_t c) {
    static constexpr CodeRange kRanges[] = {{0xAD, 0xAD},     {0x200B, 0x200F}, {0x202A, 0x202E},  {0x2060, 0x2064},
                                            {0xFE00, 0xFE0F}, {0xFEFF, 0xFEFF}, {0xE0100, 0xE01EF}};
    return is_in(kRanges, c);
}

/// Han characters and kana, without punctuation.
bool is_han_or_kana(char32_t c) {
    static constexpr CodeRange kRanges[] = {{0x3005, 0x3007}, {0x3041, 0x3096}, {0x30A1, 0x30FA}};
    return is_han(c) || is_in(kRanges, c);
}

/// Letters of Latin, Greek and Cyrillic, and digits.
bool is_western(char32_t c) {
    static constexpr CodeRange kRanges[] = {{'0', '9'},   {'A', 'Z'},    {'a', 'z'},     {0xC0, 0xD6},
                                            {0xD8, 0xF6}, {0xF8, 0x24F}, {0x370, 0x52F}, {0x1E00, 0x1FFF}};
    return is_in(kRanges, c);
}

/// Middle of a glyph's ink, units.
Vec2 middle_of_ink(const Glyph& glyph) {
    Vec2 lo(1e300), hi(-1e300);
    const auto add = [&](const std::vector<Vec2>& points) {
        for (const Vec2& p : points) lo = glm::min(lo, p), hi = glm::max(hi, p);
    };
    for (const Ring& ring : glyph.area) add(ring);
    for (const GlyphStroke& s : glyph.strokes) add(s.median);
    return lo.x <= hi.x ? 0.5 * (lo + hi) : Vec2(0.5 * kSide);
}

/// A segment of the section in a triangle: crossed edges as keys of their vertices.
struct Crossing {
    std::uint64_t edge = 0;
    Vec3 at{0};
};

std::uint64_t edge_key(std::uint32_t a, std::uint32_t b) {
    return (std::uint64_t{std::min(a, b)} << 32) | std::max(a, b);
}

struct SectionPart {
    Crossing from, to;
    bool used = false;
};

/// Crosses every triangle with the plane z = level; vertices on it count as above.
std::vector<SectionPart> section_parts(const mesh::TriangleMesh& mesh, double level) {
    std::vector<SectionPart> parts;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        Crossing found[2];
        int n = 0;
        for (int k = 0; k < 3; ++k) {
            const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
            const Vec3 p(mesh.positions[a]), q(mesh.positions[b]);
            if ((p.z < level) == (q.z < level) || n == 2) continue;
            // The same point from both sides of an edge.
            const Vec3 lo = a < b ? p : q, hi = a < b ? q : p;
            found[n++] = {edge_key(a, b), lo + (level - lo.z) / (hi.z - lo.z) * (hi - lo)};
        }
        if (n == 2) parts.push_back({found[0], found[1]});
    }
    return parts;
}

/// Follows parts from one on, over shared edges.
std::vector<Vec3> follow(std::vector<SectionPart>& parts, std::size_t first,
                         const std::unordered_multimap<std::uint64_t, std::size_t>& by_edge, bool& closed) {
    const auto walk = [&](std::uint64_t edge, std::vector<Vec3>& line) {
        const std::uint64_t begin = edge;
        for (bool found = true; found;) {
            found = false;
            for (auto [at, end] = by_edge.equal_range(edge); at != end; ++at) {
                SectionPart& part = parts[at->second];
                if (part.used) continue;
                part.used = found = true;
                const Crossing& next = part.from.edge == edge ? part.to : part.from;
                line.push_back(next.at);
                edge = next.edge;
                break;
            }
        }
        return edge == begin;
    };
    SectionPart& part = parts[first];
    part.used = true;
    std::vector<Vec3> on{part.to.at}, back{part.from.at};
    walk(part.to.edge, on);
    const bool ring = glm::distance(on.back(), part.from.at) < 1e-12;
    closed = ring;
    if (!ring) walk(part.from.edge, back);
    std::reverse(back.begin(), back.end());
    if (ring) back.clear();
    back.insert(back.end(), on.begin(), on.end());
    return back;
}

}  // namespace

std::optional<Direction> direction_named(std::string_view name) {
    const auto at = std::find(kDirectionNames.begin(), kDirectionNames.end(), name);
    if (at == kDirectionNames.end()) return std::nullopt;
    return static_cast<Direction>(at - kDirectionNames.begin());
}

std::vector<std::u32string> lines_of(std::string_view text) {
    std::u32string all = characters_of(text), line;
    std::vector<std::u32string> lines;
    for (std::size_t i = 0; i < all.size(); ++i) {
        const bool written = all[i] == '\\' && i + 1 < all.size() && all[i + 1] == 'n';
        if (all[i] == '\n' || written) {
            lines.push_back(std::move(line));
            line.clear();
            i += written ? 1 : 0;
        } else if (all[i] != '\r' && !is_without_form(all[i])) {
            line.push_back(all[i]);
        }
    }
    lines.push_back(std::move(line));
    return lines;
}

ColumnForm column_form(char32_t code) {
    // Punctuation, then the small kana.
    static constexpr CodeRange kCorner[] = {
        {0x3001, 0x3002}, {0xFF0C, 0xFF0C}, {0xFF0E, 0xFF0E}, {0x3041, 0x3041}, {0x3043, 0x3043}, {0x3045, 0x3045},
        {0x3047, 0x3047}, {0x3049, 0x3049}, {0x3063, 0x3063}, {0x3083, 0x3083}, {0x3085, 0x3085}, {0x3087, 0x3087},
        {0x308E, 0x308E}, {0x3095, 0x3096}, {0x30A1, 0x30A1}, {0x30A3, 0x30A3}, {0x30A5, 0x30A5}, {0x30A7, 0x30A7},
        {0x30A9, 0x30A9}, {0x30C3, 0x30C3}, {0x30E3, 0x30E3}, {0x30E5, 0x30E5}, {0x30E7, 0x30E7}, {0x30EE, 0x30EE},
        {0x30F5, 0x30F6}, {0x31F0, 0x31FF}};
    static constexpr CodeRange kSideways[] = {
        {0x20, 0xA6},     {0xA8, 0xA8},     {0xAA, 0xAD},     {0xAF, 0xB0},     {0xB2, 0xBB},     {0xBF, 0xD6},
        {0xD8, 0xF6},     {0xF8, 0x2E9},    {0x2EC, 0x10FF},  {0x1E00, 0x200F}, {0x2010, 0x2015}, {0x2018, 0x201F},
        {0x2024, 0x2027}, {0x202A, 0x202F}, {0x2032, 0x203A}, {0x2190, 0x2193}, {0x3008, 0x3011}, {0x3014, 0x301F},
        {0x3030, 0x3030}, {0x30A0, 0x30A0}, {0x30FC, 0x30FC}, {0xFF08, 0xFF09}, {0xFF0D, 0xFF0D}, {0xFF1A, 0xFF1E},
        {0xFF3B, 0xFF3B}, {0xFF3D, 0xFF3D}, {0xFF3F, 0xFF3F}, {0xFF5B, 0xFF60}};
    if (is_in(kCorner, code)) return ColumnForm::corner;
    return is_in(kSideways, code) ? ColumnForm::sideways : ColumnForm::upright;
}

Glyph in_column(Glyph glyph) {
    switch (column_form(glyph.code)) {
        case ColumnForm::upright:
            break;
        case ColumnForm::corner: {
            const Vec2 shift = Vec2(glyph.advance, kSide) - 2.0 * middle_of_ink(glyph);
            map_points(glyph, [&](const Vec2& p) { return p + shift; });
            break;
        }
        case ColumnForm::sideways:
            map_points(glyph, [&](const Vec2& p) { return Vec2(p.y, glyph.advance - p.x); });
            glyph.down = glyph.advance;
            glyph.advance = kSide;
            glyph.sideways = true;
            break;
    }
    return glyph;
}

void space_scripts(std::vector<Glyph>& line) {
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const char32_t a = line[i].code, b = line[i + 1].code;
        if ((is_han_or_kana(a) && is_western(b)) || (is_western(a) && is_han_or_kana(b)))
            line[i].after = kBetweenScripts * kSide;
    }
}

std::vector<std::vector<Vec2>> place_in_lines(const std::vector<std::vector<Glyph>>& lines,
                                              const LayoutOptions& options) {
    const bool columns = options.direction == Direction::vertical;
    const double unit = options.side / kSide;
    std::vector<std::vector<Vec2>> out;
    for (std::size_t l = 0; l < lines.size(); ++l) {
        double whole = 0;
        for (const Glyph& g : lines[l]) whole += advance_of(g, options);
        std::vector<Vec2>& row = out.emplace_back();
        double at = -0.5 * whole;
        const double line = static_cast<double>(l) * options.line_spacing * options.side;
        for (const Glyph& g : lines[l]) {
            const double step = advance_of(g, options), room = step - unit * g.after;
            // Corners are at the lower left, y down.
            if (columns)
                row.emplace_back(-line - 0.5 * unit * g.advance, at + 0.5 * (room + unit * g.down));
            else
                row.emplace_back(at + 0.5 * (room - unit * g.advance), line + 0.5 * options.side);
            at += step;
        }
    }
    return out;
}

double ModelPath::length() const {
    double length = 0;
    for (std::size_t i = 1; i < points.size(); ++i) length += glm::distance(points[i], points[i - 1]);
    if (closed && points.size() > 1) length += glm::distance(points.back(), points.front());
    return length;
}

namespace {

struct PathPoint {
    Vec3 position{0}, normal{0, 0, 1};
};
PathPoint point_on(const ModelPath& path, double along) {
    const double whole = path.length();
    along = path.closed ? along - whole * std::floor(along / whole) : std::clamp(along, 0.0, whole);
    const std::size_t n = path.points.size(), pieces = path.closed ? n : n - 1;
    for (std::size_t i = 0; i < pieces; ++i) {
        const std::size_t k = i + 1 < n ? i + 1 : 0;
        const double piece = glm::distance(path.points[k], path.points[i]);
        if (along <= piece || i + 1 == pieces) {
            const double f = piece > 0 ? std::min(along / piece, 1.0) : 0;
            return {glm::mix(path.points[i], path.points[k], f),
                    glm::normalize(glm::mix(path.normals[i], path.normals[k], f))};
        }
        along -= piece;
    }
    return {path.points.front(), path.normals.front()};
}

}  // namespace

PathPlace place_on(const ModelPath& path, double along, double reach) {
    const PathPoint at = point_on(path, along);
    const Vec3 d = point_on(path, along + reach).position - point_on(path, along - reach).position;
    const Vec3 right = d - glm::dot(d, at.normal) * at.normal;
    const double size = glm::length(right);
    return {at.position, size > 1e-12 ? right / size : make_frame(Vec3(0), at.normal).t, at.normal};
}

std::vector<double> place_along(const ModelPath& path, const std::vector<Glyph>& glyphs, double middle,
                                const LayoutOptions& options) {
    double whole = 0;
    for (const Glyph& g : glyphs) whole += advance_of(g, options);
    if (const double room = path.length(); whole > room * (1 + 1e-9))
        throw Error(Message("the text is {} mm long, the path on the model {} mm",
                            fmt::format("{:.1f}", whole / kMillimetre), fmt::format("{:.1f}", room / kMillimetre)));
    std::vector<double> out;
    double at = middle - 0.5 * whole;
    for (const Glyph& g : glyphs) {
        const double step = advance_of(g, options);
        out.push_back(at + 0.5 * (step - g.after / kSide * options.side));
        at += step;
    }
    return out;
}

ModelPath level_section(const mesh::SurfaceQuery& query, const Vec3& through) {
    const mesh::TriangleMesh& mesh = query.mesh();
    std::vector<SectionPart> parts = section_parts(mesh, through.z);
    if (parts.empty()) throw Error(Message("no surface lies at the height of the text (see --place)"));
    std::unordered_multimap<std::uint64_t, std::size_t> by_edge;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        by_edge.emplace(parts[i].from.edge, i);
        by_edge.emplace(parts[i].to.edge, i);
    }
    std::size_t nearest = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
        if (glm::distance(parts[i].from.at, through) < glm::distance(parts[nearest].from.at, through)) nearest = i;
    ModelPath path;
    const Vec3 begin = parts[nearest].from.at;
    path.points = follow(parts, nearest, by_edge, path.closed);
    for (const Vec3& p : path.points) {
        const auto on = query.closest_point(p);
        path.normals.push_back(on ? on->normal : Vec3(0, 0, 1));
    }
    const auto first =
        static_cast<std::ptrdiff_t>(std::min_element(path.points.begin(), path.points.end(),
                                                     [&](const Vec3& a, const Vec3& b) {
                                                         return glm::distance(a, begin) < glm::distance(b, begin);
                                                     }) -
                                    path.points.begin());
    const std::size_t k = static_cast<std::size_t>(first), next = k + 1 < path.points.size() ? k + 1 : k - 1;
    const Vec3 ahead = (k + 1 < path.points.size() ? 1.0 : -1.0) * (path.points[next] - path.points[k]);
    if (path.closed) {
        std::rotate(path.points.begin(), path.points.begin() + first, path.points.end());
        std::rotate(path.normals.begin(), path.normals.begin() + first, path.normals.end());
    }
    if (glm::dot(ahead, glm::cross(Vec3(0, 0, 1), path.normals[path.closed ? 0 : k])) < 0) {
        std::reverse(path.points.begin(), path.points.end());
        std::reverse(path.normals.begin(), path.normals.end());
        if (path.closed) {  // the first point stays the first
            std::rotate(path.points.begin(), path.points.end() - 1, path.points.end());
            std::rotate(path.normals.begin(), path.normals.end() - 1, path.normals.end());
        }
    }
    return path;
}

}  // namespace tuft::writer
