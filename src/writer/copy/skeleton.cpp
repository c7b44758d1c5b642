#include "writer/copy/skeleton.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "writer/copy/thinning.h"
#include "writer/gesture/stroke_line.h"

namespace tuft::writer {
namespace {

constexpr double kSpur = 1.8;          // of the room at its junction
constexpr double kOne = 1.2;           // of the larger room of two junctions
constexpr double kBefore = 12;         // units between the end of a centre line and the edge
constexpr double kEndReach = 24;       // units of an end over which its direction is taken
constexpr double kCornerReach = 28;    // units before and after a corner
constexpr double kCornerOfHalf = 1.3;  // of the half width: thinning rounds corners
constexpr double kLeastLine = 12;      // units; a shorter line with two free ends is a blob
constexpr std::array<std::array<int, 2>, 8> kAround{
    {{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 1}, {-1, 1}, {-1, -1}, {1, -1}}};

double length_of(const std::vector<Vec2>& line) {
    double length = 0;
    for (std::size_t i = 1; i < line.size(); ++i) length += glm::distance(line[i], line[i - 1]);
    return length;
}

Vec2 unit_or(const Vec2& d, const Vec2& otherwise) {
    const double size = glm::length(d);
    return size > 1e-9 ? d / size : otherwise;
}

/// Follows the lines of thinned cells.
class Tracer {
  public:
    Tracer(const Cells& thin, const InkClearance& room) : c_(thin), room_(room), node_(thin.inside.size(), kNone) {}

    Skeleton trace() {
        for_cells([&](int i, int j) {
            if (const int n = neighbours(i, j); n != 2) mark(i, j);
        });
        for (SkeletonNode& node : out_.nodes)  // the middle of the cells of a junction
            node.at /= std::max<double>(1, node.n_pieces), node.room = room_.at(node.at), node.n_pieces = 0;
        for_cells([&](int i, int j) {
            if (node_[at(i, j)] == kNone) return;
            for (const auto& d : kAround) follow(i, j, i + d[0], j + d[1]);
        });
        for_cells([&](int i, int j) {  // what is left are rings
            if (node_[at(i, j)] != kNone || used_[at(i, j)]) return;
            add_node(i, j);
            out_.nodes.back().n_pieces = 0;
            for (const auto& d : kAround) follow(i, j, i + d[0], j + d[1]);
        });
        return std::move(out_);
    }

  private:
    std::size_t at(int i, int j) const { return std::size_t(j) * c_.width + i; }
    template <class F>
    void for_cells(F&& f) {
        used_.resize(c_.inside.size(), 0);
        for (int j = c_.height - 1; j >= 0; --j)  // from the upper left corner
            for (int i = 0; i < c_.width; ++i)
                if (c_.at(i, j)) f(i, j);
    }
    /// Cells about a cell, those at a corner only where no cell between them touches both by an edge.
    bool joined(int i, int j, int a, int b) const {
        if (!c_.at(a, b)) return false;
        return a == i || b == j || (!c_.at(a, j) && !c_.at(i, b));
    }
    int neighbours(int i, int j) const {
        int n = 0;
        for (const auto& d : kAround) n += joined(i, j, i + d[0], j + d[1]);
        return n;
    }
    void add_node(int i, int j) {
        node_[at(i, j)] = static_cast<std::uint32_t>(out_.nodes.size());
        out_.nodes.push_back({.at = c_.centre(i, j), .room = room_.at(c_.centre(i, j)), .n_pieces = 1});
    }
    /// Makes a node of a cell and of all cells about it that are none of a line.
    void mark(int i, int j) {
        if (node_[at(i, j)] != kNone) return;
        add_node(i, j);
        const std::uint32_t id = node_[at(i, j)];
        std::vector<std::array<int, 2>> open{{i, j}};
        while (!open.empty()) {
            const auto [x, y] = open.back();
            open.pop_back();
            for (const auto& d : kAround) {
                const int a = x + d[0], b = y + d[1];
                if (!joined(x, y, a, b) || node_[at(a, b)] != kNone || neighbours(a, b) == 2) continue;
                node_[at(a, b)] = id;
                out_.nodes[id].at += c_.centre(a, b), ++out_.nodes[id].n_pieces;
                open.push_back({a, b});
            }
        }
    }
    void follow(int i, int j, int a, int b) {
        if (!joined(i, j, a, b)) return;
        const std::uint32_t from = node_[at(i, j)];
        if (node_[at(a, b)] == from || used_[at(a, b)]) return;
        Piece piece{.line = {out_.nodes[from].at}, .from = from, .to = from};
        int pi = i, pj = j;
        while (node_[at(a, b)] == kNone) {
            piece.line.push_back(c_.centre(a, b));
            used_[at(a, b)] = 1;
            int na = -1, nb = -1;
            for (const auto& d : kAround) {
                const int x = a + d[0], y = b + d[1];
                if (!joined(a, b, x, y) || (x == pi && y == pj)) continue;
                const bool own = node_[at(x, y)] == from && piece.line.size() < 3;  // back where it came from
                if (used_[at(x, y)] || own) continue;
                na = x, nb = y;
                break;
            }
            pi = a, pj = b;
            if (na < 0) break;
            a = na, b = nb;
        }
        if (node_[at(a, b)] != kNone) {
            if (piece.line.size() == 1 && node_[at(a, b)] < from) return;  // two nodes side by side: once
            piece.to = node_[at(a, b)];
        }
        piece.line.push_back(out_.nodes[piece.to].at);
        out_.pieces.push_back(std::move(piece));
    }

