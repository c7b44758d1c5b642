#include "mesh/query/exact_geodesics.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/plane_vectors.h"

namespace tuft::mesh {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNarrowest = 1e-4;        // of an edge: vertices as flat as that throw no shadow
constexpr double kSlack = 1e-9;            // of a distance, by which rounding may lie
constexpr double kBeside = 1e-3;           // of an edge: how far beside a window a path may pass
constexpr double kFarBeside = 0.1;         // the same where no window is nearer
constexpr std::size_t kFewWindows = 2000;  // below which their number is no sign of too many
constexpr double kDense = 4;               // over the mean of the area that there may be near the origin
constexpr std::size_t kMostFaces = 64;     // round a vertex

/// a turned by the angle of b, and by its negative; |b| = 1.
Vec2 turned(const Vec2& a, const Vec2& b) {
    return {a.x * b.x - a.y * b.y, a.x * b.y + a.y * b.x};
}
Vec2 turned_back(const Vec2& a, const Vec2& b) {
    return {glm::dot(a, b), cross(b, a)};
}

int after(int k) {
    return (k + 1) % 3;
}
int before(int k) {
    return (k + 2) % 3;
}

/// Where the ray from s through (x, 0) meets the line from p along the unit vector e.
double met(const Vec2& s, double x, const Vec2& p, const Vec2& e) {
    const Vec2 d{x - s.x, -s.y};
    return cross(d, s - p) / cross(d, e);
}

double nearest_on(const Vec2& s, double from, double to) {
    return glm::length(s - Vec2{std::clamp(s.x, from, to), 0});
}

}  // namespace

void ExactGeodesics::begin(const TriangleMesh& mesh, double radius, double merge) {
    face_numbers_.clear();
    vertex_numbers_.clear();
    mesh_ = &mesh;
    radius_ = radius;
    merge_ = merge;
    faces_.clear();
    vertices_.clear();
    windows_.clear();
    arrivals_.clear();
    queue_.entries.clear();
    queue_.rings.fill(kNone);
    queue_.ring = 0;
}

void ExactGeodesics::enqueue(double distance, std::uint32_t index, bool vertex) {
    const double ring = std::min(distance / radius_ * kRings, kRings - 1.0);
    std::uint32_t& list = queue_.rings[std::max(static_cast<std::size_t>(ring), queue_.ring)];
    queue_.entries.push_back({index, vertex, list});
    list = static_cast<std::uint32_t>(queue_.entries.size() - 1);
}

std::uint32_t ExactGeodesics::vertex_of(std::uint32_t vertex) {
    const auto [number, is_new] = vertex_numbers_.number(vertex);
    if (is_new) vertices_.emplace_back();
    return number;
}

std::uint32_t ExactGeodesics::face_of(std::uint32_t triangle) {
    const auto [number, is_new] = face_numbers_.number(triangle);
    if (!is_new) return number;
    Face face;
    face.triangle = triangle;
    for (int k = 0; k < 3; ++k) {
        const Vec3 a = mesh_->position(triangle, k), b = mesh_->position(triangle, after(k));
        const Vec3 c = mesh_->position(triangle, before(k)) - a;
        face.vertex[k] = vertex_of(mesh_->triangles[triangle][k]);
        face.length[k] = glm::length(b - a);
        const Vec3 e = (b - a) / face.length[k];
        const double x = glm::dot(c, e);
        face.third[k] = {x, glm::length(c - x * e)};
    }
    face.windows.fill(kNone);
    face.nearest.fill(kInfinity);
    face.crossing.fill(0);
    faces_.push_back(face);
    return number;
}

/// The face over an edge and the corner at which the edge begins there; its face is kNone on a
/// border.
ExactGeodesics::Corner ExactGeodesics::over(std::uint32_t face, int edge) {
    const std::uint32_t t = faces_[face].triangle, n = mesh_->neighbours[3 * std::size_t{t} + edge];
    if (n >= mesh_->n_triangles()) return {kNone, 0};
    for (int k = 0; k < 3; ++k)
        if (mesh_->triangles[n][k] == mesh_->triangles[t][after(edge)] &&
            mesh_->triangles[n][after(k)] == mesh_->triangles[t][edge])
            return {face_of(n), k};
    return {kNone, 0};
}

