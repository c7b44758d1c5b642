#include "atlas/straighten.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <queue>

namespace tuft::atlas {
namespace {

constexpr double kCreaseDiscount = 0.6;  // part of the length that an edge bent by kCrease saves
constexpr double kCrease = 0.7;          // radians
constexpr int kRounds = 2;

class Straightener {
  public:
    Straightener(const Patch& patch, std::vector<std::uint8_t>& seam)
        : patch_(patch),
          seam_(seam),
          degree_(patch.n_vertices, 0),
          border_(patch.n_vertices, 0),
          corner_(patch.n_vertices, 0),
          distance_(patch.n_vertices, kFar),
          weight_from_(patch.n_vertices, kNone),
          band_(patch.n_vertices, kFar) {
        for (std::uint32_t h = 0; h < seam.size(); ++h) {
            const std::uint32_t a = origin(h), b = origin(next_half(h));
            if (patch.twin[h] == kNone) border_[a] = border_[b] = 1;
            if (seam[h] && (patch.twin[h] == kNone || patch.twin[h] > h)) {
                ++degree_[a];
                ++degree_[b];
            }
        }
        const std::vector<float> angle = vertex_angles(patch);
        for (std::uint32_t v = 0; v < patch.n_vertices; ++v)
            corner_[v] = border_[v] || std::abs(angle[v] - 2 * std::numbers::pi) > kSlitDefect;
    }

    void run(std::span<const float> reach) {
        std::vector<std::uint8_t> seen(seam_.size(), 0);
        for (std::uint32_t h = 0; h < seam_.size(); ++h) {
            if (!seam_[h] || patch_.twin[h] == kNone || seen[h] || !is_corner(origin(h))) continue;
            std::vector<std::uint32_t> chain{h};
            while (!is_corner(end(chain.back()))) chain.push_back(onward(chain.back()));
            for (const std::uint32_t g : chain) seen[g] = seen[patch_.twin[g]] = 1;
            const std::uint32_t twin = patch_.twin[h];
            const float r = reach.empty() ? kSeamReach : std::min(reach[h / 3], reach[twin / 3]);
            path_.clear();
            if (r > 0) shorten(chain, r);
            for (const std::uint32_t g : path_) seen[g] = seen[patch_.twin[g]] = 1;
        }
    }

  private:
    static constexpr float kFar = std::numeric_limits<float>::infinity();

    std::uint32_t origin(std::uint32_t h) const { return patch_.vertex[h]; }
    std::uint32_t end(std::uint32_t h) const { return patch_.vertex[next_half(h)]; }
    bool is_corner(std::uint32_t v) const { return corner_[v] || degree_[v] != 2; }

    /// The seam half-edge that goes on from the end of h, where only two seam edges meet.
    std::uint32_t onward(std::uint32_t h) const {
        std::uint32_t g = next_half(h);
        while (!seam_[g]) g = next_half(patch_.twin[g]);
        return g;
    }

    float weight(std::uint32_t h) const {
        const float cosine = glm::dot(patch_.normal[h / 3], patch_.normal[patch_.twin[h] / 3]);
        const float bend = std::acos(std::clamp(cosine, -1.f, 1.f));
        const float crease = std::min(1.f, bend / float(kCrease));
        return patch_.length[h] * (1 - float(kCreaseDiscount) * crease);
    }

    /// Half-edges that leave v on both sides of half-edge h (which leaves v), up to the
    /// next seams, h included.
    void wedge(std::uint32_t h, std::vector<std::uint32_t>& out) const {
        out.assign(1, h);
        for (std::uint32_t g = patch_.twin[prev_half(h)]; g != kNone && !seam_[g];
             g = patch_.twin[prev_half(g)])
            out.push_back(g);
        for (std::uint32_t t = patch_.twin[h]; t != kNone;) {
            const std::uint32_t g = next_half(t);
            if (seam_[g]) break;
            out.push_back(g);
            t = patch_.twin[g];
        }
    }

    /// All half-edges that leave an inner vertex.
    template <class Visit>
    void around(std::uint32_t start, Visit&& visit) const {
        std::uint32_t h = start;
        do {
            visit(h);
            h = patch_.twin[prev_half(h)];
        } while (h != start && h != kNone);
    }

