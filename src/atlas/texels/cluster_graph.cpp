#include "atlas/texels/cluster_graph.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "atlas/texels/log_map.h"
#include "atlas/texels/seams.h"
#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

constexpr double kSeamSpacing = 0.7;  // texels between samples of a seam
constexpr double kSeamSearch = 2.0;   // texels from a seam to the nearest texel
constexpr double kStep = 3;           // texels between the points of a path over a cluster
const double kCreaseCos = std::cos(20 * 0.017453292519943295);

Vec3f position(const TexelShape& shape, int t) {
    return {shape.px[t], shape.py[t], shape.pz[t]};
}
Vec3f normal(const TexelShape& shape, int t) {
    return {shape.nx[t], shape.ny[t], shape.nz[t]};
}

TexelCluster make_cluster(const TexelTile& tile, const TexelShape& shape, std::uint32_t slot, std::uint8_t index,
                          std::uint32_t chart) {
    TexelCluster cluster{.slot = slot, .chart = chart, .index = index};
    Vec3 mean{0};
    int n = 0, first = kTile, last = 0;
    for (int t = 0; t < kTileTexels; ++t) {
        if (tile.cluster[t] != index) continue;
        mean += Vec3(position(shape, t));
        first = std::min(first, t / kTile);
        last = std::max(last, t / kTile);
        ++n;
    }
    mean /= std::max(n, 1);
    cluster.first_row = static_cast<std::uint8_t>(std::min(first, last));
    cluster.last_row = static_cast<std::uint8_t>(last);
    double nearest = std::numeric_limits<double>::infinity();
    for (int t = 0; t < kTileTexels; ++t) {
        if (tile.cluster[t] != index) continue;
        const Vec3 d = Vec3(position(shape, t)) - mean;
        if (glm::dot(d, d) >= nearest) continue;
        nearest = glm::dot(d, d);
        cluster.centre_texel = static_cast<std::uint8_t>(t);
    }
    cluster.centre = position(shape, cluster.centre_texel);
    const Frame frame = make_frame(Vec3(cluster.centre), glm::normalize(Vec3(normal(shape, cluster.centre_texel))));
    cluster.normal = Vec3f(frame.n);
    cluster.tangent = Vec3f(frame.t);
    for (int t = 0; t < kTileTexels; ++t) {
        if (tile.cluster[t] != index) continue;
        cluster.radius = std::max(cluster.radius, glm::length(position(shape, t) - cluster.centre));
        cluster.cone_cos = std::min(cluster.cone_cos, glm::dot(normal(shape, t), cluster.normal));
    }
    return cluster;
}

/// A place where clusters i < j meet. There are hundreds of thousands.
struct Meeting {
    std::uint32_t i, j;
    double distance2;               ///< of `point` to the middle between the centres
    Vec3 point;                     ///< on the border
    std::uint8_t texel_i, texel_j;  ///< beside the point, on either side
    std::uint32_t seam = kNone;     ///< its `Sides` where a seam lies between

    auto key() const { return std::tie(i, j, distance2, point.x, point.y, point.z); }
};

/// The surface on both sides of a meeting.
struct Sides {
    Vec3 normal_i, normal_j;
    Vec3 fold{0};  ///< unit, along the edge over which the sides unfold; zero: along n_i × n_j
};

struct Meetings {
    std::vector<Meeting> found;
    std::vector<Sides> seams;
};

void put_in_order(Meeting& m) {
    if (m.i < m.j) return;
    std::swap(m.i, m.j);
    std::swap(m.texel_i, m.texel_j);
}

void set_distance(Meeting& m, const std::vector<TexelCluster>& clusters) {
    const Vec3 middle = 0.5 * (Vec3(clusters[m.i].centre) + Vec3(clusters[m.j].centre));
    const Vec3 d = m.point - middle;
    m.distance2 = glm::dot(d, d);
}

/// Returns where to store the meeting of m's pair; null unless it is nearer to the middle than any so far.
Meeting* place_of_best(std::vector<Meeting>& meetings, const Meeting& m) {
    for (Meeting& other : meetings)
        if (other.i == m.i && other.j == m.j) return m.key() < other.key() ? &other : nullptr;
    return &meetings.emplace_back(m);
}

