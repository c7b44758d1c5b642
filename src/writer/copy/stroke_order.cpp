#include "writer/copy/stroke_order.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

#include "core/error.h"
#include "core/geometry/plane_vectors.h"
#include "core/text/units.h"
#include "core/text/words.h"
#include "writer/gesture/stroke_line.h"

namespace tuft::writer {
namespace {

constexpr double kStraightOn = 45 * kDegree;  // turn at a junction up to which two pieces are one stroke
constexpr double kHead = 1.5;                 // half widths of a stroke: a bend so near to its end is no corner
constexpr double kReach = 28;                 // units beyond a junction over which a direction is taken
constexpr double kHook = 0.35;                // of the run before: a hook is at most so long
constexpr double kLongestHook = 150;          // units
constexpr double kThicker = 1.15;             // head of 提 over its end
constexpr double kSameStart = 60;             // units
constexpr double kAcross = 0.25;              // a unit to the right counts as so much downwards
constexpr double kTaller = 1.4;               // a middle stroke over those beside it

/// Pieces written without a corner.
struct Run {
    std::vector<PieceUse> pieces;
    Vec2 begin{0}, end{0};
    std::size_t from = 0, to = 0;  ///< nodes
    double length = 0;
    double half_from = 0, half_to = 0;
    char code = 'H';

    void reverse() {
        std::reverse(pieces.begin(), pieces.end());
        for (PieceUse& p : pieces) p.reversed = !p.reversed;
        std::swap(begin, end), std::swap(from, to), std::swap(half_from, half_to);
        set_code();
    }
    void set_code() {
        const Vec2 d = end - begin;
        code = segment_code(std::atan2(d.y, d.x));
    }
};

/// An end of a piece at a node.
struct PieceEnd {
    std::size_t piece = 0;
    bool tail = false;
};

/// Direction in which a piece leaves a node, beyond the disc of the junction.
Vec2 leaving(const Skeleton& s, const PieceEnd& e) {
    const Piece& p = s.pieces[e.piece];
    std::vector<Vec2> line = p.line;
    if (e.tail) std::reverse(line.begin(), line.end());
    const double skip = std::min(s.nodes[e.tail ? p.to : p.from].room, 0.4 * p.length());
    Vec2 a = line.front(), b = line.back();
    double along = 0;
    bool begun = false;
    for (std::size_t i = 1; i < line.size(); ++i) {
        along += glm::distance(line[i], line[i - 1]);
        if (!begun && along >= skip) a = line[i], begun = true;
        if (along >= skip + kReach) {
            b = line[i];
            break;
        }
    }
    return b - a;
}

double turn_between(const Vec2& in, const Vec2& on) {
    return std::abs(angle_between(in, on));
}

/// Joins pieces through junctions.
class Runs {
  public:
    explicit Runs(const Skeleton& s) : s_(s), partner_(2 * s.pieces.size(), kNoEnd) {
        for (std::size_t n = 0; n < s.nodes.size(); ++n)
            if (s.nodes[n].n_pieces > 2)
                pair_at(n);
            else if (s.nodes[n].n_pieces == 2)
                pair_head(n);
    }

    std::vector<Run> all() const {
        std::vector<Run> runs;
        std::vector<std::uint8_t> used(s_.pieces.size(), 0);
        for (int pass = 0; pass < 2; ++pass)  // open ones first; then rings
            for (std::size_t end = 0; end < partner_.size(); ++end)
                if (!used[end / 2] && (pass == 1 || partner_[end] == kNoEnd)) runs.push_back(run_from(end, used));
        return runs;
    }

  private:
    static constexpr std::size_t kNoEnd = static_cast<std::size_t>(-1);

    std::vector<PieceEnd> ends_at(std::size_t node) const {
        std::vector<PieceEnd> ends;
        for (std::size_t p = 0; p < s_.pieces.size(); ++p) {
            if (s_.pieces[p].from == node) ends.push_back({p, false});
            if (s_.pieces[p].to == node) ends.push_back({p, true});
        }
        return ends;
    }
    static std::size_t index(const PieceEnd& e) { return 2 * e.piece + e.tail; }
    void pair(std::size_t a, std::size_t b) {
        if (partner_[a] == kNoEnd && partner_[b] == kNoEnd) partner_[a] = b, partner_[b] = a;
    }

