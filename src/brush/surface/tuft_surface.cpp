#include "brush/surface/tuft_surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/cubic.h"

namespace tuft::brush {

namespace {

/// Slopes at the nodes of a curve with values v at the places s, each by `law` from the chords on both sides; an end
/// has that of its chord.
template <class T, class Law>
std::vector<T> slopes(const std::vector<T>& v, const std::vector<double>& s, const Law& law) {
    const std::size_t n = v.size();
    const auto step = [&](std::size_t i) { return s[i + 1] - s[i]; };
    const auto chord = [&](std::size_t i) { return (v[i + 1] - v[i]) / step(i); };
    std::vector<T> m(n);
    m.front() = chord(0);
    m.back() = chord(n - 2);
    for (std::size_t i = 1; i + 1 < n; ++i) m[i] = law(chord(i - 1), chord(i), step(i - 1), step(i));
    return m;
}

std::vector<double> monotone_slopes(const std::vector<double>& v, const std::vector<double>& s) {
    return slopes(v, s, monotone_slope);
}

}  // namespace

Recycled<Section> refine_sections(std::span<const Section> in, int between) {
    if (in.size() < 2 || between <= 0) return {in.begin(), in.end()};
    const std::size_t n = in.size();
    std::vector<double> s(n, 0), a(n), b(n), moment(n), pressure(n);
    std::vector<Vec3> centre(n), e(n);
    for (std::size_t i = 0; i < n; ++i) {
        if (i > 0) s[i] = s[i - 1] + std::max(1e-12, glm::length(in[i].centre - in[i - 1].centre));
        centre[i] = in[i].centre;
        e[i] = in[i].e;
        a[i] = in[i].a;
        b[i] = in[i].b;
        moment[i] = in[i].moment;
        pressure[i] = in[i].pressure;
    }
    const std::vector<Vec3> mc = slopes(centre, s, parabola_slope<Vec3>);
    const std::vector<double> ma = monotone_slopes(a, s), mb = monotone_slopes(b, s), mm = monotone_slopes(moment, s),
                              mp = monotone_slopes(pressure, s);
    Recycled<Section> out;
    out.reserve(n + (n - 1) * between);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        out.push_back(in[i]);
        const double h = s[i + 1] - s[i];
        for (int k = 1; k <= between; ++k) {
            const double t = static_cast<double>(k) / (between + 1);
            Section c;
            c.centre = hermite(centre[i], centre[i + 1], mc[i], mc[i + 1], h, t);
            c.tangent = glm::normalize((1 - t) * in[i].tangent + t * in[i + 1].tangent);
            c.e = (1 - t) * e[i] + t * e[i + 1];
            c.e = glm::normalize(c.e - glm::dot(c.e, c.tangent) * c.tangent);
            c.m = glm::cross(c.e, c.tangent);
            c.turn = in[t < 0.5 ? i : i + 1].turn;
            c.a = hermite(a[i], a[i + 1], ma[i], ma[i + 1], h, t);
            c.b = hermite(b[i], b[i + 1], mb[i], mb[i + 1], h, t);
            c.moment = hermite(moment[i], moment[i + 1], mm[i], mm[i + 1], h, t);
            c.pressure = hermite(pressure[i], pressure[i + 1], mp[i], mp[i + 1], h, t);
            out.push_back(c);
        }
    }
    out.push_back(in.back());
    return out;
}

