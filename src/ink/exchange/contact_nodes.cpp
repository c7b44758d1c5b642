#include "ink/exchange/contact_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tuft::ink {
namespace {

using Content = Reservoir::Content;
constexpr int kPlanes = Reservoir::kPlanes;
constexpr double kAlike = 1e-6;  // of a mixture: float parts of it do not differ by less

/// Cells of a bundle round a place along the hair, with their weights.
struct Between {
    std::size_t cell = 0;  ///< and the one after it
    double next = 0;       ///< weight of that
};

Between cells_at(const ReservoirLayout& layout, double along) {
    const std::size_t n = layout.cell_ends.size();
    const auto middle = [&](std::size_t c) { return 0.5 * ((c ? layout.cell_ends[c - 1] : 0) + layout.cell_ends[c]); };
    if (n == 1 || along <= middle(0)) return {0, 0};
    for (std::size_t c = 0; c + 1 < n; ++c)
        if (along < middle(c + 1)) return {c, (along - middle(c)) / (middle(c + 1) - middle(c))};
    return {n - 2, 1};
}

/// `aside`: weight of a distance across the patch over one along it, squared.
int nearest_with_hair(const std::array<double, kNodes>& sums, int node, int aside) {
    int best = -1, least = std::numeric_limits<int>::max();
    for (int k = 0; k < kNodes; ++k) {
        const int i = k / kAcross - node / kAcross, j = k % kAcross - node % kAcross;
        if (const int distance = i * i + aside * j * j; sums[k] > 0 && distance < least) {
            best = k;
            least = distance;
        }
    }
    return best;
}

}  // namespace

NodeContact node_contact(const Reservoir& tuft, const ContactGrid& grid, std::span<const HairSample> samples,
                         const ContactCells& contact, NodesWithoutHair rule) {
    const std::size_t cells = tuft.n_cells(), n = tuft.content.size();
    Recycled<double> weight(kNodes * n, 0);
    std::array<double, kNodes> sums{};
    for (const HairSample& s : samples) {
        const Vec2 at = glm::clamp(grid.at(s.at), Vec2{0}, Vec2{kAlong - 1, kAcross - 1});
        const int i = std::min(static_cast<int>(at.x), kAlong - 2), j = std::min(static_cast<int>(at.y), kAcross - 2);
        const Vec2 f = at - Vec2{i, j};
        const Between hair = cells_at(tuft.layout, s.along);
        const std::size_t cell = s.bundle * cells + hair.cell;
        for (int k = 0; k < 4; ++k) {
            const double w = s.length * (k & 1 ? f.x : 1 - f.x) * (k & 2 ? f.y : 1 - f.y);
            if (!(w > 0)) continue;
            const int node = (i + (k & 1)) * kAcross + j + (k >> 1);
            double* of_node = weight.data() + static_cast<std::size_t>(node) * n;
            of_node[cell] += w * (1 - hair.next);
            if (hair.next > 0) of_node[cell + 1] += w * hair.next;
            sums[node] += w;
        }
    }
    NodeContact out;
    for (int node = 0; node < kNodes; ++node) {
        const int from = sums[node] > 0
                             ? node
                             : nearest_with_hair(sums, node, rule == NodesWithoutHair::column ? kAlong * kAlong : 1);
        const auto add = [&](std::uint32_t i, double part) {
            if (part > 0) out.shares.push_back({i, static_cast<float>(part)});
        };
        const double* of_node = from >= 0 ? weight.data() + static_cast<std::size_t>(from) * n : nullptr;
        for (std::uint32_t i = 0; i < n; ++i) {
            if (!of_node)
                add(i, contact.size() == n ? static_cast<double>(contact[i]) : tuft.cell_capacity[i] / tuft.capacity);
            else if (of_node[i] > 0)  // of few cells: hair of a node is in reach of it
                add(i, of_node[i] / sums[from]);
        }
        out.begin[node + 1] = static_cast<std::uint32_t>(out.shares.size());
    }
    return out;
}

bool is_mixed(const Reservoir& tuft) {
    const double all = tuft.remaining();
    if (!(all > 0)) return false;
    Content part{};
    for (const Content& c : tuft.content)
        for (int p = 0; p < kPlanes; ++p) part[p] += c[p];
    for (double& p : part) p /= all;
    for (const Content& c : tuft.content) {
        const double content = sum_of(c);
        double most = 0;
        for (int p = 0; p < kPlanes; ++p) most = std::max(most, std::abs(c[p] - part[p] * content));
        if (most > kAlike * content) return true;
    }
    return false;
}

NodeMixes mixes_at(const Reservoir& tuft, const NodeContact& nodes) {
    Content whole{};
    const double all = tuft.remaining();
    for (int p = 0; p < kPlanes && all > 0; ++p) whole[p] = tuft.pigment(p) / all;
    NodeMixes mixes{};
    for (int node = 0; node < kNodes; ++node) {
        Content sum{};
        for (const NodeContact::Share& s : nodes.of(node))
            for (int p = 0; p < kPlanes; ++p)
                sum[p] += static_cast<double>(s.part) / tuft.cell_capacity[s.cell] * tuft.content[s.cell][p];
        const double left = sum_of(sum);
        for (int p = 0; p < kPlanes; ++p) mixes[p][node] = static_cast<float>(left > 0 ? sum[p] / left : whole[p]);
    }
    return mixes;
}

