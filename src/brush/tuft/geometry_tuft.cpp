#include "brush/tuft/geometry_tuft.h"

#include <algorithm>
#include <cmath>

#include "brush/rod/rod_points.h"
#include "brush/tuft/tuft.h"
#include "core/text/units.h"

namespace tuft::brush {

namespace {

constexpr double kLeastWidth = 1e-4;  ///< m, of the section's box
constexpr double kPoint = 1e-6;       ///< m, half-width of a section that is a point: it is not stretched

/// Places of a straight spine's sections, 0 root … 1 tip: on the curve through its nodes, as `step` makes them.
std::vector<double> places_of_sections(const Spine& spine) {
    const rod::Clamp clamp;
    const rod::Memory straight = rod::make_memory(spine.rod, clamp);
    std::vector<double> at;
    for (const Vec3& x : rod::curve_nodes(spine.rod, straight.node))
        at.push_back(glm::dot(x - clamp.position, clamp.tangent));
    for (double& v : at) v /= at.back();
    return at;
}

/// Area of the skin round each point: a third of its triangles; 1 for hair.
std::vector<double> skin_areas(const CarriedShape& shape) {
    std::vector<double> area(shape.rest.size(), shape.triangles.empty() ? 1.0 : 0.0);
    for (const auto& t : shape.triangles) {
        const Vec3 &p = shape.rest[t[0]], &q = shape.rest[t[1]], &r = shape.rest[t[2]];
        for (const std::uint32_t v : t) area[v] += glm::length(glm::cross(q - p, r - p)) / 6;
    }
    return area;
}

}  // namespace

void finish_shape(const Bundles& bundles, double length, CarriedShape& shape) {
    Box box;
    for (const Vec3& point : shape.rest) box.add(point);
    const Vec2 middle(box.centre()), half = glm::max(0.5 * Vec2(box.size()), Vec2{kLeastWidth});
    shape.lo = middle - half;
    shape.hi = middle + half;
    shape.area = skin_areas(shape);
    for (const Vec3& p : shape.rest) {
        const Vec2 place = (Vec2(p) - middle) / half;
        std::size_t best = 0;
        for (std::size_t k = 1; k < bundles.place.size(); ++k)
            if (glm::distance(place, bundles.place[k]) < glm::distance(place, bundles.place[best])) best = k;
        shape.bundle.push_back(static_cast<std::uint32_t>(best));
        shape.along.push_back(std::clamp(-p.z / length, 0.0, 1.0));
    }
}

std::shared_ptr<const CarriedShape> embed_geometry(const Tuft& tuft) {
    const Preset& p = tuft.preset;
    if (!p.geometry) return nullptr;
    auto shape = std::make_shared<CarriedShape>();
    for (const Vec3& point : p.geometry->points) shape->rest.push_back(kMillimetre * point);
    shape->triangles = p.geometry->triangles;
    shape->lines = p.geometry->lines;
    finish_shape(tuft.bundles, p.length, *shape);
    shape->at = places_of_sections(tuft.trunk());
    for (const Vec3& point : shape->rest)
        shape->place.push_back(
            lattice_place(shape->at, shape->lo, shape->hi, Vec2(point), std::clamp(-point.z / p.length, 0.0, 1.0)));
    return shape;
}

namespace {

/// The part of `v` stretched by the section: by `along_e` along e, by `along_m` along m.
Vec3 stretched(const Section& s, const Vec3& v, double along_e, double along_m) {
    return along_e * glm::dot(v, s.e) * s.e + along_m * glm::dot(v, s.m) * s.m;
}

std::vector<LatticeFrame> frames_of(const Spine& spine, std::span<const Section> sections, const Pose& pose) {
    std::vector<LatticeFrame> out;
    Vec3 tangent = pose.axis(), x = pose.rotation * Vec3{1, 0, 0}, y = pose.rotation * Vec3{0, 1, 0};
    for (std::size_t i = 0; i < sections.size(); ++i) {
        const Section& s = sections[sections.size() - 1 - i];
        x = parallel_transport(x, tangent, s.tangent);
        y = parallel_transport(y, tangent, s.tangent);
        tangent = s.tangent;
        const Vec2 rest = spine.rest.section.empty() ? Vec2{spine.rest.radius[i]} : Vec2(spine.rest.section[i]);
        // Half-widths of the resting section along e and m; its area is kept.
        const double along = std::hypot(rest.x * glm::dot(s.e, x), rest.y * glm::dot(s.e, y));
        const double across = along > 0 ? rest.x * rest.y / along : 0;
        const double along_e = along > kPoint ? s.a / along : 1, along_m = across > kPoint ? s.b / across : 1;
        out.push_back({s.centre, stretched(s, x, along_e, along_m), stretched(s, y, along_e, along_m)});
    }
    return out;
}

/// Height of a point over the surface and its normal, from the planes of the nodes around it.
struct SkinContact {
    double height = 0;
    Vec3 normal{0};