    /// At a corner: a slanted head belongs to its stroke, which the brush entered aslant.
    void pair_head(std::size_t node) {
        const std::vector<PieceEnd> ends = ends_at(node);
        if (ends.size() != 2 || ends[0].piece == ends[1].piece) return;
        const auto is_head = [&](const PieceEnd& e, const PieceEnd& stroke) {
            const Piece &head = s_.pieces[e.piece], &rest = s_.pieces[stroke.piece];
            return s_.nodes[e.tail ? head.from : head.to].n_pieces == 1 && head.length() < rest.length() &&
                   head.length() < kHead * (stroke.tail ? rest.half_to : rest.half_from);
        };
        if (is_head(ends[0], ends[1]) || is_head(ends[1], ends[0])) pair(index(ends[0]), index(ends[1]));
    }

    void pair_at(std::size_t node) {
        const std::vector<PieceEnd> ends = ends_at(node);
        struct Pair {
            double turn;
            std::size_t a, b;
        };
        std::vector<Pair> pairs;
        for (std::size_t a = 0; a < ends.size(); ++a)
            for (std::size_t b = a + 1; b < ends.size(); ++b)
                if (const double turn = turn_between(-leaving(s_, ends[a]), leaving(s_, ends[b])); turn < kStraightOn)
                    pairs.push_back({turn, index(ends[a]), index(ends[b])});
        std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.turn < b.turn; });
        for (const Pair& p : pairs) pair(p.a, p.b);
    }

    Run run_from(std::size_t end, std::vector<std::uint8_t>& used) const {
        Run run;
        const Piece& first = s_.pieces[end / 2];
        const bool reversed = end % 2 == 1;
        run.from = reversed ? first.to : first.from;
        run.begin = reversed ? first.line.back() : first.line.front();
        run.half_from = reversed ? first.half_to : first.half_from;
        while (true) {
            const Piece& p = s_.pieces[end / 2];
            const bool back = end % 2 == 1;
            used[end / 2] = 1;
            run.pieces.push_back({end / 2, back});
            run.length += p.length();
            run.to = back ? p.from : p.to;
            run.end = back ? p.line.front() : p.line.back();
            run.half_to = back ? p.half_from : p.half_to;
            const std::size_t next = partner_[back ? end - 1 : end + 1];
            if (next == kNoEnd || used[next / 2]) break;
            end = next;
        }
        run.set_code();
        return run;
    }

    const Skeleton& s_;
    std::vector<std::size_t> partner_;
};

/// Turns a run so that a hand would write it.
void orient(Run& run) {
    if (run.code == 'L' || run.code == 'U') run.reverse();
    if (run.code == 'T' && run.half_from < kThicker * run.half_to)
        run.reverse();
    else if (run.code == 'P' && run.half_to > kThicker * run.half_from &&
             run.end.y > run.begin.y - 0.8 * std::abs(run.end.x - run.begin.x))
        run.reverse();
}

bool foldable(char a, char b) {
    static constexpr std::string_view kPairs[] = {"HS", "HP", "HN", "SH", "ST", "PH", "PT", "PN", "TN", "SN"};
    const char pair[] = {a, b};
    return std::find(std::begin(kPairs), std::end(kPairs), std::string_view(pair, 2)) != std::end(kPairs);
}

using Stroke = std::vector<Run>;

/// Joins runs at corners to strokes.
class Folds {
  public:
    explicit Folds(std::vector<Run> runs) {
        for (Run& run : runs) strokes_.push_back({std::move(run)});
    }

    std::vector<Stroke> all() {
        join([&](const Stroke& a, const Stroke& b) { return folds(a, b, "HS") || folds(a, b, "HP"); });
        join([&](const Stroke& a, const Stroke& b) {
            return foldable(a.back().code, b.front().code) && meets(a, b) && !closes_box(a, b);
        });
        add_hooks();
        return std::move(strokes_);
    }