/// Border point of two neighbour texels: their middle where the surface is smooth; at a
/// crease the point of both tangent planes that is nearest to the middle.
Vec3 border_point(const Vec3& pa, const Vec3& na, const Vec3& pb, const Vec3& nb, double reach) {
    const Vec3 middle = 0.5 * (pa + pb);
    const double c = glm::dot(na, nb);
    if (c > kCreaseCos || c < -0.99) return middle;
    // middle + x na + y nb with na·(q − pa) = 0 and nb·(q − pb) = 0.
    const double ra = glm::dot(na, pa - middle), rb = glm::dot(nb, pb - middle);
    const double det = 1 - c * c;
    const Vec3 step = ((ra - c * rb) / det) * na + ((rb - c * ra) / det) * nb;
    return glm::length(step) < reach ? middle + step : middle;
}

/// Adds the meetings of a tile's texels inside their charts.
void find_inner_meetings(const TexelMap& map, const std::vector<TexelCluster>& clusters, std::uint32_t slot,
                         std::vector<Meeting>& found) {
    static constexpr std::array<std::array<int, 2>, 4> kForward{{{1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
    const TexelTile& tile = map.tiles[slot];
    const TexelPlace first = texel_place(map, slot, 0);
    const std::uint32_t n_clusters = map.cluster_start[slot + 1] - map.cluster_start[slot];
    for (int t = 0; t < kTileTexels; ++t) {
        if (tile.cluster[t] == kNoCluster) continue;
        const int x = t % kTile, y = t / kTile;
        const bool inner = x > 0 && x < kTile - 1 && y < kTile - 1;
        if (inner && n_clusters == 1) continue;
        const std::uint32_t i = map.cluster_start[slot] + tile.cluster[t];
        for (const auto& [dx, dy] : kForward) {
            const TexelRef other = texel_ref(map, first.x + x + dx, first.y + y + dy);
            if (!other.valid()) continue;
            const std::uint32_t j = map.cluster_start[other.slot] + map.tiles[other.slot].cluster[other.texel];
            if (i == j || clusters[i].chart != clusters[j].chart) continue;
            const Vec3 pa(map.position(slot, t)), pb(map.position(other.slot, other.texel));
            const double reach = std::max(map.reach[slot], map.reach[other.slot]);
            if (glm::dot(pa - pb, pa - pb) > reach * reach) continue;
            const Vec3 na(map.normal(slot, t)), nb(map.normal(other.slot, other.texel));
            Meeting m{i, j, 0, border_point(pa, na, pb, nb, reach), static_cast<std::uint8_t>(t), other.texel};
            put_in_order(m);
            set_distance(m, clusters);
            if (Meeting* const place = place_of_best(found, m)) *place = m;
        }
    }
}

/// Texel on one side of a seam; where that side's chart is too thin to have one near by,
/// that of the surface beyond it.
TexelRef seam_texel(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map, const SeamSide& side,
                    const Vec3& position) {
    const TexelRef near = nearest_texel(map, atlas.triangle_chart[side.triangle], side.uv, position, kSeamSearch);
    return near.valid() ? near : texel_at(mesh, atlas, map, side.triangle, position);
}

Vec3 edge_direction(const mesh::TriangleMesh& mesh, const SeamEdge& edge) {
    const Vec3 along =
        mesh.position(edge.triangle_a, (edge.corner_a + 1) % 3) - mesh.position(edge.triangle_a, edge.corner_a);
    const double length = glm::length(along);
    return length > 0 ? along / length : Vec3{0};
}

/// Model and clusters between which meetings are looked for.
struct ClusteredModel {
    const mesh::TriangleMesh& mesh;
    const Atlas& atlas;
    const TexelMap& map;
    const std::vector<TexelCluster>& clusters;
};

/// Adds the meetings over one edge of a seam. `samples` is scratch memory.
void find_seam_meetings(const ClusteredModel& model, const SeamEdge& edge, std::vector<SeamSample>& samples,
                        Meetings& meetings) {
    const auto& [mesh, atlas, map, clusters] = model;
    samples.clear();
    sample_seam(mesh, atlas, edge, kSeamSpacing, samples);
    for (const SeamSample& s : samples) {
        const TexelRef a = seam_texel(mesh, atlas, map, s.a, s.position);
        const TexelRef b = seam_texel(mesh, atlas, map, s.b, s.position);
        if (!a.valid() || !b.valid()) continue;
        Meeting m{map.cluster_start[a.slot] + map.tiles[a.slot].cluster[a.texel],
                  map.cluster_start[b.slot] + map.tiles[b.slot].cluster[b.texel],
                  0,
                  s.position,
                  a.texel,
                  b.texel};
        if (m.i == m.j) continue;
        Sides sides{s.a.normal, s.b.normal, edge_direction(mesh, edge)};
        if (m.i > m.j) std::swap(sides.normal_i, sides.normal_j);
        put_in_order(m);
        set_distance(m, clusters);
        Meeting* const place = place_of_best(meetings.found, m);
        if (!place) continue;
        m.seam = place->seam;
        if (m.seam == kNone) {
            m.seam = static_cast<std::uint32_t>(meetings.seams.size());
            meetings.seams.emplace_back();
        }
        meetings.seams[m.seam] = sides;
        *place = m;
    }
}

/// End of a path from a cluster centre: position in the frame of the centre, and that frame transported
/// along.
struct ToBorder {
    Vec2 place{0};
    Frame frame;

    void step(const Vec3& p, const Vec3& n) {
        // On a faceted or noisy surface the normals lean away from the path and the projection
        // along them is too short; no step is shorter than the straight line in space.
        const Vec2 step = log_map(frame, p, n);
        const double chord = glm::length(p - frame.origin), length = glm::length(step);
        place += length > 0 && length < chord ? (chord / length) * step : step;
        const Vec3 t = parallel_transport(frame.t, frame.n, n);
        frame = {p, t, glm::cross(n, t), n};
    }
};

/// From the centre to the border in steps of a few texels straight over the atlas, so that
/// bumps between are walked over; in one where the cluster has a gap on the path.
ToBorder path_to_border(const TexelMap& map, const TexelCluster& cluster, std::uint8_t texel, const Vec3& point,
                        const Vec3& normal) {
    ToBorder path{.frame = frame_of(cluster)};
    const Frame start = path.frame;
    const Vec2 from(cluster.centre_texel % kTile, cluster.centre_texel / kTile);
    const Vec2 to(texel % kTile, texel / kTile);
    const int n = static_cast<int>(std::ceil(glm::length(to - from) / kStep));
    for (int k = 1; k < n; ++k) {
        const Vec2 at = glm::round(from + (double(k) / n) * (to - from));
        const int t = static_cast<int>(at.y) * kTile + static_cast<int>(at.x);
        const Vec3 m = Vec3(map.normal(cluster.slot, t));
        if (map.tiles[cluster.slot].cluster[t] != cluster.index || glm::dot(m, path.frame.n) < kLogMapMinCos) {
            path = {.frame = start};
            break;
        }
        path.step(Vec3(map.position(cluster.slot, t)), glm::normalize(m));
    }
    path.step(point, normal);
    return path;
}

/// Direction of j's tangent in i's frame, both at one point, when j's side is unfolded into i's about
/// `fold`.
Vec2 unfolded(const Frame& i, const Frame& j, const Vec3& fold) {
    const Vec2 a{glm::dot(fold, i.t), glm::dot(fold, i.b)}, b{glm::dot(fold, j.t), glm::dot(fold, j.b)};
    const double lengths = glm::length(a) * glm::length(b);
    if (!(lengths > 0.1)) return transport_direction(i, j.t, j.n);
    return Vec2{a.x * b.x + a.y * b.y, a.y * b.x - a.x * b.y} / lengths;
}

Sides sides_of(const TexelMap& map, const Meeting& m, const std::vector<TexelCluster>& clusters,
               const std::vector<Sides>& seams) {
    if (m.seam != kNone) return seams[m.seam];
    const Vec3 ni(map.normal(clusters[m.i].slot, m.texel_i)), nj(map.normal(clusters[m.j].slot, m.texel_j));
    if (!(glm::dot(ni, nj) > kCreaseCos)) return {ni, nj};
    const Vec3 mean = glm::normalize(ni + nj);
    return {mean, mean};
}

/// The motion i → j of a meeting: hop = log_i(q) − R log_j(q), R from carrying both tangents
/// to the border and j's over the normals on both sides of it.
ClusterEdge edge_of(const TexelMap& map, const Meeting& m, const Sides& sides,
                    const std::vector<TexelCluster>& clusters) {
    const ToBorder i = path_to_border(map, clusters[m.i], m.texel_i, m.point, sides.normal_i);
    const ToBorder j = path_to_border(map, clusters[m.j], m.texel_j, m.point, sides.normal_j);
    const Vec2 turn = unfolded(i.frame, j.frame, sides.fold);
    const Vec2 li = i.place, lj = j.place;
    return {m.j, static_cast<float>(li.x - (turn.x * lj.x - turn.y * lj.y)),
            static_cast<float>(li.y - (turn.y * lj.x + turn.x * lj.y)), static_cast<float>(turn.x),
            static_cast<float>(turn.y)};
}

ClusterEdge inverse(const ClusterEdge& e, std::uint32_t from) {
    return {from, -(e.c * e.hop_u + e.s * e.hop_v), -(e.c * e.hop_v - e.s * e.hop_u), e.c, -e.s};
}

/// Adds the parts in order, and empties them.
void append_meetings(std::vector<Meetings>& parts, Meetings& all) {
    std::size_t n = all.found.size();
    for (const Meetings& part : parts) n += part.found.size();
    all.found.reserve(n);
    for (Meetings& part : parts) {
        const auto first = static_cast<std::uint32_t>(all.seams.size());
        for (Meeting& m : part.found) {
            if (m.seam != kNone) m.seam += first;
            all.found.push_back(m);
        }
        all.seams.insert(all.seams.end(), part.seams.begin(), part.seams.end());
        part = {};
    }
}

void store_edges(const TexelMap& map, Meetings& all, ClusterGraph& graph) {
    std::vector<Meeting>& meetings = all.found;
    std::sort(meetings.begin(), meetings.end(), [](const Meeting& a, const Meeting& b) { return a.key() < b.key(); });
    const auto same = [](const Meeting& a, const Meeting& b) { return a.i == b.i && a.j == b.j; };
    meetings.erase(std::unique(meetings.begin(), meetings.end(), same), meetings.end());
    std::vector<ClusterEdge> forward(meetings.size());
    parallel_for(meetings.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t k = begin; k < end; ++k)
            forward[k] =
                edge_of(map, meetings[k], sides_of(map, meetings[k], graph.clusters, all.seams), graph.clusters);
    });
    graph.edge_start.assign(graph.n_clusters() + 1, 0);
    for (const Meeting& m : meetings) {
        ++graph.edge_start[m.i + 1];
        ++graph.edge_start[m.j + 1];
    }
    for (std::size_t i = 0; i < graph.n_clusters(); ++i) graph.edge_start[i + 1] += graph.edge_start[i];
    graph.edges.resize(graph.edge_start.back());
    std::vector<std::uint32_t> next(graph.edge_start.begin(), graph.edge_start.end() - 1);
    // Backward edges first: meetings are sorted by (i, j) with i < j, so both passes
    // leave the edges of each cluster sorted by their other end.
    for (std::size_t k = 0; k < meetings.size(); ++k)
        graph.edges[next[meetings[k].j]++] = inverse(forward[k], meetings[k].i);
    for (std::size_t k = 0; k < meetings.size(); ++k) graph.edges[next[meetings[k].i]++] = forward[k];
}

/// Tells clusters on which sides the surface ends.
void find_open_borders(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map,
                       std::vector<TexelCluster>& clusters) {
    constexpr double kSpacing = 4;  // texels: a quarter of a tile
    constexpr double kMostSamples = 1e4;
    for (std::uint32_t t = 0; t < mesh.n_triangles(); ++t) {
        for (int k = 0; k < 3; ++k) {
            if (mesh.neighbours[3 * std::size_t{t} + k] != kNone) continue;
            const Vec3 a = mesh.position(t, k), along = mesh.position(t, (k + 1) % 3) - a;
            const Vec3 normal = glm::cross(along, mesh.position(t, (k + 2) % 3) - a);
            const Vec3 out = glm::cross(along, normal);
            const double length = glm::length(along), size = glm::length(out);
            if (!(size > 0)) continue;
            const double n = std::clamp(std::ceil(length / (kSpacing * map.texel_size)), 1.0, kMostSamples);
            for (int i = 0; i < static_cast<int>(n); ++i) {
                const TexelRef ref = texel_at(mesh, atlas, map, t, a + (i + 0.5) / n * along);
                if (!ref.valid()) continue;
                TexelCluster& cluster = clusters[map.cluster_start[ref.slot] + map.tiles[ref.slot].cluster[ref.texel]];
                cluster.outward += Vec3f(length / (n * size) * out);
            }
        }
    }
}

}  // namespace

