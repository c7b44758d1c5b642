#include "writer/copy/correction.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "core/error.h"
#include "core/text/text.h"
#include "core/text/words.h"

namespace tuft::writer {
namespace {

constexpr double kCutSteps = 1000;  // of a piece's length, in `cuts_text`

/// Where a piece is cut, its two parts take its place in the order.
void follow_cut(StrokeOrder& order, std::size_t piece, std::size_t rest) {
    for (std::vector<PieceUse>& stroke : order)
        for (std::size_t k = 0; k < stroke.size(); ++k) {
            if (stroke[k].piece != piece) continue;
            const bool back = stroke[k].reversed;
            stroke.insert(stroke.begin() + static_cast<std::ptrdiff_t>(back ? k : k + 1), {rest, back});
            return;
        }
}

template <class T>
bool read_whole(std::string_view text, T& value) {
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    return fault == std::errc() && end == text.data() + text.size();
}

}  // namespace

CopiedPicture take_apart(const io::Image8& picture, const std::string& source, const CopyCorrection& correction) {
    CopiedPicture out{.ink = picture_ink(picture, source, correction.threshold), .skeleton = {}, .order = {}};
    out.skeleton = skeleton_of(out.ink.cells);
    if (correction.order.empty()) out.order = order_by_rules(out.skeleton);
    for (const PieceCut& cut : correction.cuts) {
        cut_piece(out.skeleton, cut);
        if (correction.order.empty()) follow_cut(out.order, cut.piece, out.skeleton.pieces.size() - 1);
    }
    if (!correction.order.empty()) out.order = parse_order(correction.order, out.skeleton.pieces.size());
    return out;
}

std::vector<PieceCut> parse_cuts(std::string_view text) {
    std::vector<PieceCut> cuts;
    for (const std::string_view word : split_words(text)) {
        const std::size_t colon = word.find(':');
        std::size_t number = 0;
        double part = 0;
        if (colon == std::string_view::npos || !read_whole(word.substr(0, colon), number) || number < 1 ||
            !read_whole(word.substr(colon + 1), part) || !(part > 0 && part < 1))
            throw Error(Message("'{}' is no cut: PIECE:PART, such as 3:0.45", excerpt(std::string(word))));
        cuts.push_back({number - 1, part});
    }
    return cuts;
}

std::string cuts_text(const std::vector<PieceCut>& cuts) {
    std::string out;
    for (const PieceCut& cut : cuts) out += fmt::format("{}{}:{:.3f}", out.empty() ? "" : " ", cut.piece + 1, cut.at);
    return out;
}

void move_stroke(StrokeOrder& order, std::size_t stroke, std::size_t to) {
    std::vector<PieceUse> moved = std::move(order[stroke]);
    order.erase(order.begin() + static_cast<std::ptrdiff_t>(stroke));
    order.insert(order.begin() + static_cast<std::ptrdiff_t>(std::min(to, order.size())), std::move(moved));
}

void reverse_stroke(StrokeOrder& order, std::size_t stroke) {
    std::reverse(order[stroke].begin(), order[stroke].end());
    for (PieceUse& use : order[stroke]) use.reversed = !use.reversed;
}

void join_strokes(StrokeOrder& order, std::size_t stroke, std::size_t other) {
    if (stroke == other) return;
    const std::vector<PieceUse> added = order[other];
    order[stroke].insert(order[stroke].end(), added.begin(), added.end());
    remove_stroke(order, other);
}

void remove_stroke(StrokeOrder& order, std::size_t stroke) {
    order.erase(order.begin() + static_cast<std::ptrdiff_t>(stroke));
}

StrokePlace nearest_place(const CopiedPicture& copy, const Vec2& point) {
    StrokePlace best{.distance = 1e300};
    for (std::size_t s = 0; s < copy.order.size(); ++s)
        for (std::size_t k = 0; k < copy.order[s].size(); ++k) {
            const Piece& piece = copy.skeleton.pieces[copy.order[s][k].piece];
            double along = 0;
            for (std::size_t i = 1; i < piece.line.size(); ++i) {
                const Vec2 a = piece.line[i - 1], d = piece.line[i] - a;
                const double square = glm::dot(d, d);
                const double t = square > 0 ? std::clamp(glm::dot(point - a, d) / square, 0.0, 1.0) : 0;
                const double away = glm::distance(point, a + t * d);
                if (away < best.distance)
                    best = {s, k, (along + t * std::sqrt(square)) / std::max(piece.length(), 1e-9), away};
                along += std::sqrt(square);
            }
        }
    return best;
}

CopyCorrection split_at(const CopiedPicture& copy, const CopyCorrection& before, const StrokePlace& place) {
    StrokeOrder order = copy.order;
    CopyCorrection out = before;
    std::vector<PieceUse>& stroke = order[place.stroke];
    const PieceUse use = stroke[place.use];
    const double length = copy.skeleton.pieces[use.piece].length();
    const double from_begin = length * (use.reversed ? 1 - place.at : place.at), to_end = length - from_begin;
    std::size_t first = place.use + 1;  // piece with which the second stroke begins
    if (std::min(from_begin, to_end) < kJointReach) {
        if (from_begin < to_end) --first;
    } else {
        const double at = std::clamp(std::round(place.at * kCutSteps), 1.0, kCutSteps - 1) / kCutSteps;
        const std::size_t rest = copy.skeleton.pieces.size();
        out.cuts.push_back({use.piece, at});
        follow_cut(order, use.piece, rest);
    }
    if (first > 0 && first < stroke.size()) {
        std::vector<PieceUse> second(stroke.begin() + static_cast<std::ptrdiff_t>(first), stroke.end());
        stroke.resize(first);
        order.insert(order.begin() + static_cast<std::ptrdiff_t>(place.stroke) + 1, std::move(second));
    }
    out.order = order_text(order);
    return out;
}

}  // namespace tuft::writer