/// Whether paths over vertices of the face are shorter to all of [from, to] of its edge.
bool ExactGeodesics::is_dominated(const Face& face, int edge, double from, double to, const Source& source) const {
    const auto far = [&](double x) { return source.before + glm::length(source.at - Vec2{x, 0}); };
    const double a = vertices_[face.vertex[edge]].distance, b = vertices_[face.vertex[after(edge)]].distance;
    if (far(to) * (1 - kSlack) > a + to || far(from) * (1 - kSlack) > b + face.length[edge] - from) return true;
    const double near = source.before + nearest_on(source.at, from, to);
    if (near > radius_) return true;
    const Vec2 c = face.third[edge];
    const double most = std::max(glm::length(c - Vec2{from, 0}), glm::length(c - Vec2{to, 0}));
    return near * (1 - kSlack) > vertices_[face.vertex[before(edge)]].distance + most;
}

/// Paths from `source` out of the face over the part [from, to] of its edge.
void ExactGeodesics::add_window(std::uint32_t face, int edge, double from, double to, const Source& source) {
    const double length = faces_[face].length[edge];
    from = std::clamp(from, 0.0, length);
    to = std::clamp(to, 0.0, length);
    if (!(to - from > kSlack * length) || !(source.at.y > 0)) return;
    if (is_dominated(faces_[face], edge, from, to, source)) return;
    const Corner to_face = over(face, edge);
    if (to_face.face == kNone) return;
    std::uint32_t& list = faces_[to_face.face].windows[to_face.corner];
    const Window window{to_face.face,  static_cast<std::uint8_t>(to_face.corner),
                        false,         length - to,
                        length - from, Vec2{length, 0} - source.at,
                        source.before, -source.turn,
                        source.root,   list};
    if (const std::uint32_t same = find_mergeable(window); same != kNone) return merge(same, window);
    list = static_cast<std::uint32_t>(windows_.size());
    windows_.push_back(window);
    enqueue(source.before + nearest_on(source.at, from, to), list, false);
}

/// Returns a window that waits on the same edge, ends where `window` begins or begins where it ends, and has the same
/// source, up to `merge_`; kNone: none.
std::uint32_t ExactGeodesics::find_mergeable(const Window& window) const {
    if (!(merge_ > 0)) return kNone;
    for (std::uint32_t i = window.next; i != kNone; i = windows_[i].next) {
        const Window& w = windows_[i];
        if (w.settled || w.root != window.root || w.before != window.before) continue;
        if (std::min(std::abs(w.to - window.from), std::abs(w.from - window.to)) > merge_) continue;
        const Vec2 off = w.source - window.source;
        if (glm::dot(off, off) <= merge_ * merge_) return i;
    }
    return kNone;
}

/// The wider window has its turn at the smaller distance of the two.
void ExactGeodesics::merge(std::uint32_t index, const Window& window) {
    Window& w = windows_[index];
    const double before = nearest_on(w.source, w.from, w.to);
    w.from = std::min(w.from, window.from);
    w.to = std::max(w.to, window.to);
    const double near = nearest_on(w.source, w.from, w.to);
    if (near < before) enqueue(w.before + near, index, false);
}

/// A path reaches a corner of a face, coming on in direction `onward` (frame of the edge that begins
/// there).
void ExactGeodesics::reach(std::uint32_t face, int corner, double distance, const Vec2& onward,
                           const Vec2& start_direction) {
    Vertex& vertex = vertices_[faces_[face].vertex[corner]];
    if (!(distance < vertex.distance * (1 - kSlack)) || distance > radius_) return;
    vertex.distance = distance;
    vertex.start_direction = start_direction;
    enqueue(distance, static_cast<std::uint32_t>(arrivals_.size()), true);
    arrivals_.push_back({face, corner, distance, onward});
}