Frame frame_of(const TexelCluster& cluster) {
    Frame f;
    f.origin = Vec3(cluster.centre);
    f.n = Vec3(cluster.normal);
    f.t = Vec3(cluster.tangent);
    f.b = glm::cross(f.n, f.t);
    return f;
}

ClusterGraph build_cluster_graph(const mesh::TriangleMesh& mesh, const Atlas& atlas, const TexelMap& map,
                                 const ProgressFn& progress) {
    report(progress, "cluster graph", 0);
    ClusterGraph graph;
    graph.cluster_start = map.cluster_start;
    graph.clusters.resize(map.cluster_chart.size());
    const std::size_t n_slots = map.n_slots();
    parallel_for(n_slots, 64, [&](std::size_t begin, std::size_t end) {
        TexelShape buffer;
        for (std::uint32_t slot = static_cast<std::uint32_t>(begin); slot < end; ++slot) {
            const TexelShape& shape = shape_of(map, slot, buffer);
            for (std::uint32_t i = map.cluster_start[slot]; i < map.cluster_start[slot + 1]; ++i)
                graph.clusters[i] =
                    make_cluster(map.tiles[slot], shape, slot, static_cast<std::uint8_t>(i - map.cluster_start[slot]),
                                 map.cluster_chart[i]);
        }
    });

    constexpr std::size_t kSlots = 64;
    std::vector<Meetings> by_slots((n_slots + kSlots - 1) / kSlots);
    parallel_for(by_slots.size(), 1, [&](std::size_t begin, std::size_t end) {
        std::vector<Meeting> found;
        for (std::size_t k = begin; k < end; ++k) {
            const std::size_t last = std::min(n_slots, (k + 1) * kSlots);
            for (std::size_t slot = k * kSlots; slot < last; ++slot) {
                found.clear();
                find_inner_meetings(map, graph.clusters, static_cast<std::uint32_t>(slot), found);
                by_slots[k].found.insert(by_slots[k].found.end(), found.begin(), found.end());
            }
        }
    });
    report(progress, "cluster graph", 0.5);

    const std::vector<SeamEdge> seams = find_seams(mesh, atlas);
    constexpr std::size_t kChunk = 64;
    std::vector<Meetings> by_chunk((seams.size() + kChunk - 1) / kChunk);
    parallel_for(by_chunk.size(), 1, [&](std::size_t begin, std::size_t end) {
        std::vector<SeamSample> samples;
        for (std::size_t chunk = begin; chunk < end; ++chunk) {
            const std::size_t last = std::min(seams.size(), (chunk + 1) * kChunk);
            for (std::size_t e = chunk * kChunk; e < last; ++e)
                find_seam_meetings({mesh, atlas, map, graph.clusters}, seams[e], samples, by_chunk[chunk]);
        }
    });
    Meetings all;
    append_meetings(by_slots, all);
    append_meetings(by_chunk, all);
    store_edges(map, all, graph);
    find_open_borders(mesh, atlas, map, graph.clusters);
    report(progress, "cluster graph", 1);
    return graph;
}

}  // namespace tuft::atlas
