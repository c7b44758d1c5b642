#include "atlas/flatten/dissection.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <numeric>

#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

constexpr std::uint32_t kNone = ~0u;
constexpr std::uint32_t kSmall = 4;     // vertices that are one part: more are more arithmetic, fewer more overhead
constexpr std::uint32_t kLarge = 4096;  // vertices of which both halves are ordered at the same time

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
    }

    Dissection run() {
        Dissection out;
        halve(0, static_cast<std::uint32_t>(vertex_.size()), out.parts);
        out.order = std::move(vertex_);
        return out;
    }

  private:
    using Parts = std::vector<Dissection::Part>;

    /// Orders the vertices in places `begin` to `end` − 1, and adds their parts. Returns the number of those without a
    /// parent.
    std::uint32_t halve(std::uint32_t begin, std::uint32_t end, Parts& parts) {
        if (end - begin <= kSmall) return add_part(begin, end, 0, parts);
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
        put_in_place(begin, end);
        if (end - begin <= kLarge) {
            const std::uint32_t n_roots = halve(begin, half, parts);
            return add_part(first, end, n_roots + halve(half, first, parts), parts);
        }
        std::array<Parts, 2> of;
        std::array<std::uint32_t, 2> n_roots{};
        parallel_for(2, 1, [&](std::size_t k, std::size_t last) {
            for (; k < last; ++k) n_roots[k] = k == 0 ? halve(begin, half, of[k]) : halve(half, first, of[k]);
        });
        for (const Parts& p : of) parts.insert(parts.end(), p.begin(), p.end());
        return add_part(first, end, n_roots[0] + n_roots[1], parts);
    }

    /// Other threads ask for places at the same time: whether they are within ranges that this does not change.
    void put_in_place(std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = begin; i < end; ++i)
            std::atomic_ref(place_[vertex_[i]]).store(i, std::memory_order_relaxed);
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
        put_in_place(begin, end);
        return middle;
    }

    bool is_next_to(std::uint32_t v, std::uint32_t begin, std::uint32_t end) {
        for (std::uint32_t i = graph_.start[v]; i < graph_.start[v + 1]; ++i) {
            const std::uint32_t at = std::atomic_ref(place_[graph_.neighbours[i]]).load(std::memory_order_relaxed);
            if (at >= begin && at < end) return true;
        }
        return false;
    }

    /// What is in places `begin` to `end` − 1 stays there.
    static std::uint32_t add_part(std::uint32_t begin, std::uint32_t end, std::uint32_t n_roots, Parts& parts) {
        if (begin == end) return n_roots;
        parts.push_back({begin, end - begin, n_roots});
        return 1;
    }

    const Neighbours& graph_;
    std::vector<Vec2> at_;
    std::vector<std::uint32_t> rank_;            // by which vertices at one place are told apart
    std::vector<std::uint32_t> vertex_, place_;  // vertices in the order so far; the place of each in it
    std::vector<std::uint8_t> on_border_;        // of the halves cut last
};

}  // namespace

Dissection dissect(const Neighbours& graph, std::span<const Vec2> at) {
    return Dissector(graph, at).run();
}

}  // namespace tuft::atlas
