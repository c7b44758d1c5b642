#include <algorithm>
#include <cmath>

#include "brush/rod/rod_energy.h"
#include "brush/rod/rod_law.h"

namespace tuft::brush::rod {

namespace {

/// Symmetric over the normal and the plane along and across the hair, which do not couple.
struct PlaneForm {
    double normal = 0, along = 0, mixed = 0, across = 0;

    void add(double f, const PlaneForm& m) {
        normal += f * m.normal;
        along += f * m.along;
        mixed += f * m.mixed;
        across += f * m.across;
    }
};

/// Potential of a point with its slopes along the patch's frame.
struct PointPotential {
    double energy = 0, normal = 0, along = 0, across = 0;
    PlaneForm second;
};

/// Friction of a point at d from its anchor, along the hair and across it; as `add_friction`.
void add_sliding(const Patch& patch, const Friction& f, const Vec2& d, PointPotential& out) {
    const Vec2 gd{patch.along2 * d.x, patch.across2 * d.y};
    const double squared = d.x * gd.x + d.y * gd.y;
    if (squared * f.stick * f.stick <= f.cap * f.cap) {
        out.energy += 0.5 * f.stick * squared;
        out.along += f.stick * gd.x;
        out.across += f.stick * gd.y;
        out.second.along += f.stick * patch.along2;
        out.second.across += f.stick * patch.across2;
    } else {
        const double q = std::sqrt(squared), pull = f.cap / q, turn = pull / squared;
        out.energy += f.cap * (q - 0.5 * f.cap / f.stick);
        out.along += pull * gd.x;
        out.across += pull * gd.y;
        out.second.along += pull * patch.along2 - turn * gd.x * gd.x;
        out.second.mixed -= turn * gd.x * gd.y;
        out.second.across += pull * patch.across2 - turn * gd.y * gd.y;
    }
    if (f.pore_cap <= 0 || d.x <= 0) return;
    if (d.x * f.stick <= f.pore_cap) {
        out.energy += 0.5 * f.stick * d.x * d.x;
        out.along += f.stick * d.x;
        out.second.along += f.stick;
    } else {
        out.energy += f.pore_cap * (d.x - 0.5 * f.pore_cap / f.stick);
        out.along += f.pore_cap;
    }
}

/// A node's place in the frame of a patch, from the clamp.
struct Place {
    double height = 0;
    Vec2 flat{0};
};

Place place_in(const Patch& patch, const Vec3& from_clamp) {
    return {glm::dot(from_clamp, patch.normal),
            {glm::dot(from_clamp, patch.along), glm::dot(from_clamp, patch.across)}};
}

/// Sums of a patch over its nodes.
struct PatchSum {
    double normal[3] = {0, 0, 0}, along[3] = {0, 0, 0}, across[3] = {0, 0, 0};
    PlaneForm own[3], coupling[2], far;

