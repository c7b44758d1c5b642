#include "writer/copy/copied_glyph.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/text/units.h"
#include "writer/copy/photo.h"
#include "writer/gesture/sides.h"

namespace tuft::writer {
namespace {

constexpr double kTrim = 0.45;         // of a piece at most, cut off at a junction
constexpr double kApart = 4;           // units between points of a line
constexpr std::size_t kDirection = 8;  // points of an arm of a corner over which its direction is taken
constexpr int kRingPasses = 8;         // smoothing of outlines
constexpr double kLeastHalf = 1;       // units
constexpr double kLongestHead = 90;    // units
constexpr double kCornerHead = 1.25;   // of the half width: a corner lies so far from the middle of a head
constexpr double kAlong = 0.1;         // cosine to the way of the stroke above which a ray runs along it
constexpr int kCurvePoints = 8;        // of the curve of a head
constexpr double kInset = 12;          // units between the begin of a centre line and the edge

constexpr double kAreaCell = 2, kAreaMargin = 8;  // units, of the cells of a font's area
constexpr double kMostAreaInk = kSide * kSide;    // units², of a font's character: its whole square
constexpr std::size_t kMostAreaLines = 1024;      // that thinning leaves of one
constexpr double kMostAreaWork = 1e9;             // of its cells and points: a second to divide the cells
constexpr std::size_t kChunk = 16;                // points whose distances are bounded together

/// The centre line of a stroke with half widths. `through`: where it runs through a junction.
struct CopiedLine {
    std::vector<Station> points;
    std::vector<std::uint8_t> through;
};

/// A piece as it is written, without what lies within the discs of junctions at the ends that are cut.
std::vector<Vec2> cut_line(const Piece& piece, bool reversed, double head, double tail) {
    std::vector<Vec2> line = piece.line;
    if (reversed) std::reverse(line.begin(), line.end());
    const double whole = piece.length();
    head = std::min(head, kTrim * whole), tail = std::min(tail, kTrim * whole);
    std::vector<Vec2> out;
    double along = 0;
    for (std::size_t i = 0; i < line.size(); ++i) {
        if (i > 0) along += glm::distance(line[i], line[i - 1]);
        if (along >= head && along <= whole - tail) out.push_back(line[i]);
    }
    return out.empty() ? line : out;
}

/// Where the two arms of a corner, continued straight on, meet; nothing if that is farther away than `most`, or where
/// an arm is a single point.
std::optional<Vec2> corner_of(const std::vector<Station>& in, const std::vector<Vec2>& on, double most) {
    const std::size_t back = std::min<std::size_t>(in.size() - 1, kDirection),
                      ahead = std::min<std::size_t>(on.size() - 1, kDirection);
    const Vec2 a = in.back().centre, u = a - in[in.size() - 1 - back].centre, b = on.front(), v = b - on[ahead];
    const double cross = u.x * v.y - u.y * v.x;
    if (!(std::abs(cross) > 0.3 * glm::length(u) * glm::length(v))) return std::nullopt;  // nor an arm of one point
    const Vec2 d = b - a;
    const double t = (d.x * v.y - d.y * v.x) / cross, s = (d.x * u.y - d.y * u.x) / cross;
    if (t < 0 || s < 0) return std::nullopt;
    const Vec2 corner = a + t * u;
    return glm::distance(corner, a) > most ? std::nullopt : std::optional(corner);
}

/// Adds points from the end of a line to another one.
void bridge(CopiedLine& line, const Station& to, bool through) {
    const Station from = line.points.back();
    const int n = static_cast<int>(glm::distance(from.centre, to.centre) / kApart);
    for (int i = 1; i <= n; ++i) {
        const double f = i / (n + 1.0);
        line.points.push_back({glm::mix(from.centre, to.centre, f), std::lerp(from.half, to.half, f)});
        line.through.push_back(through);
    }
}

CopiedLine line_of(const Skeleton& s, const std::vector<PieceUse>& stroke, const InkClearance& room) {
    CopiedLine out;
    for (std::size_t k = 0; k < stroke.size(); ++k) {
        const Piece& p = s.pieces[stroke[k].piece];
        const SkeletonNode &from = s.nodes[stroke[k].reversed ? p.to : p.from],
                           &to = s.nodes[stroke[k].reversed ? p.from : p.to];
        const double head = k > 0 ? from.room : 0, tail = k + 1 < stroke.size() ? to.room : 0;
        const std::vector<Vec2> line = cut_line(p, stroke[k].reversed, head, tail);
        if (!out.points.empty()) {
            const bool through = from.n_pieces > 2;
            const Station next{line.front(), std::max(room.at(line.front()), kLeastHalf)};
            if (const auto corner = corner_of(out.points, line, 3 * from.room)) {
                bridge(out, {*corner, out.points.back().half}, through);
                out.points.push_back({*corner, std::max(room.at(*corner), kLeastHalf)});
                out.through.push_back(0);
            }
            bridge(out, next, through);
        }
        for (const Vec2& q : line) {
            if (!out.points.empty() && glm::distance(out.points.back().centre, q) < 0.25 * kApart) continue;
            out.points.push_back({q, std::max(room.at(q), kLeastHalf)});
            out.through.push_back(0);
        }
    }
    if (out.points.size() == 1) {
        out.points.push_back({out.points[0].centre + Vec2(1, 0), out.points[0].half});
        out.through.push_back(0);
    }
    return out;
}

/// Distance from a point to the edge of the ink along a direction.
double ray(const InkClearance& room, const Vec2& p, const Vec2& d) {
    double far = 0;
    while (far < kLongestHead && room.at(p + far * d) > 0) far += 1;
    return far;
}

/// Where a wide head reaches out to the upper left, a brush landed there: the line begins in that corner, and bends
/// into its way. A ray that runs along the stroke finds no corner: a path from there would go to and fro in the head.
void begin_in_corner(CopiedLine& line, const InkClearance& room) {
    std::vector<Station>& p = line.points;
    const Vec2 down = p[std::min<std::size_t>(p.size() - 1, 20)].centre - p[0].centre;
    if (p.size() < 12 || down.y > -0.5 * std::abs(down.x)) return;  // 橫 and 提 begin as they go
    std::size_t head = 0;
    double along = 0;
    for (std::size_t i = 1; i < p.size() / 2; ++i) {
        along += glm::distance(p[i].centre, p[i - 1].centre);
        if (along > kLongestHead) break;
        if (p[i].half > p[head].half) head = i;
    }
    double far = 0;
    Vec2 to(0);
    for (double degrees = 95; degrees <= 200; degrees += 5) {
        const Vec2 d(std::cos(degrees * kDegree), std::sin(degrees * kDegree));
        if (glm::dot(d, down) > kAlong * glm::length(down)) continue;
        if (const double reach = ray(room, p[head].centre, d); reach > far) far = reach, to = d;
    }
    if (far < kCornerHead * p[head].half || far >= kLongestHead) return;
    const Station begin{p[head].centre + (far - kInset) * to, kLeastHalf}, bend = p[head];
    if (glm::distance(begin.centre, p[0].centre) < kInset) return;  // it begins there
    std::size_t end = head;
    while (end + 1 < p.size() / 2 && glm::distance(p[end].centre, bend.centre) < far) ++end;
    const Station joined = p[end];
    std::vector<Station> curve;
    for (int k = 0; k < kCurvePoints; ++k) {
        const double t = static_cast<double>(k) / kCurvePoints, u = 1 - t;
        curve.push_back({u * u * begin.centre + 2 * u * t * bend.centre + t * t * joined.centre,
                         u * u * begin.half + 2 * u * t * bend.half + t * t * joined.half});
    }
    p.erase(p.begin(), p.begin() + static_cast<std::ptrdiff_t>(end));
    line.through.erase(line.through.begin(), line.through.begin() + static_cast<std::ptrdiff_t>(end));
    p.insert(p.begin(), curve.begin(), curve.end());
    line.through.insert(line.through.begin(), curve.size(), 0);
}

double power_of(const Station& q, const Vec2& p) {
    const Vec2 d = p - q.centre;
    return glm::dot(d, d) - q.half * q.half;
}

/// Points of a line beside each other, and a disc that holds them.
struct Chunk {
    std::size_t line = 0, first = 0, last = 0;
    Vec2 middle{0};
    double reach = 0, half = 0;  // of the widest