    const Cells& c_;
    const InkClearance& room_;
    std::vector<std::uint32_t> node_;
    std::vector<std::uint8_t> used_;
    Skeleton out_;
};

void count_ends(Skeleton& s) {
    for (SkeletonNode& node : s.nodes) node.n_pieces = 0;
    for (const Piece& p : s.pieces) ++s.nodes[p.from].n_pieces, ++s.nodes[p.to].n_pieces;
}

/// Joins the two pieces of nodes that have two.
void join_pairs(Skeleton& s) {
    for (std::size_t n = 0; n < s.nodes.size(); ++n) {
        if (s.nodes[n].n_pieces != 2) continue;
        std::vector<std::size_t> own;
        for (std::size_t p = 0; p < s.pieces.size(); ++p)
            if (s.pieces[p].from == n || s.pieces[p].to == n) own.push_back(p);
        if (own.size() != 2) continue;  // a ring
        Piece &a = s.pieces[own[0]], &b = s.pieces[own[1]];
        if (a.from == n) std::reverse(a.line.begin(), a.line.end()), std::swap(a.from, a.to);
        if (b.to == n) std::reverse(b.line.begin(), b.line.end()), std::swap(b.from, b.to);
        a.line.insert(a.line.end(), b.line.begin() + 1, b.line.end());
        a.to = b.to;
        s.nodes[n].n_pieces = 0;
        s.pieces.erase(s.pieces.begin() + static_cast<std::ptrdiff_t>(own[1]));
    }
}

/// Stands for the line of a part of the ink that has none; `set_ends` makes one of it.
void add_blob(Skeleton& s, std::size_t node) {
    s.pieces.push_back({.line = {s.nodes[node].at, s.nodes[node].at}, .from = node, .to = s.nodes.size()});
    const SkeletonNode other{.at = s.nodes[node].at, .room = s.nodes[node].room, .n_pieces = 1};
    s.nodes[node].n_pieces = 1;
    s.nodes.push_back(other);
}

/// Takes spurs off until none is left.
void prune(Skeleton& s) {
    for (bool any = true; any;) {
        count_ends(s);
        any = std::erase_if(s.pieces, [&](const Piece& p) {
                  const bool head = s.nodes[p.from].n_pieces == 1, tail = s.nodes[p.to].n_pieces == 1;
                  const SkeletonNode& root = s.nodes[head ? p.to : p.from];
                  return head != tail && root.n_pieces > 2 && p.length() < kSpur * root.room;
              }) > 0;
        const std::vector<SkeletonNode> before = s.nodes;
        count_ends(s);
        for (std::size_t n = 0; n < before.size(); ++n)
            if (before[n].n_pieces > 2 && s.nodes[n].n_pieces == 0) add_blob(s, n);
        join_pairs(s);
    }
}

/// Makes one of junctions that are closer than a stroke is wide.
void merge_junctions(Skeleton& s) {
    for (std::size_t p = 0; p < s.pieces.size();) {
        const Piece& piece = s.pieces[p];
        const std::size_t keep = piece.from, gone = piece.to;
        SkeletonNode &a = s.nodes[keep], &b = s.nodes[gone];
        const bool junctions = keep != gone && a.n_pieces > 2 && b.n_pieces > 2;
        if (!junctions || piece.length() > kOne * std::max(a.room, b.room)) {
            ++p;
            continue;
        }
        a.at = 0.5 * (a.at + b.at), a.room = std::max(a.room, b.room);
        s.pieces.erase(s.pieces.begin() + static_cast<std::ptrdiff_t>(p));
        for (Piece& other : s.pieces) {
            if (other.from == gone) other.from = keep;
            if (other.to == gone) other.to = keep;
            if (other.from == keep) other.line.front() = a.at;
            if (other.to == keep) other.line.back() = a.at;
        }
        std::erase_if(s.pieces, [&](const Piece& q) {
            return q.from == keep && q.to == keep && q.length() < 4 * s.nodes[keep].room;
        });
        count_ends(s);
        p = 0;
    }
    join_pairs(s);
}

/// The line of a blob: its longest direction.
std::vector<Vec2> blob_line(const Cells& ink, const Vec2& at, double reach) {
    Vec2 mean(0);
    double xx = 0, xy = 0, yy = 0, n = 0;
    const Vec2 lo = glm::floor((at - reach - ink.lo) / ink.cell), hi = glm::ceil((at + reach - ink.lo) / ink.cell);
    const auto each = [&](auto&& f) {
        for (int j = std::max(0, static_cast<int>(lo.y)); j < std::min(ink.height, static_cast<int>(hi.y)); ++j)
            for (int i = std::max(0, static_cast<int>(lo.x)); i < std::min(ink.width, static_cast<int>(hi.x)); ++i)
                if (const Vec2 p = ink.centre(i, j); ink.at(i, j) && glm::distance(p, at) < reach) f(p);
    };
    each([&](const Vec2& p) { mean += p, n += 1; });
    if (n > 0) mean /= n;
    each([&](const Vec2& p) {
        const Vec2 d = p - mean;
        xx += d.x * d.x, xy += d.x * d.y, yy += d.y * d.y;
    });
    const double angle = 0.5 * std::atan2(2 * xy, xx - yy);
    const Vec2 d(std::cos(angle), std::sin(angle));
    return {mean - 4.0 * d, mean, mean + 4.0 * d};
}

/// Continues a free end straight on to `kBefore` units before the edge, or takes as much off.
void set_end(std::vector<Vec2>& line, const InkClearance& room) {
    const double whole = length_of(line), reach = std::min(kEndReach, whole);
    double along = 0;
    std::size_t k = line.size() - 1;
    while (k > 0 && along < reach) along += glm::distance(line[k], line[k - 1]), --k;
    const Vec2 on = unit_or(line.back() - line[k], Vec2(1, 0)), end = line.back();
    double far = 0;
    while (far < 200 && room.at(end + far * on) > 0) far += 1;
    if (far > kBefore) line.push_back(end + (far - kBefore) * on);
}

void set_ends(Skeleton& s, const Cells& ink, const InkClearance& room) {
    for (Piece& p : s.pieces) {
        SkeletonNode &from = s.nodes[p.from], &to = s.nodes[p.to];
        const bool head = from.n_pieces == 1, tail = to.n_pieces == 1;
        if (head && tail && p.length() < kLeastLine)
            p.line = blob_line(ink, p.line.front(), 3 * std::max(from.room, 8.0));
        if (tail) set_end(p.line, room);
        std::reverse(p.line.begin(), p.line.end());
        if (head) set_end(p.line, room);
        std::reverse(p.line.begin(), p.line.end());
        if (head) from.at = p.line.front();
        if (tail) to.at = p.line.back();
    }
}

/// Lets a ring begin where a box has its first corner.
void begin_upper_left(Piece& ring, SkeletonNode& node) {
    ring.line.pop_back();
    const auto first = std::max_element(ring.line.begin(), ring.line.end(),
                                        [](const Vec2& a, const Vec2& b) { return a.y - a.x < b.y - b.x; });
    std::rotate(ring.line.begin(), first, ring.line.end());
    ring.line.push_back(ring.line.front());
    node.at = ring.line.front();
}

/// Cuts pieces at corners; smooths them.
void cut_corners(Skeleton& s, const InkClearance& room) {
    std::vector<Piece> pieces;
    for (Piece& p : s.pieces) {
        if (p.from == p.to && s.nodes[p.from].n_pieces == 2) begin_upper_left(p, s.nodes[p.from]);
        double half = 0;
        for (const Vec2& q : p.line) half += room.at(q) / static_cast<double>(p.line.size());
        const StrokeLine line = make_stroke_line(p.line, std::max(kCornerReach, kCornerOfHalf * half));
        std::size_t from = p.from;
        for (std::size_t k = 0; k < line.segments.size(); ++k) {
            const LineSegment& g = line.segments[k];
            const bool last = k + 1 == line.segments.size();
            Piece part{.line = {line.points.begin() + static_cast<std::ptrdiff_t>(g.first),
                                line.points.begin() + static_cast<std::ptrdiff_t>(g.last) + 1},
                       .from = from,
                       .to = last ? p.to : s.nodes.size()};
            if (!last) s.nodes.push_back({.at = part.line.back(), .room = room.at(part.line.back()), .n_pieces = 2});
            from = part.to;
            const std::size_t n = part.line.size(), third = std::max<std::size_t>(1, n / 3);
            for (std::size_t i = 0; i < third; ++i) {
                part.half_from += room.at(part.line[i]) / static_cast<double>(third);
                part.half_to += room.at(part.line[n - 1 - i]) / static_cast<double>(third);
            }
            pieces.push_back(std::move(part));
        }
    }
    s.pieces = std::move(pieces);
}

/// A line of each part of the ink that thinning left as a cell or two.
void add_blobs(Skeleton& s) {
    count_ends(s);
    for (std::size_t k = 0, n = s.nodes.size(); k < n; ++k)
        if (s.nodes[k].n_pieces == 0) add_blob(s, k);
}

}  // namespace

double Piece::length() const {
    return length_of(line);
}

double InkClearance::at(const Vec2& p) const {
    const Vec2 q = glm::floor((p - ink_.lo) / ink_.cell);
    const int i = static_cast<int>(q.x), j = static_cast<int>(q.y);
    if (!ink_.at(i, j)) return 0;
    return static_cast<double>(clearance_[std::size_t(j) * ink_.width + i]);
}

Skeleton skeleton_of(const Cells& ink, std::size_t most) {
    const InkClearance room(ink);
    Cells lines = ink;
    thin(lines);
    Skeleton s = Tracer(lines, room).trace();
    add_blobs(s);
    if (s.pieces.size() > most) return {};
    prune(s);
    merge_junctions(s);
    prune(s);
    set_ends(s, ink, room);
    cut_corners(s, room);
    return s;
}

void cut_piece(Skeleton& s, const PieceCut& cut) {
    if (cut.piece >= s.pieces.size())
        throw Error(Message("there is no piece {} to cut, only 1 to {}", cut.piece + 1, s.pieces.size()));
    if (!(cut.at > 0 && cut.at < 1)) throw Error(Message("a piece is cut at a part of its length between 0 and 1"));
    Piece first = s.pieces[cut.piece], rest;
    const double at = cut.at * first.length();
    double along = 0;
    std::size_t i = 1;
    for (; i + 1 < first.line.size(); ++i) {
        const double step = glm::distance(first.line[i], first.line[i - 1]);
        if (along + step >= at) break;
        along += step;
    }
    const double step = glm::distance(first.line[i], first.line[i - 1]);
    const Vec2 place = step > 0 ? glm::mix(first.line[i - 1], first.line[i], (at - along) / step) : first.line[i];
    const auto there = first.line.begin() + static_cast<std::ptrdiff_t>(i);
    rest.line.assign(there, first.line.end());
    first.line.erase(there, first.line.end());
    first.line.push_back(place);
    rest.line.insert(rest.line.begin(), place);
    rest.to = first.to, rest.from = first.to = s.nodes.size();
    rest.half_to = first.half_to;
    rest.half_from = first.half_to = std::lerp(first.half_from, first.half_to, cut.at);
    s.nodes.push_back({.at = place, .room = 0, .n_pieces = 2});
    s.pieces[cut.piece] = std::move(first);
    s.pieces.push_back(std::move(rest));
}

}  // namespace tuft::writer