/// From the edge that a window enters by to the two others. Of two windows that see the third
/// corner, the one that is further from it need only go on to its own side.
void ExactGeodesics::propagate(std::uint32_t index) {
    const Window w = windows_[index];
    const int edge = w.edge, right_edge = after(edge), left_edge = before(edge);
    Face& face = faces_[w.face];
    const double right_length = face.length[right_edge], left_length = face.length[left_edge];
    const Vec2 b{face.length[edge], 0}, c = face.third[edge], s = w.source;
    const double at = s.x + (c.x - s.x) * -s.y / (c.y - s.y);  // where the path to the third corner enters
    bool left = at > w.from, right = at < w.to;
    if (left && right) {
        const double distance = w.before + glm::length(c - s);
        if (distance < face.nearest[edge]) {
            face.nearest[edge] = distance;
            face.crossing[edge] = at;
        } else {
            left = at < face.crossing[edge];
            right = !left;
        }
        const Vec2 onward = glm::normalize(c - s);
        reach(w.face, left_edge, distance, turned_back(onward, -c / left_length),
              w.root == kNone ? turned(onward, w.turn) : vertices_[w.root].start_direction);
    }
    if (right) {
        const Vec2 e = (c - b) / right_length;
        const double from = met(s, w.to, b, e), to = at > w.from ? right_length : met(s, w.from, b, e);
        add_window(w.face, right_edge, from, to, {turned_back(s - b, e), w.before, turned(e, w.turn), w.root});
    }
    if (left) {
        const Vec2 e = -c / left_length;
        const double from = at < w.to ? 0 : met(s, w.to, c, e), to = met(s, w.from, c, e);
        add_window(w.face, left_edge, from, to, {turned_back(s - c, e), w.before, turned(e, w.turn), w.root});
    }
}

/// The faces round the vertex at a corner, from the one beside it on to a border or all round.
std::vector<ExactGeodesics::Corner>& ExactGeodesics::fan(std::vector<Corner>& corners, Corner at,
                                                         bool counter_clockwise) {
    corners.clear();
    const std::uint32_t first = at.face;
    while (corners.size() < kMostFaces) {
        const Corner next = over(at.face, counter_clockwise ? before(at.corner) : at.corner);
        if (next.face == kNone || next.face == first) break;
        at = {next.face, counter_clockwise ? next.corner : after(next.corner)};
        corners.push_back(at);
    }
    return corners;
}

/// Paths round a vertex through [from, to] of the edge opposite to it in one of its faces.
void ExactGeodesics::add_window_at_vertex(const Corner& at, double from, double to, double distance) {
    const int edge = after(at.corner);
    const double length = faces_[at.face].length[edge];
    if (to - from < kNarrowest * length) return;
    const std::uint32_t root = faces_[at.face].vertex[at.corner];
    add_window(at.face, edge, from, to, {faces_[at.face].third[edge], distance, Vec2{1, 0}, root});
    const Vec2 start_direction = vertices_[root].start_direction;
    // Along the face's own edges.
    const auto along = [&](int k, double far) {
        const Vec2 v = glm::normalize(k == 0 ? Vec2{0} - faces_[at.face].third[edge]
                                             : Vec2{length, 0} - faces_[at.face].third[edge]);
        const int corner = k == 0 ? edge : after(edge);
        // From the frame of the opposite edge to that of the edge that begins at the corner.
        if (corner == edge) return reach(at.face, corner, distance + far, v, start_direction);
        const Vec2 e = glm::normalize(faces_[at.face].third[edge] - Vec2{length, 0});
        reach(at.face, corner, distance + far, turned_back(v, e), start_direction);
    };
    if (!(from > 0)) along(0, faces_[at.face].length[at.corner]);
    if (!(to < length)) along(1, faces_[at.face].length[before(at.corner)]);
}