    /// No power of a point of it is less.
    double least_power(const Vec2& p) const {
        const double away = std::max(0.0, glm::distance(p, middle) - reach);
        return away * away - half * half;
    }
};

std::vector<Chunk> chunks_of(const std::vector<CopiedLine>& lines) {
    std::vector<Chunk> chunks;
    for (std::size_t s = 0; s < lines.size(); ++s)
        for (std::size_t k = 0; k < lines[s].points.size(); k += kChunk) {
            Chunk c{.line = s, .first = k, .last = std::min(k + kChunk, lines[s].points.size())};
            c.middle = lines[s].points[(c.first + c.last) / 2].centre;
            for (std::size_t i = c.first; i < c.last; ++i) {
                c.reach = std::max(c.reach, glm::distance(c.middle, lines[s].points[i].centre));
                c.half = std::max(c.half, lines[s].points[i].half);
            }
            chunks.push_back(c);
        }
    return chunks;
}

/// Divides the cells of the ink among the strokes.
class Division {
  public:
    Division(const Cells& ink, const std::vector<CopiedLine>& lines)
        : ink_(ink), lines_(lines), chunks_(chunks_of(lines)), cells_(lines.size()) {
        const Chunk* near = chunks_.empty() ? nullptr : &chunks_.front();
        for (int j = 0; j < ink.height; ++j)
            for (int i = 0; i < ink.width; ++i)
                if (ink.at(i, j) && near) near = divide(i, j, *near);
    }

