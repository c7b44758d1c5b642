#include "atlas/flatten/dissection.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace tuft::atlas {
namespace {

constexpr std::size_t kLeaf = 8;  // vertices that are not parted
constexpr double kLongestCut =
    6;  // roots of the number of vertices: longer, and the part lies on itself
constexpr std::size_t kSmall = 1000;  // vertices of a part whose cut may be as long as it is

class Dissector {
  public:
    Dissector(std::span<const Vec2> at, std::span<const std::array<std::uint32_t, 3>> faces)
        : at_(at), start_(at.size() + 1, 0), part_(at.size(), 0), key_(at.size(), 0) {
        const std::size_t n = at.size();
        for (const auto& f : faces)
            for (const std::uint32_t v : f)
                if (v < n) start_[v + 1] += 2;
        std::partial_sum(start_.begin(), start_.end(), start_.begin());
        neighbours_.resize(start_[n]);
        std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
        for (const auto& f : faces)
            for (int k = 0; k < 3; ++k)
                if (f[k] < n)
                    for (int l = 1; l < 3; ++l) neighbours_[next[f[k]]++] = f[(k + l) % 3];
        out_.order.resize(n);
        std::iota(out_.order.begin(), out_.order.end(), 0u);
    }

    Dissection run() {
        cut(0, static_cast<std::uint32_t>(at_.size()), Dissection::kNoParent);
        // Cuts were found before their sides.
        const auto n = static_cast<std::uint32_t>(out_.nodes.size());
        std::reverse(out_.nodes.begin(), out_.nodes.end());
        for (Dissection::Node& node : out_.nodes)
            if (node.parent != Dissection::kNoParent) node.parent = n - 1 - node.parent;
        return std::move(out_);
    }

  private:
    using Place = std::vector<std::uint32_t>::iterator;
    Place place(std::uint32_t i) { return out_.order.begin() + i; }

    template <class Fn>
    void each_neighbour(std::uint32_t v, Fn&& fn) const {
        for (std::uint32_t i = start_[v]; i < start_[v + 1]; ++i)
            if (neighbours_[i] < at_.size()) fn(neighbours_[i]);
    }

    /// Keys along the longer side of a part.
    void by_place(std::uint32_t begin, std::uint32_t end) {
        Vec2 low = at_[*place(begin)], high = low;
        for (auto v = place(begin); v != place(end); ++v)
            low = glm::min(low, at_[*v]), high = glm::max(high, at_[*v]);
        const int axis = high.x - low.x >= high.y - low.y ? 0 : 1;
        for (auto v = place(begin); v != place(end); ++v) key_[*v] = at_[*v][axis];
    }

    /// Keys by the number of edges to the vertex that is farthest from some vertex.
    void by_steps(std::uint32_t begin, std::uint32_t end) {
        const std::uint32_t own = part_[*place(begin)];
        std::uint32_t from = *place(begin);
        std::vector<std::uint32_t> wave;
        for (int time = 0; time < 2; ++time) {
            for (auto v = place(begin); v != place(end); ++v) key_[*v] = HUGE_VAL;
            key_[from] = 0;
            wave.assign(1, from);
            for (std::size_t i = 0; i < wave.size(); ++i) {
                const std::uint32_t v = wave[i];
                each_neighbour(v, [&](std::uint32_t w) {
                    if (part_[w] != own || key_[w] < HUGE_VAL) return;
                    key_[w] = key_[v] + 1;
                    wave.push_back(w);
                });
            }
            from = wave.back();
        }
    }

    /// Brings the vertices with the lower keys to the front, then the others, then those of the
    /// first that have neighbours among these: the cut. The ends of both sides.
    std::pair<std::uint32_t, std::uint32_t> halves(std::uint32_t begin, std::uint32_t end) {
        const auto first = place(begin), middle = first + (end - begin) / 2, last = place(end);
        std::nth_element(first, middle, last, [&](std::uint32_t a, std::uint32_t b) {
            return key_[a] < key_[b] || (key_[a] == key_[b] && a < b);
        });
        const std::uint32_t beyond = ++n_parts_;
        for (auto v = middle; v != last; ++v) part_[*v] = beyond;
        const auto inner = std::stable_partition(first, middle, [&](std::uint32_t v) {
            bool cut = false;
            each_neighbour(v, [&](std::uint32_t w) { cut |= part_[w] == beyond; });
            return !cut;
        });
        const auto of_cut = static_cast<std::uint32_t>(middle - inner);
        std::rotate(inner, middle, last);
        return {static_cast<std::uint32_t>(inner - out_.order.begin()), end - of_cut};
    }

    void cut(std::uint32_t begin, std::uint32_t end, std::uint32_t parent) {
        const auto node = static_cast<std::uint32_t>(out_.nodes.size());
        if (end - begin <= kLeaf) {
            if (end > begin) out_.nodes.push_back({begin, end, parent});
            return;
        }
        by_place(begin, end);
        auto [split, sides] = halves(begin, end);
        if (end - begin > kSmall && end - sides > kLongestCut * std::sqrt(end - begin)) {
            const std::uint32_t whole = ++n_parts_;
            for (auto v = place(begin); v != place(end); ++v) part_[*v] = whole;
            by_steps(begin, end);
            std::tie(split, sides) = halves(begin, end);
        }
        out_.nodes.push_back({sides, end, parent});
        const std::uint32_t apart = ++n_parts_;
        for (auto v = place(sides); v != place(end); ++v) part_[*v] = apart;
        cut(split, sides, node);
        const std::uint32_t own = ++n_parts_;
        for (auto v = place(begin); v != place(split); ++v) part_[*v] = own;
        cut(begin, split, node);
    }

    std::span<const Vec2> at_;
    std::vector<std::uint32_t> start_, neighbours_;  // of each vertex, some of them twice
    std::vector<std::uint32_t> part_;
    std::vector<double> key_;
    std::uint32_t n_parts_ = 0;
    Dissection out_;
};

}  // namespace

Dissection dissect(std::span<const Vec2> at, std::span<const std::array<std::uint32_t, 3>> faces) {
    return Dissector(at, faces).run();
}

}  // namespace tuft::atlas