/// Paths that bend round a vertex fill what lies between the straight paths past it on either side.
void ExactGeodesics::bend(const Arrival& arrival) {
    const Face& face = faces_[arrival.face];
    const double distance = vertices_[face.vertex[arrival.corner]].distance;
    if (distance < arrival.distance * (1 - kSlack)) return;
    // In the frame that looks onward, the face behind: its sides at angles about π.
    Vec2 left = turned_back(face.third[arrival.corner],
                            arrival.onward);  // the sweep to it goes counter-clockwise
    Vec2 right = turned_back(Vec2{face.length[arrival.corner], 0}, arrival.onward);
    const Corner at{arrival.face, arrival.corner};
    fan(left_, at, true);
    // Round it all, the clockwise sweep meets the same faces from the other end.
    const bool closed = !left_.empty() && [&] {
        const Corner last = over(left_.back().face, before(left_.back().corner));
        return last.face == arrival.face;
    }();
    if (closed)
        right_.assign(left_.rbegin(), left_.rend());
    else
        fan(right_, at, false);
    // Where the straight paths past the vertex meet the edges opposite to it.
    std::size_t i = 0, j = 0;
    double from = 0, to = 0;
    for (; i < left_.size(); ++i) {
        const Face& f = faces_[left_[i].face];
        const int corner = left_[i].corner;
        const Vec2 next = turned(f.third[corner], glm::normalize(left));
        if (next.y >= 0) {
            from = f.length[after(corner)] * std::clamp(-left.y / (next.y - left.y), 0.0, 1.0);
            break;
        }
        left = next;
    }
    for (; j < right_.size(); ++j) {
        const Face& f = faces_[right_[j].face];
        const int corner = right_[j].corner;
        const Vec2 back = turned_back(glm::normalize(right), glm::normalize(f.third[corner]));
        const Vec2 next = f.length[corner] * back;
        if (next.y <= 0) {
            to = f.length[after(corner)] * std::clamp(-next.y / (right.y - next.y), 0.0, 1.0);
            break;
        }
        right = next;
    }
    const std::size_t n = left_.size();
    const auto length = [&](const Corner& c) { return faces_[c.face].length[after(c.corner)]; };
    if (closed) {
        if (i == n || j == n) return;
        const std::size_t last = n - 1 - j;  // of the counter-clockwise faces
        if (i > last || (i == last && !(from < to))) return;
        for (std::size_t k = i; k <= last; ++k)
            add_window_at_vertex(left_[k], k == i ? from : 0, k == last ? to : length(left_[k]), distance);
        return;
    }
    for (std::size_t k = i; k < n; ++k) add_window_at_vertex(left_[k], k == i ? from : 0, length(left_[k]), distance);
    for (std::size_t k = j; k < right_.size(); ++k)
        add_window_at_vertex(right_[k], 0, k == j ? to : length(right_[k]), distance);
}

bool ExactGeodesics::spread(const TriangleMesh& mesh, std::uint32_t triangle, const Vec3& origin, double radius,
                            const Limits& limits) {
    begin(mesh, radius, limits.merge);
    if (triangle >= mesh.n_triangles()) return false;
    start_ = face_of(triangle);
    const Vec3 a = mesh.position(triangle, 0), x = glm::normalize(mesh.position(triangle, 1) - a);
    const Vec3 y = glm::cross(glm::normalize(glm::cross(x, mesh.position(triangle, 2) - a)), x);
    const Vec3 d = origin - a;
    const Vec2 third = faces_[start_].third[0];
    const double base = faces_[start_].length[0];
    const double w2 = glm::dot(d, y) / third.y, w1 = (glm::dot(d, x) - w2 * third.x) / base;
    if (!std::isfinite(w1 + w2)) return false;
    // Inside, and a little off the edges, where no path would begin.
    Vec3 weights = glm::max(Vec3{1 - w1 - w2, w1, w2}, Vec3{1e-6});
    weights /= weights.x + weights.y + weights.z;
    origin_ = weights.y * Vec2{base, 0} + weights.z * third;
    Vec2 corner{0}, e{1, 0};  // of edge k in the frame of edge 0
    for (int k = 0; k < 3; ++k) {
        const Vec2 to_corner = corner - origin_;
        const double distance = glm::length(to_corner);
        if (distance > 0) reach(start_, k, distance, turned_back(to_corner / distance, e), to_corner / distance);
        const double length = faces_[start_].length[k];
        add_window(start_, k, 0, length, {turned_back(origin_ - corner, e), 0, e, kNone});
        corner += length * e;
        const Vec2 next = k == 0 ? third : Vec2{0};
        e = glm::normalize(next - corner);
    }
    while (queue_.ring < kRings) {
        if (queue_.rings[queue_.ring] == kNone) {
            ++queue_.ring;
            continue;
        }
        const QueueEntry next = queue_.entries[queue_.rings[queue_.ring]];
        queue_.rings[queue_.ring] = next.next;
        if (next.vertex) {
            bend(Arrival(arrivals_[next.index]));
            continue;
        }
        Window& w = windows_[next.index];
        if (w.settled) continue;  // by an earlier entry: it was merged
        w.settled = true;
        // By what has been learnt of the vertices since.
        if (!is_dominated(faces_[w.face], w.edge, w.from, w.to, {w.source, w.before, w.turn, w.root}))
            propagate(next.index);
        // Their number grows with the area.
        const double share = static_cast<double>(queue_.ring + 1) / kRings,
                     expected = static_cast<double>(limits.windows) * share * share;
        const auto n = static_cast<double>(windows_.size());
        if (windows_.size() > limits.windows || (windows_.size() > kFewWindows && n > kDense * expected)) return false;
    }
    return true;
}