    /// Cells of a stroke, no more of them than its box has.
    Cells area(std::size_t stroke) const {
        int left = ink_.width, right = -1, bottom = ink_.height, top = -1;
        for (const auto& [i, j] : cells_[stroke]) {
            left = std::min(left, i), right = std::max(right, i);
            bottom = std::min(bottom, j), top = std::max(top, j);
        }
        Cells out{.cell = ink_.cell};
        if (right < 0) return out;
        out.lo = ink_.lo + ink_.cell * Vec2(left, bottom);
        out.width = right - left + 1, out.height = top - bottom + 1;
        out.inside.assign(std::size_t(out.width) * out.height, 0);
        for (const auto& [i, j] : cells_[stroke]) out.inside[std::size_t(j - bottom) * out.width + i - left] = 1;
        return out;
    }

  private:
    /// Gives a cell to its strokes. Returns the points that are nearest; `near`: those of the cell before.
    const Chunk* divide(int i, int j, const Chunk& near) {
        const Vec2 p = ink_.centre(i, j);
        double bound = 1e300;
        for (std::size_t k = near.first; k < near.last; ++k)
            bound = std::min(bound, power_of(lines_[near.line].points[k], p));
        bound = std::max(bound, 0.0) + 1e-6;  // more than rounding
        double nearest = 1e300;
        const Chunk* owner = &near;
        std::size_t last = lines_.size();  // line that the cell was given to last
        for (const Chunk& chunk : chunks_) {
            if (chunk.least_power(p) > bound) continue;
            const CopiedLine& line = lines_[chunk.line];
            for (std::size_t k = chunk.first; k < chunk.last; ++k) {
                const double power = power_of(line.points[k], p);
                if (power < nearest) nearest = power, owner = &chunk;
                if (power > 0 || !line.through[k] || last == chunk.line) continue;
                last = chunk.line;
                cells_[last].push_back({i, j});
            }
        }
        cells_[owner->line].push_back({i, j});  // perhaps a second time
        return owner;
    }