  private:
    static bool meets(const Stroke& a, const Stroke& b) { return a.back().to == b.front().from; }
    static bool folds(const Stroke& a, const Stroke& b, std::string_view codes) {
        return meets(a, b) && a.back().code == codes[0] && b.front().code == codes[1];
    }
    /// 豎 and the 橫 below it, where 橫折 begins at the head of the 豎.
    bool closes_box(const Stroke& a, const Stroke& b) const {
        if (a.size() != 1 || a.back().code != 'S' || b.front().code != 'H') return false;
        return std::any_of(strokes_.begin(), strokes_.end(), [&](const Stroke& s) {
            return s.size() > 1 && s.front().code == 'H' && s.front().from == a.front().from;
        });
    }
    template <class F>
    void join(F&& wanted) {
        for (bool any = true; any;) {
            any = false;
            for (std::size_t a = 0; a < strokes_.size() && !any; ++a)
                for (std::size_t b = 0; b < strokes_.size() && !any; ++b) {
                    if (a == b || !wanted(strokes_[a], strokes_[b])) continue;
                    strokes_[a].insert(strokes_[a].end(), strokes_[b].begin(), strokes_[b].end());
                    strokes_.erase(strokes_.begin() + static_cast<std::ptrdiff_t>(b));
                    any = true;
                }
        }
    }
    /// A short run from the end of a longer one is its hook, whatever its direction.
    void add_hooks() {
        for (std::size_t h = 0; h < strokes_.size();) {
            bool added = false;
            for (std::size_t a = 0; a < strokes_.size() && !added && strokes_[h].size() == 1; ++a) {
                Run hook = strokes_[h].front();
                const Run& last = strokes_[a].back();
                if (a == h || hook.length > std::min(kHook * last.length, kLongestHook)) continue;
                if (hook.to == last.to) hook.reverse();
                if (hook.from != last.to || hook.half_to > hook.half_from || hook.end.y < hook.begin.y) continue;
                strokes_[a].push_back(hook);
                added = true;
            }
            if (added)
                strokes_.erase(strokes_.begin() + static_cast<std::ptrdiff_t>(h));
            else
                ++h;
        }
    }

    std::vector<Stroke> strokes_;
};

struct Box {
    Vec2 lo{1e300}, hi{-1e300};
};

/// Sorts strokes as they are written.
class Sorting {
  public:
    Sorting(const Skeleton& s, std::vector<Stroke> strokes) : s_(s), strokes_(std::move(strokes)) {
        for (const Stroke& stroke : strokes_) {
            Box& box = boxes_.emplace_back();
            for (const Run& run : stroke)
                for (const PieceUse& use : run.pieces)
                    for (const Vec2& p : s_.pieces[use.piece].line)
                        box.lo = glm::min(box.lo, p), box.hi = glm::max(box.hi, p);
        }
    }

    StrokeOrder sorted() {
        std::vector<std::size_t> all;
        for (std::size_t i = 0; i < strokes_.size(); ++i) all.push_back(i);
        sort(all, true);
        StrokeOrder out;
        for (const std::size_t i : order_) {
            std::vector<PieceUse>& stroke = out.emplace_back();
            for (const Run& run : strokes_[i]) stroke.insert(stroke.end(), run.pieces.begin(), run.pieces.end());
        }
        return out;
    }

  private:
    /// Parts that gaps between the strokes' boxes divide, along x from the left or along y from the top.
    std::vector<std::vector<std::size_t>> divided(std::vector<std::size_t> set, bool along_x) const {
        const auto lo = [&](std::size_t i) { return along_x ? boxes_[i].lo.x : -boxes_[i].hi.y; };
        const auto hi = [&](std::size_t i) { return along_x ? boxes_[i].hi.x : -boxes_[i].lo.y; };
        std::stable_sort(set.begin(), set.end(), [&](std::size_t a, std::size_t b) { return lo(a) < lo(b); });
        std::vector<std::vector<std::size_t>> parts;
        double reached = -1e300;
        for (const std::size_t i : set) {
            if (parts.empty() || lo(i) > reached) parts.emplace_back();
            parts.back().push_back(i);
            reached = std::max(reached, hi(i));
        }
        return parts;
    }
    double height(std::size_t i) const { return boxes_[i].hi.y - boxes_[i].lo.y; }

    void sort(const std::vector<std::size_t>& set, bool divide) {
        if (set.size() < 2) {
            order_.insert(order_.end(), set.begin(), set.end());
            return;
        }
        for (const bool along_x : {true, false}) {
            auto parts = divide ? divided(set, along_x) : std::vector<std::vector<std::size_t>>{};
            if (parts.size() < 2) continue;
            const bool middle = along_x && parts.size() == 3 && parts[0].size() == 1 && parts[1].size() == 1 &&
                                parts[2].size() == 1 &&
                                height(parts[1][0]) > kTaller * std::max(height(parts[0][0]), height(parts[2][0]));
            if (middle) std::swap(parts[0], parts[1]);
            for (const auto& part : parts) sort(part, true);
            return;
        }
        by_pairs(set);
    }