void withdraw_contents(Reservoir& tuft, const NodeContents& given, const NodeContact& nodes) {
    const std::size_t n = tuft.content.size();
    Recycled<double> requested(n);
    for (int p = 0; p < kPlanes; ++p) {
        double lacking = 0;
        std::fill(requested.begin(), requested.end(), 0.0);
        for (int node = 0; node < kNodes; ++node) {
            lacking += given[node][p];
            double sum = 0;
            const auto content_of = [&](const NodeContact::Share& s) {
                return static_cast<double>(s.part) / tuft.cell_capacity[s.cell] * tuft.content[s.cell][p];
            };
            if (!(given[node][p] > 0)) continue;
            for (const NodeContact::Share& s : nodes.of(node)) sum += content_of(s);
            if (!(sum > 0)) continue;
            for (const NodeContact::Share& s : nodes.of(node))
                requested[s.cell] += given[node][p] * content_of(s) / sum;
        }
        for (std::size_t i = 0; i < n; ++i) {
            const double v = std::min({requested[i], tuft.content[i][p], std::max(lacking, 0.0)});
            tuft.content[i][p] -= v;
            lacking -= v;
        }
        const double rest = tuft.pigment(p);
        if (!(rest > 0) || lacking == 0) continue;
        const double part = std::min(lacking / rest, 1.0);  // rounding may also give back
        for (std::size_t i = 0; i < n; ++i) tuft.content[i][p] -= part * tuft.content[i][p];
    }
}

NodeContents draw(Reservoir& tuft, const std::array<double, kNodes>& amounts, const NodeContact& nodes,
                  const ContactCells& contact, bool from_afar) {
    NodeContents drawn{};
    std::array<double, kNodes> lacks = amounts;
    double lacking = 0;
    for (int node = 0; node < kNodes; ++node) {
        for (const NodeContact::Share& s : nodes.of(node)) {
            Content& cell = tuft.content[s.cell];
            const double content = sum_of(cell);
            const double want = std::min({content, static_cast<double>(s.part) * amounts[node], lacks[node]});
            if (!(want > 0)) continue;
            const double part = want / content;
            for (int p = 0; p < kPlanes; ++p) {
                const double v = part * cell[p];
                cell[p] -= v;
                drawn[node][p] += v;
            }
            lacks[node] -= want;
        }
        lacking += std::max(lacks[node], 0.0);
    }
    // Parts that sum to one in floats leave so little that it is not worth asking all the hair.
    double all = 0;
    for (const double amount : amounts) all += amount;
    if (!from_afar || !(lacking > kAlike * all)) return drawn;
    const Content rest = take(tuft, lacking, contact);
    for (int node = 0; node < kNodes; ++node)
        for (int p = 0; p < kPlanes; ++p) drawn[node][p] += std::max(lacks[node], 0.0) / lacking * rest[p];
    return drawn;
}

void absorb(Reservoir& tuft, const NodeContents& lifted, const NodeContact& nodes, const ContactCells& contact) {
    Content beyond{};
    for (int node = 0; node < kNodes; ++node) {
        const double amount = sum_of(lifted[node]);
        if (!(amount > 0)) {
            for (int p = 0; p < kPlanes; ++p) beyond[p] += lifted[node][p];
            continue;
        }
        double lacking = amount;
        for (const NodeContact::Share& s : nodes.of(node)) {
            Content& cell = tuft.content[s.cell];
            const double free = std::max(0.0, tuft.cell_capacity[s.cell] - sum_of(cell));
            const double v = std::min({static_cast<double>(s.part) * amount, free, lacking});
            if (!(v > 0)) continue;
            for (int p = 0; p < kPlanes; ++p) cell[p] += v / amount * lifted[node][p];
            lacking -= v;
        }
        for (int p = 0; p < kPlanes; ++p) beyond[p] += lacking / amount * lifted[node][p];
    }
    absorb(tuft, beyond, contact);
}

void distribute(NodeContents& to, int plane, double amount, const std::array<double, kNodes>& shares,
                const HatBasis& hats) {
    double all = 0;
    for (int k = 0; k < hats.count; ++k) all += shares[k];
    for (int k = 0; k < hats.count; ++k)
        to[hats.node[k]][plane] += amount * (all > 0 ? shares[k] / all : 1.0 / hats.count);
}

void MixtureGiven::pigment(int plane, double amount, const std::array<double, kNodes>& shares) {
    for (int k = 0; k < hats_.count; ++k) {
        strength_[k] += static_cast<double>(mixes_[plane][hats_.node[k]]);
        came_[k] += shares[k];
    }
    distribute(given_, plane, amount, shares, hats_);
}

void MixtureGiven::water() {
    constexpr int kWater = kMaxPigments;
    for (int k = 0; k < hats_.count; ++k)
        if (strength_[k] > 0)
            given_[hats_.node[k]][kWater] +=
                came_[k] * static_cast<double>(mixes_[kWater][hats_.node[k]]) / strength_[k];
}

}  // namespace tuft::ink