    const Cells& ink_;
    const std::vector<CopiedLine>& lines_;
    std::vector<Chunk> chunks_;
    std::vector<std::vector<std::pair<int, int>>> cells_;
};

/// Width or height of rings, whichever is more.
double extent_of(const std::vector<Ring>& rings) {
    Vec2 lo(1e300), hi(-1e300);
    for (const Ring& ring : rings)
        for (const Vec2& p : ring) lo = glm::min(lo, p), hi = glm::max(hi, p);
    return std::max(0.0, std::max(hi.x - lo.x, hi.y - lo.y));
}

}  // namespace

Glyph copied_glyph(const Cells& ink, const Skeleton& skeleton, const StrokeOrder& order, char32_t code) {
    const InkClearance room(ink);
    std::vector<CopiedLine> lines;
    for (const auto& stroke : order) {
        lines.push_back(line_of(skeleton, stroke, room));
        const PieceUse& first = stroke.front();
        const Piece& piece = skeleton.pieces[first.piece];
        if (skeleton.nodes[first.reversed ? piece.to : piece.from].n_pieces == 1) begin_in_corner(lines.back(), room);
    }
    const Division division(ink, lines);
    Glyph glyph{.code = code};
    for (std::size_t s = 0; s < lines.size(); ++s) {
        GlyphStroke stroke;
        for (const Station& p : lines[s].points) stroke.median.push_back(p.centre);
        stroke.outline = boundaries(division.area(s), kRingPasses);
        glyph.strokes.push_back(std::move(stroke));
    }
    return glyph;
}

Glyph strokes_of_area(const Glyph& glyph) {
    if (extent_of(glyph.area) + 2 * kAreaMargin > kWidestCopied) return glyph;
    Cells ink = cells_over(glyph.area, kAreaCell, kAreaMargin);
    fill(ink, glyph.area);
    const auto n = static_cast<double>(ink.count());
    if (n == 0 || n * kAreaCell * kAreaCell > kMostAreaInk) return glyph;
    const Skeleton skeleton = skeleton_of(ink, kMostAreaLines);
    if (skeleton.pieces.empty() || skeleton.pieces.size() > kMostStrokes) return glyph;
    std::size_t points = 0;
    for (const Piece& piece : skeleton.pieces) points += piece.line.size();
    if (n * static_cast<double>(points) > kMostAreaWork) return glyph;
    const StrokeOrder order = order_by_rules(skeleton);
    Glyph out = glyph;
    out.strokes = copied_glyph(ink, skeleton, order, glyph.code).strokes;
    out.area.clear();
    return out;
}

std::string numbered_svg(const Cells& ink, const Skeleton& skeleton, const StrokeOrder& order) {
    const auto path = [](const std::vector<Vec2>& line, bool closed) {
        std::string d;
        for (std::size_t i = 0; i < line.size(); ++i)
            d += fmt::format("{}{:.1f} {:.1f}", i == 0 ? "M" : "L", line[i].x, kSide - line[i].y);
        return d + (closed ? "Z" : "");
    };
    std::string ink_path;
    for (const Ring& ring : boundaries(ink, kRingPasses)) ink_path += path(ring, true);
    std::string svg = fmt::format(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"1024\" height=\"1104\" viewBox=\"0 0 1024 1104\">\n"
        "<rect width=\"1024\" height=\"1104\" fill=\"#fff\"/>\n<path d=\"{}\" fill=\"#d0d0d0\"/>\n",
        ink_path);
    std::string numbers;
    for (std::size_t s = 0; s < order.size(); ++s)
        for (const PieceUse& use : order[s]) {
            std::vector<Vec2> line = skeleton.pieces[use.piece].line;
            if (use.reversed) std::reverse(line.begin(), line.end());
            const std::string colour = fmt::format("#{:06x}", kStrokeColours[s % kStrokeColours.size()]);
            const Vec2 end = line.back(), d = end - line[line.size() - std::min<std::size_t>(line.size(), 5)];
            const double size = std::max(glm::length(d), 1e-9);
            const Vec2 on = d / size, side(-on.y, on.x);
            svg += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"5\"/>\n", path(line, false),
                               colour);
            svg += fmt::format("<path d=\"{}\" fill=\"{}\"/>\n",
                               path({end + 4.0 * on, end - 14.0 * on + 8.0 * side, end - 14.0 * on - 8.0 * side}, true),
                               colour);
            const Vec2 middle = line[line.size() / 2];
            // The halo is a text of its own: some viewers ignore paint-order.
            for (const std::string& look : {std::string("#fff\" stroke=\"#fff\" stroke-width=\"6"), colour})
                numbers += fmt::format("<text x=\"{:.0f}\" y=\"{:.0f}\" fill=\"{}\">{}</text>\n", middle.x + 6,
                                       kSide - middle.y - 6, look, use.piece + 1);
        }
    svg += "<g font-family=\"sans-serif\" font-size=\"30\" font-weight=\"bold\">\n" + numbers + "</g>\n";
    svg += fmt::format("<text x=\"24\" y=\"1070\" font-family=\"monospace\" font-size=\"{:.0f}\">{}</text>\n</svg>\n",
                       std::clamp(1600.0 / static_cast<double>(order_text(order).size() + 1), 10.0, 30.0),
                       order_text(order));
    return svg;
}

}  // namespace tuft::writer