    void add(const ContactPlane& plane, const Vec3& p, double weight) {
        if (!(weight > 0)) return;
        height += weight * height_over(plane, p);
        normal += weight * plane.normal;
    }
};

}  // namespace

LatticeInput lattice_input(const Tuft& tuft, const TuftState& state) {
    const CarriedShape& shape = *tuft.carried;
    LatticeInput in{.at = shape.at, .spine_x = {}, .frames = {}, .lo = shape.lo, .hi = shape.hi};
    for (std::size_t k = 0; k < tuft.spines.size(); ++k) {
        in.spine_x.push_back(tuft.spines[k].rest.root.x);
        in.frames.push_back(frames_of(tuft.spines[k], state.branches[k].sections, tuft.pose));
    }
    return in;
}

namespace {

/// Contact of one point of the carried shape, from the planes of the nodes around its place.
SkinContact contact_of(const CarriedShape& shape, const LatticeInput& in, std::span<const ContactPlane> planes,
                       std::size_t point, const Vec3& at) {
    SkinContact contact;
    if (planes.size() == 1) {
        contact.add(planes[0], at, 1);
        return contact;
    }
    const LatticePlace& place = shape.place[point];
    const std::size_t n = shape.at.size(), spines = in.spine_x.size();
    const double over =
        spines < 2 ? 0 : std::clamp((shape.rest[point].x - in.spine_x[0]) / (in.spine_x[1] - in.spine_x[0]), 0.0, 1.0);
    for (std::size_t k = 0; k < spines; ++k) {
        const double side = spines < 2 ? 1 : k == 0 ? 1 - over : over;
        // Planes come tip first.
        const auto own = planes.subspan(k * n, n);
        contact.add(own[n - 1 - place.cell], at, side * (1 - place.stu.z));
        contact.add(own[n - 2 - place.cell], at, side * place.stu.z);
    }
    return contact;
}

}  // namespace

void place_geometry(const Tuft& tuft, std::span<const ContactPlane> planes, TuftState& state) {
    const CarriedShape& shape = *tuft.carried;
    const LatticeInput in = lattice_input(tuft, state);
    const SpineLattice lattice(in);
    const double middle = -shape.lo.y / (shape.hi.y - shape.lo.y);  // t of the spines
    TuftShape& out = state.shape;
    out.carried = tuft.carried;
    out.position.reserve(shape.rest.size());
    for (std::size_t i = 0; i < shape.rest.size(); ++i) {
        LatticePlace place = shape.place[i];
        const Vec3 p = lattice.at(place);
        out.position.push_back(p);
        if (planes.empty()) continue;
        const SkinContact contact = contact_of(shape, in, planes, i, p);
        const double size = glm::length(contact.normal);
        out.height.push_back(contact.height);
        out.normal.push_back(size > 1e-9 ? contact.normal / size : Vec3{0, 0, 1});
        if (shape.triangles.empty()) continue;
        place.stu.y = middle;
        if (tuft.spines.size() < 2) place.stu.x = -shape.lo.x / (shape.hi.x - shape.lo.x);
        out.middle.push_back(contact_of(shape, in, planes, i, lattice.at(place)).height);
    }
}

}  // namespace tuft::brush