const ExactGeodesics::Window* ExactGeodesics::shortest_window(const Face& face, const Vec2& q,
                                                              const std::array<Vec2, 3>& corners,
                                                              const std::array<Vec2, 3>& edges, double& length) const {
    double beside = kFarBeside, length_beside = kInfinity;
    const Window* best = nullptr;
    const Window* fallback = nullptr;
    for (int k = 0; k < 3; ++k) {
        const Vec2 at = turned_back(q - corners[k], edges[k]);
        for (std::uint32_t i = face.windows[k]; i != kNone; i = windows_[i].next) {
            const Window& w = windows_[i];
            const double height = std::max(at.y, 0.0);
            const double cut = w.source.x + (at.x - w.source.x) * -w.source.y / (height - w.source.y);
            const double off = std::max({w.from - cut, cut - w.to, 0.0}) / face.length[k];
            const double by_window = w.before + glm::length(at - w.source);
            if (off <= kBeside && by_window < length) {
                length = by_window;
                best = &w;
            } else if (off > kBeside && off < beside) {
                beside = off;
                length_beside = by_window;
                fallback = &w;
            }
        }
    }
    if (!best && fallback && length_beside < length) {
        best = fallback;
        length = length_beside;
    }
    return best;
}

ExactGeodesics::Geodesic ExactGeodesics::to(std::uint32_t triangle, const Vec3& p) const {
    Geodesic path;
    const std::uint32_t number = face_numbers_.find(triangle);
    if (number == kNone) return path;
    const Face& face = faces_[number];
    const Vec3 a = mesh_->position(triangle, 0), x = glm::normalize(mesh_->position(triangle, 1) - a);
    const Vec3 n = glm::normalize(glm::cross(x, mesh_->position(triangle, 2) - a)), y = glm::cross(n, x);
    const Vec2 q{glm::dot(p - a, x), glm::dot(p - a, y)};
    Vec2 start_direction{0}, end_direction{0};  // frames of edge 0 of the first and of this face
    if (number == start_) {
        path.length = glm::length(q - origin_);
        start_direction = end_direction = path.length > 0 ? (q - origin_) / path.length : Vec2{1, 0};
    }
    std::array<Vec2, 3> corners, edges;
    Vec2 corner{0}, e{1, 0};
    for (int k = 0; k < 3; ++k) {
        corners[k] = corner;
        edges[k] = e;
        corner += face.length[k] * e;
        e = glm::normalize((k == 0 ? face.third[0] : Vec2{0}) - corner);
    }
    if (const Window* best = shortest_window(face, q, corners, edges, path.length)) {
        const Vec2 from = corners[best->edge] + turned(best->source, edges[best->edge]);
        end_direction = glm::normalize(q - from);
        path.bent = best->root != kNone;
        start_direction = path.bent ? vertices_[best->root].start_direction
                                    : turned(turned_back(end_direction, edges[best->edge]), best->turn);
    }
    for (int k = 0; k < 3; ++k) {
        const Vertex& v = vertices_[face.vertex[k]];
        const Vec2 d = q - corners[k];
        const double length = v.distance + glm::length(d);
        if (!(length < path.length * (1 - kSlack))) continue;
        path.length = length;
        path.bent = true;
        start_direction = v.start_direction;
        end_direction = glm::length(d) > 0 ? glm::normalize(d) : start_direction;
    }
    if (!(path.length <= radius_)) return {};
    path.end_direction = end_direction.x * x + end_direction.y * y;
    const std::uint32_t t = faces_[start_].triangle;
    const Vec3 o = mesh_->position(t, 0), ox = glm::normalize(mesh_->position(t, 1) - o);
    const Vec3 oy = glm::cross(glm::normalize(glm::cross(ox, mesh_->position(t, 2) - o)), ox);
    path.start_direction = start_direction.x * ox + start_direction.y * oy;
    return path;
}

}  // namespace tuft::mesh