    void set_seam(std::uint32_t h, bool on) {
        seam_[h] = seam_[patch_.twin[h]] = on;
        for (const std::uint32_t v : {origin(h), end(h)}) degree_[v] += on ? 1u : ~0u;
    }

    /// Marks inner vertices within `reach` of the chain.
    void mark_band(const std::vector<std::uint32_t>& chain, float reach) {
        Queue queue;
        const auto offer = [&](std::uint32_t v, float d, std::uint32_t h) {
            if (d >= band_[v] || d > reach) return;
            if (band_[v] == kFar) marked_.push_back(v);
            band_[v] = d;
            queue.push({d, v, h});
        };
        for (std::size_t i = 1; i < chain.size(); ++i) offer(origin(chain[i]), 0, chain[i]);
        while (!queue.empty()) {
            const Entry top = queue.top();
            queue.pop();
            if (top.distance > band_[top.vertex]) continue;
            around(top.half, [&](std::uint32_t h) {
                const std::uint32_t v = end(h);
                if (!border_[v] && degree_[v] == 0)
                    offer(v, top.distance + patch_.length[h], patch_.twin[h]);
            });
        }
    }

    void shorten(const std::vector<std::uint32_t>& chain, float reach) {
        const std::uint32_t from = origin(chain.front()), to = end(chain.back());
        if (from == to || chain.size() < 2) return;
        float length = 0, now = 0;
        for (const std::uint32_t h : chain) {
            length += patch_.length[h];
            now += weight(h);
        }
        mark_band(chain, reach * length);

        // Only edges inside the two charts may leave and enter the corners.
        std::vector<std::uint32_t> first, last;
        wedge(chain.front(), first);
        wedge(patch_.twin[chain.back()], last);
        Queue queue;
        const auto offer = [&](std::uint32_t h, float d) {
            const std::uint32_t v = end(h);
            if (v != to && band_[v] == kFar) return;
            if (v == to && std::find(last.begin(), last.end(), patch_.twin[h]) == last.end())
                return;
            if (d >= distance_[v]) return;
            if (distance_[v] == kFar) touched_.push_back(v);
            distance_[v] = d;
            weight_from_[v] = h;
            queue.push({d, v, h});
        };
        for (const std::uint32_t h : first)
            if (patch_.twin[h] != kNone) offer(h, weight(h));
        while (!queue.empty()) {
            const Entry top = queue.top();
            queue.pop();
            if (top.vertex == to) break;
            if (top.distance > distance_[top.vertex]) continue;
            around(patch_.twin[top.half],
                   [&](std::uint32_t h) { offer(h, top.distance + weight(h)); });
        }
        if (distance_[to] < 0.999f * now) {
            for (std::uint32_t v = to; v != from; v = origin(path_.back()))
                path_.push_back(weight_from_[v]);
            for (const std::uint32_t h : chain) set_seam(h, false);
            for (const std::uint32_t h : path_) set_seam(h, true);
        }
        for (const std::uint32_t v : touched_) distance_[v] = kFar;
        for (const std::uint32_t v : marked_) band_[v] = kFar;
        touched_.clear();
        marked_.clear();
    }

    struct Entry {
        float distance;
        std::uint32_t vertex, half;  // a half-edge that leaves (band) or reaches (path) the vertex
        bool operator<(const Entry& o) const {
            return distance != o.distance ? distance > o.distance : half > o.half;
        }
    };
    using Queue = std::priority_queue<Entry>;

    const Patch& patch_;
    std::vector<std::uint8_t>& seam_;
    std::vector<std::uint32_t> degree_;
    std::vector<std::uint8_t> border_, corner_;
    std::vector<float> distance_;
    std::vector<std::uint32_t> weight_from_;
    std::vector<float> band_;
    std::vector<std::uint32_t> marked_, touched_, path_;
};

}  // namespace

void straighten_seams(const Patch& patch, std::vector<std::uint8_t>& seam,
                      std::span<const float> reach) {
    for (int round = 0; round < kRounds; ++round) Straightener(patch, seam).run(reach);
}

}  // namespace tuft::atlas