namespace {

void add_branch(std::span<const Section> sections, const TuftSurfaceOptions& options, TuftSurface& surface) {
    const Recycled<Section> rings = refine_sections(sections, options.rings_between_nodes);
    if (rings.size() < 2) return;
    const auto p = static_cast<std::uint32_t>(options.points_per_ring);
    const auto first = static_cast<std::uint32_t>(surface.positions.size());
    for (std::size_t k = rings.size(); k-- > 1;) {  // root first; the tip closes with a point
        const Section& c = rings[k];
        for (std::uint32_t i = 0; i < p; ++i) {
            const double w = 2 * std::numbers::pi * i / p;
            surface.positions.push_back(c.centre + c.a * std::cos(w) * c.e + c.b * std::sin(w) * c.m);
            const Vec3 across = c.b * std::cos(w) * c.e + c.a * std::sin(w) * c.m;
            const double size = glm::length(across);
            surface.normals.push_back(size > 0 ? across / size : c.e);
        }
        ++surface.rings;
    }
    const auto ring_count = static_cast<std::uint32_t>(rings.size() - 1);
    const auto tip = static_cast<std::uint32_t>(surface.positions.size());
    surface.positions.push_back(rings.front().centre);
    surface.normals.push_back(rings.front().tangent);
    const auto add = [&](std::uint32_t i, std::uint32_t j, std::uint32_t k) {
        surface.triangles.insert(surface.triangles.end(), {i, j, k});
    };
    // Seen along the spine towards the tip, (e, m) turn counter-clockwise when e × m = -t.
    for (std::uint32_t ring = 0; ring + 1 < ring_count; ++ring) {
        for (std::uint32_t i = 0; i < p; ++i) {
            const std::uint32_t a0 = first + ring * p + i, a1 = first + ring * p + (i + 1) % p;
            const std::uint32_t b0 = a0 + p, b1 = a1 + p;
            add(a0, b0, a1);
            add(a1, b0, b1);
        }
    }
    const std::uint32_t last = first + (ring_count - 1) * p;
    for (std::uint32_t i = 0; i < p; ++i) add(last + i, tip, last + (i + 1) % p);
}

/// Unit vector across the hair of a section and across the direction to its neighbour.
Vec3 beside_row(const Vec3& direction, const Section& s) {
    const Vec3 out = glm::cross(direction, s.tangent);
    const double size = glm::length(out);
    return size > 1e-12 ? out / size : s.m;
}

/// Closes what lies between two joined spines of a ferrule: above and below, from section to section, tip first.
void add_joint(const TuftState& state, const Opening& opening, const TuftSurfaceOptions& options,
               TuftSurface& surface) {
    const Branch &first = state.branches[opening.first], &second = state.branches[opening.second];
    // Sections of equal number from the root face each other.
    const std::size_t count = std::min(first.sections.size(), second.sections.size());
    const auto tail = [&](const Branch& b) {
        const Recycled<Section> own(b.sections.end() - static_cast<long>(count), b.sections.end());
        return refine_sections(own, options.rings_between_nodes);
    };
    const Recycled<Section> a = tail(first), b = tail(second);
    const std::size_t off = first.sections.size() - count, per = 1 + options.rings_between_nodes;
    for (const double side : {1.0, -1.0}) {
        const auto start = static_cast<std::uint32_t>(surface.positions.size());
        for (std::size_t i = 0; i < a.size(); ++i) {
            for (const Section* s : {&a[i], &b[i]}) {
                const Vec3 out = state.strips ? (glm::dot(s->m, a[i].m) < 0 ? -1.0 : 1.0) * s->m
                                              : beside_row(b[i].centre - a[i].centre, *s);
                const double reach =
                    state.strips ? s->b : std::hypot(s->a * glm::dot(out, s->e), s->b * glm::dot(out, s->m));
                surface.positions.push_back(s->centre + side * reach * out);
                surface.normals.push_back(side * out);
            }
        }
        for (std::uint32_t i = 0; i + 1 < a.size(); ++i) {
            if (!(opening.width[off + i / per] <= 0)) continue;
            const std::uint32_t p = start + 2 * i;
            const Vec3 out = glm::cross(surface.positions[p + 1] - surface.positions[p],
                                        surface.positions[p + 2] - surface.positions[p]);
            if (glm::dot(out, surface.normals[p]) > 0)
                surface.triangles.insert(surface.triangles.end(), {p, p + 1, p + 2, p + 1, p + 3, p + 2});
            else
                surface.triangles.insert(surface.triangles.end(), {p, p + 2, p + 1, p + 1, p + 2, p + 3});
        }
    }
}

}  // namespace

namespace {

/// A mesh as it is, with smooth normals.
void add_mesh(const TuftShape& shape, TuftSurface& surface) {
    surface.positions.assign(shape.position.begin(), shape.position.end());
    surface.normals.assign(shape.position.size(), Vec3{0});
    for (const auto& t : shape.carried->triangles) {
        surface.triangles.insert(surface.triangles.end(), t.begin(), t.end());
        const Vec3& p = shape.position[t[0]];
        const Vec3 area = glm::cross(shape.position[t[1]] - p, shape.position[t[2]] - p);
        for (const std::uint32_t v : t) surface.normals[v] += area;
    }
    for (Vec3& n : surface.normals) n = glm::length(n) > 0 ? glm::normalize(n) : Vec3{0, 0, 1};
}

/// Hairs as tubes of three sides.
void add_lines(const TuftShape& shape, TuftSurface& surface) {
    constexpr double kHalf = 1e-4;  // m
    for (const std::vector<std::uint32_t>& line : shape.carried->lines)
        for (std::size_t k = 0; k < line.size(); ++k) {
            const Vec3& at = shape.position[line[k]];
            const Vec3 run =
                shape.position[line[std::min(k + 1, line.size() - 1)]] - shape.position[line[k > 0 ? k - 1 : 0]];
            const Frame across = make_frame(at, glm::length(run) > 1e-12 ? glm::normalize(run) : Vec3{0, 0, -1});
            const auto first = static_cast<std::uint32_t>(surface.positions.size());
            for (std::uint32_t i = 0; i < 3; ++i) {
                const double w = 2 * std::numbers::pi * i / 3;
                const Vec3 out = std::cos(w) * across.t + std::sin(w) * across.b;
                surface.positions.push_back(at + kHalf * out);
                surface.normals.push_back(out);
                if (k == 0) continue;
                const std::uint32_t a = first + i, b = first + (i + 1) % 3;
                surface.triangles.insert(surface.triangles.end(), {a - 3, b - 3, b, a - 3, b, a});
            }
        }
}

}  // namespace

TuftSurface make_tuft_surface(const TuftState& state, const TuftSurfaceOptions& options) {
    TuftSurface surface;
    surface.points_per_ring = std::max(3, options.points_per_ring);
    if (state.shape.carried) {
        add_mesh(state.shape, surface);
        if (!state.shape.carried->lines.empty()) {
            surface.positions.clear();
            surface.normals.clear();
            add_lines(state.shape, surface);
        }
        return surface;
    }
    TuftSurfaceOptions used = options;
    used.points_per_ring = surface.points_per_ring;
    for (const Branch& branch : state.branches) add_branch(branch.sections, used, surface);
    for (const Opening& opening : state.openings) add_joint(state, opening, used, surface);
    return surface;
}

}  // namespace tuft::brush
