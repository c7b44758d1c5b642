#include "atlas/seams/seam_paths.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tuft::atlas {
namespace {

constexpr double kCreaseDiscount = 0.4;  // part of the length that an edge bent by kCrease saves
constexpr double kCrease = 0.7;          // radians
constexpr float kShorter = 0.999f;       // a new path over the old one, at most

/// Length of an edge, less where it is bent.
float edge_weight(const Patch& patch, std::uint32_t h) {
    const float cosine = glm::dot(patch.normal[h / 3], patch.normal[patch.twin[h] / 3]);
    const float bend = std::acos(std::clamp(cosine, -1.f, 1.f));
    const float crease = std::min(1.f, bend / float(kCrease));
    return patch.length[h] * (1 - float(kCreaseDiscount) * crease);
}

}  // namespace

/// All half-edges that leave an inner vertex.
template <class Visit>
void SeamPaths::around(std::uint32_t start, Visit&& visit) const {
    std::uint32_t h = start;
    do {
        visit(h);
        h = twin(prev_half(h));
    } while (h != start && h != kNone);
}

SeamPaths::SeamPaths(const Patch& patch, std::vector<std::uint8_t> seam, std::vector<std::uint32_t> chart)
    : seam_(std::move(seam)),
      chart_(std::move(chart)),
      degree_(patch.n_vertices, 0),
      border_(patch.n_vertices, 0),
      corner_(patch.n_vertices, 0) {
    resize_in_large_pages(half_, seam_.size());
    for (std::uint32_t h = 0; h < seam_.size(); ++h) {
        const std::uint32_t a = patch.vertex[h], b = patch.vertex[next_half(h)];
        const std::uint32_t g = patch.twin[h];
        half_[h] = {.twin = g, .origin = a, .length = patch.length[h]};
        if (g == kNone) border_[a] = border_[b] = 1;
        if (g != kNone && g < h) half_[g].weight = half_[h].weight = edge_weight(patch, h);
        if (seam_[h] && (g == kNone || g > h)) {
            ++degree_[a];
            ++degree_[b];
        }
    }
    if (chart_.empty()) {
        chart_.assign(patch.triangles.size(), kNone);
        for (std::uint32_t t = 0; t < chart_.size(); ++t)
            if (chart_[t] == kNone) sweep(t, t, nullptr);
    }
    const std::vector<float> angle = vertex_angles(patch);
    for (std::uint32_t v = 0; v < patch.n_vertices; ++v)
        corner_[v] = border_[v] || std::abs(angle[v] - 2 * std::numbers::pi) > kSlitDefect;
}

/// The seam half-edge that goes on from the end of h, where only two seam edges meet.
std::uint32_t SeamPaths::onward(std::uint32_t h) const {
    std::uint32_t g = next_half(h);
    while (!seam_[g]) g = next_half(twin(g));
    return g;
}

std::vector<std::uint32_t> SeamPaths::chain_from(std::uint32_t h) const {
    std::vector<std::uint32_t> chain{h};
    while (!is_corner(end(chain.back()))) chain.push_back(onward(chain.back()));
    return chain;
}

/// Half-edges that leave the origin of seam half-edge h on both sides of it, up to the next
/// seams, h included.
std::vector<std::uint32_t> SeamPaths::wedge(std::uint32_t h) const {
    std::vector<std::uint32_t> out{h};
    for (std::uint32_t g = twin(prev_half(h)); g != kNone && !seam_[g]; g = twin(prev_half(g))) out.push_back(g);
    for (std::uint32_t g = next_half(twin(h)); !seam_[g]; g = next_half(twin(g))) out.push_back(g);
    return out;
}

/// Adds to the half-edges into the two charts from the corner that h (of the chain) leaves
/// those from places up to `reach` along the borders that the charts have there with others.
void SeamPaths::slide(std::uint32_t h, float reach, std::vector<std::uint32_t>& starts) const {
    const std::uint32_t a = chart_[h / 3], b = chart_[twin(h) / 3];
    if (a == b) return;
    const auto slides = [&](std::uint32_t border, std::uint32_t to) {
        const std::uint32_t g = twin(border);
        return degree_[to] == 2 && (g == kNone || (chart_[g / 3] != a && chart_[g / 3] != b));
    };
    std::uint32_t g = h;
    while (!seam_[prev_half(g)]) g = twin(prev_half(g));
    std::uint32_t border = prev_half(g);  // backwards along a's
    for (float gone = length(border); gone <= reach && slides(border, origin(border));) {
        for (g = border; !seam_[prev_half(g)];) starts.push_back(g = twin(prev_half(g)));
        border = prev_half(g);
        gone += length(border);
    }
    for (border = next_half(twin(h)); !seam_[border];) border = next_half(twin(border));  // forwards along b's
    for (float gone = length(border); gone <= reach && slides(border, end(border));) {
        for (border = next_half(border); !seam_[border]; border = next_half(twin(border))) starts.push_back(border);
        gone += length(border);
    }
}