    void add(const double* w, const PointPotential& v) {
        for (int k = 0; k < 3; ++k) {
            normal[k] += w[k] * v.normal;
            along[k] += w[k] * v.along;
            across[k] += w[k] * v.across;
            own[k].add(w[k] * w[k], v.second);
        }
        coupling[0].add(w[0] * w[1], v.second);
        coupling[1].add(w[1] * w[2], v.second);
        far.add(w[0] * w[2], v.second);
    }
};

}  // namespace

void compute_patches(Frozen& frozen) {
    const Law& law = *frozen.law;
    ContactPoints& points = frozen.points;
    const int per = law.points_per_segment, n = frozen.rod->segments();
    frozen.patch.assign(static_cast<std::size_t>(n + 1), {});
    points.spot.resize(points.obstacles.size());
    for (int k = 0; k <= n && !law.normal.hard && !points.obstacles.empty(); ++k) {
        const PointRange range = points_of(k, per, n);
        if (range.begin >= range.end) continue;
        Patch& patch = frozen.patch[k];
        patch.normal = points.obstacles[range.begin].normal;
        patch.flat = true;
        double reach = -1e300;
        for (int p = range.begin; p < range.end; ++p) {
            const Obstacle& o = points.obstacles[p];
            patch.flat =
                patch.flat && o.normal == patch.normal && points.crease[p].share <= 0 && points.compliance[p] <= 0;
            if (!patch.flat) break;
            points.spot[p].height = glm::dot(o.origin - frozen.clamp.position, patch.normal);
            reach = std::max(reach, points.spot[p].height + o.radius + law.adhesion.range);
        }
        patch.reach = reach;
    }
}

void turn_patches(Frozen& frozen) {
    ContactPoints& points = frozen.points;
    const int per = frozen.law->points_per_segment, n = frozen.rod->segments();
    for (int k = 0; k <= n; ++k) {
        Patch& patch = frozen.patch[k];
        if (!patch.flat) continue;
        bool framed = false;
        const PointRange range = points_of(k, per, n);
        for (int p = range.begin; p < range.end; ++p) {
            const Friction& f = points.friction[p];
            if (f.cap <= 0 || f.stick <= 0) continue;
            if (!framed) {
                patch.along = f.grain != Vec3{0} ? f.grain : make_frame(Vec3{0}, patch.normal).t;
                patch.across = glm::cross(patch.normal, patch.along);
                patch.along2 = f.along * f.along;
                patch.across2 = f.across * f.across;
                framed = true;
            }
            const Vec3 anchor = f.anchor - frozen.clamp.position;
            points.spot[p].anchor = {glm::dot(anchor, patch.along), glm::dot(anchor, patch.across)};
        }
    }
}

double add_patch(const Frozen& frozen, int k, bool derivatives, Evaluation& out) {
    const Law& law = *frozen.law;
    const Patch& patch = frozen.patch[k];
    const ContactPoints& points = frozen.points;
    const PointRange range = points_of(k, law.points_per_segment, frozen.rod->segments());
    const int first = points.stencil[range.begin].first, count = points.stencil[range.begin].count;
    Place node[3];
    for (int i = 0; i < count; ++i) node[i] = place_in(patch, out.node[first + i] - frozen.clamp.position);
    if (count < 3) node[2] = node[1];
    if (std::min({node[0].height, node[1].height, node[2].height}) >= patch.reach) return 0;
    PatchSum sum;
    double energy = 0;
    for (int p = range.begin; p < range.end; ++p) {
        const double* w = points.stencil[p].w;
        const Obstacle& o = points.obstacles[p];
        const double height = w[0] * node[0].height + w[1] * node[1].height + w[2] * node[2].height;
        const double depth = o.radius + points.spot[p].height - height;
        if (depth <= -law.adhesion.range) continue;
        const double weight = points.weight[p];
        const NormalForce push = normal_force(law.normal, weight, o.radius, depth, 0),
                          pull = adhesion(law.adhesion, weight, -depth);
        PointPotential v;
        v.energy = push.energy + pull.energy;
        v.normal = pull.force - push.force;
        v.second.normal = push.stiffness + pull.stiffness;
        out.contact += v.energy;
        const Friction& f = points.friction[p];
        if (f.cap > 0 && f.stick > 0) {
            const Vec2 flat = w[0] * node[0].flat + w[1] * node[1].flat + w[2] * node[2].flat;
            add_sliding(patch, f, flat - points.spot[p].anchor, v);
        }
        energy += v.energy;
        if (!derivatives) continue;
        out.normal[p] = push.force;
        sum.add(w, v);
    }
    if (!derivatives) return energy;
    const Sym3 nn = outer(patch.normal), aa = outer(patch.along), cc = outer(patch.across),
               ac = 2 * symmetric(patch.along, patch.across);
    const auto in_space = [&](const PlaneForm& m) {
        return m.normal * nn + m.along * aa + m.mixed * ac + m.across * cc;
    };
    for (int i = 0; i < count; ++i) {
        out.slope[first + i] +=
            sum.normal[i] * patch.normal + sum.along[i] * patch.along + sum.across[i] * patch.across;
        out.curvature[first + i] += in_space(sum.own[i]);
        if (i + 1 < count) out.coupling[first + i] += in_space(sum.coupling[i]);
    }
    if (count > 2) out.across[first] += in_space(sum.far);
    return energy;
}

}  // namespace tuft::brush::rod
