#include "atlas/flatten/dissection.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace tuft::atlas {
namespace {

constexpr std::uint32_t kNone = ~0u;
constexpr std::uint32_t kSmall = 4;  // vertices that are one part: more are more arithmetic, fewer more overhead

/// Place of each vertex in a breadth-first search: neighbours lie near each other in it.
std::vector<std::uint32_t> breadth_first_ranks(const Neighbours& graph, std::size_t n) {
    std::vector<std::uint32_t> rank(n, kNone), queue;
    queue.reserve(n);
    for (std::uint32_t seed = 0; seed < n; ++seed) {
        if (rank[seed] != kNone) continue;
        const auto reach = [&](std::uint32_t v) {
            if (rank[v] != kNone) return;
            rank[v] = static_cast<std::uint32_t>(queue.size());
            queue.push_back(v);
        };
        std::size_t next = queue.size();
        for (reach(seed); next < queue.size(); ++next)
            for (std::uint32_t i = graph.start[queue[next]]; i < graph.start[queue[next] + 1]; ++i)
                reach(graph.neighbours[i]);
    }
    return rank;
}

class Dissector {
  public:
    Dissector(const Neighbours& graph, std::span<const Vec2> at)
        : graph_(graph),
          at_(at.begin(), at.end()),
          rank_(breadth_first_ranks(graph, at.size())),
          vertex_(at.size()),
          place_(at.size()),
          on_border_(at.size()) {
        for (Vec2& p : at_)
            if (!std::isfinite(p.x) || !std::isfinite(p.y)) p = Vec2(0);
        std::iota(vertex_.begin(), vertex_.end(), 0u);
        std::iota(place_.begin(), place_.end(), 0u);
        out_.order.reserve(at.size());
    }

    Dissection run() {
        halve(0, static_cast<std::uint32_t>(vertex_.size()));
        return std::move(out_);
    }

  private:
    /// Orders the vertices in places `begin` to `end` − 1. Returns the number of parts without a parent.
    std::uint32_t halve(std::uint32_t begin, std::uint32_t end) {
        if (end - begin <= kSmall) return add_part(begin, end, 0);
        const std::uint32_t middle = split(begin, end);
        // The smaller border of the two halves goes to the end.
        std::uint32_t n_left = 0, n_right = 0;
        for (std::uint32_t i = begin; i < end; ++i) {
            const bool left = i < middle;
            const bool next = left ? is_next_to(vertex_[i], middle, end) : is_next_to(vertex_[i], begin, middle);
            on_border_[vertex_[i]] = next;
            (left ? n_left : n_right) += next;
        }
        if (n_left < n_right) std::rotate(vertex_.begin() + begin, vertex_.begin() + middle, vertex_.begin() + end);
        const std::uint32_t half = n_left < n_right ? begin + end - middle : middle;
        const auto border = std::stable_partition(vertex_.begin() + half, vertex_.begin() + end,
                                                  [&](std::uint32_t v) { return !on_border_[v]; });
        const auto first = static_cast<std::uint32_t>(border - vertex_.begin());
        for (std::uint32_t i = begin; i < end; ++i) place_[vertex_[i]] = i;
        const std::uint32_t n_roots = halve(begin, half) + halve(half, first);
        return add_part(first, end, n_roots);
    }

    /// Puts those on one side of the median before the others. Returns where these begin.
    std::uint32_t split(std::uint32_t begin, std::uint32_t end) {
        Vec2 lo = at_[vertex_[begin]], hi = lo;
        for (std::uint32_t i = begin; i < end; ++i) {
            lo = glm::min(lo, at_[vertex_[i]]);
            hi = glm::max(hi, at_[vertex_[i]]);
        }
        const int axis = hi.y - lo.y > hi.x - lo.x ? 1 : 0;
        const std::uint32_t middle = begin + (end - begin) / 2;
        std::nth_element(vertex_.begin() + begin, vertex_.begin() + middle, vertex_.begin() + end,
                         [&](std::uint32_t v, std::uint32_t w) {
                             const double a = at_[v][axis], b = at_[w][axis];
                             return a != b ? a < b : rank_[v] < rank_[w];
                         });
        for (std::uint32_t i = begin; i < end; ++i) place_[vertex_[i]] = i;
        return middle;
    }

    bool is_next_to(std::uint32_t v, std::uint32_t begin, std::uint32_t end) const {
        for (std::uint32_t i = graph_.start[v]; i < graph_.start[v + 1]; ++i)
            if (const std::uint32_t at = place_[graph_.neighbours[i]]; at >= begin && at < end) return true;
        return false;
    }

    std::uint32_t add_part(std::uint32_t begin, std::uint32_t end, std::uint32_t n_roots) {
        if (begin == end) return n_roots;
        out_.parts.push_back({static_cast<std::uint32_t>(out_.order.size()), end - begin, n_roots});
        out_.order.insert(out_.order.end(), vertex_.begin() + begin, vertex_.begin() + end);
        return 1;
    }

    const Neighbours& graph_;
    std::vector<Vec2> at_;
    std::vector<std::uint32_t> rank_;            // by which vertices at one place are told apart
    std::vector<std::uint32_t> vertex_, place_;  // vertices in the order so far; the place of each in it
    std::vector<std::uint8_t> on_border_;        // of the halves cut last
    Dissection out_;
};

}  // namespace

Dissection dissect(const Neighbours& graph, std::span<const Vec2> at) {
    return Dissector(graph, at).run();
}

}  // namespace tuft::atlas