/// Marks inner vertices within `reach` of the chain. Their distances do not depend on the order in which they are
/// reached, so those of about an edge's length are not sorted.
void SeamPaths::mark_band(const std::vector<std::uint32_t>& chain, float reach, PathSearch& s) const {
    float all = 0;
    for (const std::uint32_t h : chain) all += length(h);
    const float per_step = all > 0 ? static_cast<float>(chain.size()) / all : 0.f;
    const auto step_of = [&](float d) { return static_cast<std::size_t>(d * per_step); };
    if (s.by_distance_.size() <= step_of(reach)) s.by_distance_.resize(step_of(reach) + 1);
    const auto offer = [&](std::uint32_t v, float d, std::uint32_t h) {
        if (d >= s.at_[v].band || d > reach) return;
        if (s.at_[v].band == kFar) s.marked_.push_back(v);
        s.at_[v].band = d;
        s.by_distance_[step_of(d)].push_back({d, v, h});
    };
    const auto offer_ends = [&](std::uint32_t h, float d) {
        const std::uint32_t v = end(h);
        const float there = d + length(h);
        // Most are nearer already, which is asked first.
        if (there < s.at_[v].band && !border_[v] && degree_[v] == 0) offer(v, there, twin(h));
    };
    for (std::size_t i = 1; i < chain.size(); ++i) offer(origin(chain[i]), 0, chain[i]);
    for (const auto* ends : {&s.starts_, &s.goals_})
        for (const std::uint32_t h : *ends)
            if (!seam_[h]) offer_ends(h, 0);
    for (std::size_t step = 0; step <= step_of(reach); ++step) {
        std::vector<PathSearch::QueueEntry>& now = s.by_distance_[step];
        for (std::size_t i = 0; i < now.size(); ++i) {  // which grows
            const PathSearch::QueueEntry at = now[i];
            if (at.distance > s.at_[at.vertex].band) continue;
            around(at.half, [&](std::uint32_t h) { offer_ends(h, at.distance); });
        }
        now = {};  // all together would be larger than the mesh
    }
}

SeamMove SeamPaths::shorten(std::vector<std::uint32_t> chain, float reach, Corners corners, PathSearch& s) const {
    SeamMove move;
    move.chain = std::move(chain);
    if (origin(move.chain.front()) == end(move.chain.back())) return move;
    float length = 0, now = 0;
    for (const std::uint32_t h : move.chain) {
        length += half_[h].length;
        now += half_[h].weight;
    }
    // Only edges inside the two charts may leave and enter the ends.
    const std::uint32_t first = move.chain.front(), back = twin(move.chain.back());
    s.starts_ = wedge(first);
    s.goals_ = wedge(back);
    if (corners == Corners::move) {
        slide(first, reach * length, s.starts_);
        slide(back, reach * length, s.goals_);
    }
    for (const std::uint32_t h : s.starts_) s.at_[origin(h)].is_start = true;
    std::erase_if(s.goals_, [&](std::uint32_t h) { return s.at_[origin(h)].is_start; });
    for (const std::uint32_t h : s.goals_) s.goal_[h] = 1;
    mark_band(move.chain, reach * length, s);

    Queue queue;
    std::uint32_t last = kNone;  // half-edge into a goal
    float best = kShorter * now;
    const auto offer = [&](std::uint32_t h, float d) {
        const std::uint32_t v = end(h);
        if (d >= best || d >= s.at_[v].distance) return;
        if (s.at_[v].band == kFar) {  // as all goals are, which lie on other seams
            if (s.goal_[twin(h)]) {
                best = d;
                last = h;
            }
            return;
        }
        if (s.at_[v].distance == kFar) s.touched_.push_back(v);
        s.at_[v].distance = d;
        s.at_[v].reached_by = h;
        queue.push({d, v, h});
    };
    for (const std::uint32_t h : s.starts_) offer(h, half_[h].weight);
    while (!queue.empty()) {
        const Entry top = queue.top();
        queue.pop();
        if (top.distance >= best) break;
        if (top.distance > s.at_[top.vertex].distance) continue;
        around(twin(top.half), [&](std::uint32_t h) { offer(h, top.distance + half_[h].weight); });
    }
    if (last != kNone) {
        move.saved = now - best;
        move.path.assign(1, last);
        while (!s.at_[origin(move.path.back())].is_start)
            move.path.push_back(s.at_[origin(move.path.back())].reached_by);
        std::reverse(move.path.begin(), move.path.end());
    }
    clear(s);
    return move;
}

void SeamPaths::clear(PathSearch& s) const {
    for (const std::uint32_t v : s.touched_) s.at_[v].distance = kFar;
    for (const std::uint32_t v : s.marked_) s.at_[v].band = kFar;
    for (const std::uint32_t h : s.starts_) s.at_[origin(h)].is_start = false;
    for (const std::uint32_t h : s.goals_) s.goal_[h] = 0;
    s.touched_.clear();
    s.marked_.clear();
}

void SeamPaths::set_seam(std::uint32_t h, bool on) {
    seam_[h] = seam_[twin(h)] = on;
    for (const std::uint32_t v : {origin(h), end(h)}) degree_[v] += on ? 1u : ~0u;
}

/// Gives `start` and what hangs together with it to a chart.
void SeamPaths::sweep(std::uint32_t start, std::uint32_t chart, std::vector<std::uint32_t>* swept) {
    if (chart_[start] == chart) return;
    chart_[start] = chart;
    queue_.assign(1, start);
    for (std::size_t i = 0; i < queue_.size(); ++i)
        for (std::uint32_t h = 3 * queue_[i]; h < 3 * queue_[i] + 3; ++h) {
            if (seam_[h] || chart_[twin(h) / 3] == chart) continue;
            chart_[twin(h) / 3] = chart;
            queue_.push_back(twin(h) / 3);
        }
    if (swept != nullptr) swept->insert(swept->end(), queue_.begin(), queue_.end());
}

void SeamPaths::move(const SeamMove& move, std::vector<std::uint32_t>* swept) {
    const std::uint32_t h = move.chain.front();
    const std::uint32_t left = chart_[h / 3], right = chart_[twin(h) / 3];
    for (const std::uint32_t g : move.chain) set_seam(g, false);
    for (const std::uint32_t g : move.path) set_seam(g, true);
    if (left == right) return;
    for (const std::uint32_t g : move.path) {
        sweep(g / 3, left, swept == nullptr ? nullptr : swept + 1);
        sweep(twin(g) / 3, right, swept);
    }
}

}  // namespace tuft::atlas