    /// Whether a is written before b whatever their heights are.
    std::optional<bool> before(std::size_t a, std::size_t b) const {
        const Run &x = strokes_[a].front(), &y = strokes_[b].front();
        const bool start = glm::distance(x.begin, y.begin) < kSameStart;
        const auto rank = [](char code) { return code == 'P' ? 0 : code == 'N' ? 1 : -1; };
        if (start && x.code == 'S' && y.code == 'H' && strokes_[b].size() > 1) return true;
        if (start && y.code == 'S' && x.code == 'H' && strokes_[a].size() > 1) return false;
        if (start && x.code == 'H' && (y.code == 'P' || y.code == 'S')) return true;
        if (start && y.code == 'H' && (x.code == 'P' || x.code == 'S')) return false;
        if (crosses(a, b) || start) {
            if (strokes_[a].size() == 1 && x.code == 'H' && y.code != 'H') return true;
            if (strokes_[b].size() == 1 && y.code == 'H' && x.code != 'H') return false;
            if (rank(x.code) >= 0 && rank(y.code) >= 0 && rank(x.code) != rank(y.code))
                return rank(x.code) < rank(y.code);
        }
        return std::nullopt;
    }
    /// Whether both run through one junction.
    bool crosses(std::size_t a, std::size_t b) const {
        const auto inner = [&](std::size_t i) {
            std::vector<std::size_t> nodes;
            for (const Run& run : strokes_[i])
                for (std::size_t k = 0; k + 1 < run.pieces.size(); ++k) {
                    const PieceUse& use = run.pieces[k];
                    nodes.push_back(use.reversed ? s_.pieces[use.piece].from : s_.pieces[use.piece].to);
                }
            return nodes;
        };
        const std::vector<std::size_t> own = inner(a), others = inner(b);
        return std::any_of(own.begin(), own.end(),
                           [&](std::size_t n) { return std::find(others.begin(), others.end(), n) != others.end(); });
    }

    /// Takes again and again the highest stroke before which none of the others must be written.
    void by_pairs(std::vector<std::size_t> set) {
        std::stable_sort(set.begin(), set.end(), [&](std::size_t a, std::size_t b) {
            const auto key = [&](std::size_t i) {
                const Vec2 p = strokes_[i].front().begin;
                return -p.y + kAcross * p.x;
            };
            return key(a) < key(b);
        });
        while (!set.empty()) {
            auto next = std::find_if(set.begin(), set.end(), [&](std::size_t a) {
                return std::none_of(set.begin(), set.end(),
                                    [&](std::size_t b) { return a != b && before(b, a) == true; });
            });
            if (next == set.end()) next = set.begin();
            order_.push_back(*next);
            set.erase(next);
        }
    }

    const Skeleton& s_;
    std::vector<Stroke> strokes_;
    std::vector<Box> boxes_;
    std::vector<std::size_t> order_;
};

}  // namespace

StrokeOrder order_by_rules(const Skeleton& skeleton) {
    std::vector<Run> runs = Runs(skeleton).all();
    for (Run& run : runs) orient(run);
    return Sorting(skeleton, Folds(std::move(runs)).all()).sorted();
}

StrokeOrder parse_order(std::string_view text, std::size_t n_pieces) {
    StrokeOrder order;
    std::vector<std::uint8_t> used(n_pieces, 0);
    for (const std::string_view word : split_words(text)) {
        std::vector<PieceUse>& stroke = order.emplace_back();
        for (std::size_t i = 0; i <= word.size();) {
            const std::string_view item = word.substr(i, word.find('+', i) - i);
            i += item.size() + 1;
            const bool back = !item.empty() && item.front() == '-';
            std::size_t number = 0;
            const char* const end = item.data() + item.size();
            const auto [rest, fault] = std::from_chars(item.data() + back, end, number);
            if (fault != std::errc() || rest != end || number < 1 || number > n_pieces)
                throw Error(
                    Message("'{}' in the order names no piece from 1 to {}", excerpt(std::string(word)), n_pieces));
            if (used[number - 1]++) throw Error(Message("piece {} is in the order twice", number));
            stroke.push_back({number - 1, back});
        }
    }
    if (order.empty()) throw Error(Message("the order of strokes is empty"));
    return order;
}

std::string order_text(const StrokeOrder& order) {
    std::string out;
    for (const std::vector<PieceUse>& stroke : order) {
        if (!out.empty()) out += ' ';
        for (std::size_t i = 0; i < stroke.size(); ++i)
            out += fmt::format("{}{}{}", i > 0 ? "+" : "", stroke[i].reversed ? "-" : "", stroke[i].piece + 1);
    }
    return out;
}

}  // namespace tuft::writer
