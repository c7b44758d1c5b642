#include "stroke/placement/model_motion.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "core/text/units.h"
#include "stroke/placement/registration.h"

namespace tuft::stroke {
namespace {

constexpr std::size_t kModelPoints = 600;  // of each model
constexpr double kCountsAs = 0.02;         // of the diagonal: farther is as far as it gets
constexpr double kSameShape = 0.002;       // of the diagonal, mean distance of models of one shape
constexpr double kBetter = 0.5;            // of the distance that a smaller motion leaves
constexpr double kSamePlace = 1e-4;        // of the diagonal, mean distance of models of which neither moved
constexpr double kSameBox = 0.02;          // of a box's side
constexpr double kSameSize = 0.002;        // of a size: not another one
constexpr double kOtherUnit = 0.1;         // logarithm of a scale: smaller ones are no other unit
constexpr double kNoTurn = 1e-5;           // radians
constexpr double kSlack = 3e-3;            // of the diagonal: nearer points always count
constexpr double kExact = 1e-6;            // of the diagonal: nothing to improve
constexpr double kHopeful = 0.01;          // of the diagonal: what a rough registration must reach
constexpr std::size_t kFewPoints = 150, kManyPoints = 4000;
constexpr int kRoughSteps = 25, kSteps = 80, kPolarSteps = 30;

struct Side {
    const mesh::SurfaceQuery& query;
    Box box;
    std::vector<OrientedPoint> points;

    explicit Side(const mesh::SurfaceQuery& q)
        : query(q), box(q.mesh().bounds), points(even_points(q.mesh(), kModelPoints)) {}
};

ModelMotion inverse(const ModelMotion& motion) {
    ModelMotion back{.from = motion.to, .to = motion.from};
    back.set_linear(glm::inverse(motion.linear()));
    return back;
}

// Mean distance of the models, metres of the revised one.
MeanDistance gap(const Side& former, const Side& revised, const ModelMotion& motion) {
    const double most = kCountsAs * revised.box.diagonal();
    const MeanDistance there = mean_distance(former.points, revised.query, motion, most),
                       back = mean_distance(revised.points, former.query, inverse(motion), most / motion.scale);
    return {0.5 * (there.fitting + motion.scale * back.fitting), 0.5 * (there.all + motion.scale * back.all)};
}

// The 24 turns that take axes to axes, the smallest first.
std::vector<Quat> axis_turns() {
    std::vector<Quat> turns;
    const double r = std::sqrt(0.5);
    for (const double w : {1.0, r, 0.5, 0.0})
        for (const double x : {-1.0, -r, -0.5, 0.0, 0.5, r, 1.0})
            for (const double y : {-1.0, -r, -0.5, 0.0, 0.5, r, 1.0})
                for (const double z : {-1.0, -r, -0.5, 0.0, 0.5, r, 1.0}) {
                    if (std::abs(w * w + x * x + y * y + z * z - 1) > 1e-9) continue;
                    const Vec3 e = Quat(w, x, y, z) * Vec3(1, 2, 4);  // of a turn of axes all parts are whole
                    if (glm::length(e - glm::round(e)) > 1e-9) continue;
                    const bool twice = std::ranges::any_of(turns, [&](const Quat& q) {
                        return std::abs(std::abs(glm::dot(q, Quat(w, x, y, z))) - 1) < 1e-9;
                    });
                    if (!twice) turns.emplace_back(w, x, y, z);
                }
    return turns;
}

// The turned box fitted onto the other one; nothing where they are of different proportions.
std::optional<ModelMotion> fitted(const Box& former, const Box& revised, const Quat& turn) {
    const Vec3 size = glm::abs(turn * former.size()), wanted = revised.size();
    double scale = glm::length(wanted) / std::max(1e-30, glm::length(size));
    if (!std::isfinite(scale) || !(scale > 0)) return std::nullopt;
    for (int k = 0; k < 3; ++k)
        if (std::abs(scale * size[k] - wanted[k]) > kSameBox * glm::length(wanted)) return std::nullopt;
    if (std::abs(scale - 1) < kSameSize) scale = 1;
    return ModelMotion{.from = former.centre(), .to = revised.centre(), .rotation = turn, .scale = scale};
}

// Mean and principal axes, the longest first, of the points; lengths in metres.
struct Spread {
    Vec3 mean{0}, axes[3];
    double size = 0;

    explicit Spread(const std::vector<OrientedPoint>& points) {
        for (const OrientedPoint& p : points) mean += p.position / static_cast<double>(points.size());
        Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
        for (const OrientedPoint& p : points) {
            const Vec3 d = p.position - mean;
            const Eigen::Vector3d e(d.x, d.y, d.z);
            sum += e * e.transpose() / static_cast<double>(points.size());
        }
        size = std::sqrt(sum.trace());
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(sum);
        for (int k = 0; k < 3; ++k) {
            const Eigen::Vector3d e = solver.eigenvectors().col(2 - k);
            axes[k] = {e[0], e[1], e[2]};
        }
    }
};

double plain_scale(double scale) {
    return std::abs(scale - 1) < kSameSize ? 1 : scale;
}

// Principal axes onto principal axes, in the four ways that are rotations, the smallest first.
std::vector<ModelMotion> axes_onto_axes(const Spread& former, const Spread& revised) {
    std::vector<ModelMotion> motions;
    if (!(former.size > 0) || !(revised.size > 0)) return motions;
    const Vec3 f = former.axes[0], g = former.axes[1], h = glm::cross(f, g);
    for (const double s : {1.0, -1.0})
        for (const double t : {1.0, -1.0}) {
            const Vec3 a = s * revised.axes[0], b = t * revised.axes[1], c = glm::cross(a, b);
            const Mat3 rotation = Mat3(a, b, c) * glm::transpose(Mat3(f, g, h));
            ModelMotion motion{.from = former.mean, .to = revised.mean, .rotation = glm::quat_cast(rotation)};
            // A hole or a new part changes the spread by a few percent; a unit by much more.
            const double scale = revised.size / former.size;
            if (std::abs(std::log(scale)) > kOtherUnit) motion.scale = scale;
            motions.push_back(motion);
        }
    std::ranges::stable_sort(motions, {}, turn_of);
    return motions;
}

// Written about the centre of the former box, whose displacement people read.
ModelMotion about(const ModelMotion& motion, const Vec3& centre) {
    ModelMotion out = motion;
    out.from = centre;
    out.to = motion(centre);
    if (turn_of(out) < kNoTurn) out.rotation = Quat(1, 0, 0, 0);
    return out;
}

/// The search of one motion: the best so far and what it leaves.
class Search {
  public:
    Search(const Side& former, const Side& revised, const ModelMotion& none)
        : former_(former), revised_(revised), size_(revised.box.diagonal()), least_(gap(former, revised, none)) {
        for (std::size_t i = 0; i < former.points.size(); i += kModelPoints / kFewPoints)
            few_.push_back(former.points[i]);
        done_ = least_.fitting < kSamePlace * size_;
    }

    const std::optional<ModelMotion>& found() const { return found_; }

    // With few points first: most candidates lead nowhere.
    void attempt(const ModelMotion& start, MotionFreedom freedom) {
        if (done_) return;
        accept(start);
        if (done_) return;
        const ModelMotion rough =
            register_points(few_, revised_.query, start, {freedom, size_, kSlack * size_, kRoughSteps});
        if (gap(former_, revised_, rough).fitting > kHopeful * size_) return;
        accept(register_points(former_.points, revised_.query, rough, {freedom, size_, kSlack * size_, kSteps}));
    }

    // With many points.
    void refine(MotionFreedom freedom) {
        if (!found_ || least_.all < kExact * size_) return;
        const std::vector<OrientedPoint> many = even_points(former_.query.mesh(), kManyPoints);
        // At first with what would slide along a smooth surface but for its border, then without what was changed.
        const ModelMotion close =
            register_points(many, revised_.query, *found_, {freedom, size_, kSlack * size_, kSteps});
        const ModelMotion fine = register_points(many, revised_.query, close, {freedom, size_, 0, kSteps});
        const double most = kCountsAs * size_;
        if (mean_distance(many, revised_.query, fine, most).fitting <
            mean_distance(many, revised_.query, *found_, most).fitting)
            found_ = fine;
    }

  private:
    void accept(const ModelMotion& motion) {
        const MeanDistance left = gap(former_, revised_, motion);
        if (left.fitting > kSameShape * size_) return;
        // Where most of a shape is mapped to itself, as by a half turn, what is left says which motion it was.
        const bool as_good = found_ && left.fitting < std::max(kSamePlace * size_, least_.fitting / kBetter);
        if (left.fitting > kBetter * least_.fitting && !(as_good && left.all < kBetter * least_.all)) return;
        least_ = left;
        found_ = motion;
        done_ = left.fitting < kSamePlace * size_ && left.all < kSamePlace * size_;
    }

    const Side &former_, &revised_;
    std::vector<OrientedPoint> few_;
    double size_;
    MeanDistance least_;
    bool done_ = false;
    std::optional<ModelMotion> found_;
};

std::optional<ModelMotion> search_whole(const Side& former, const Side& revised, MotionFreedom freedom) {
    Search search(former, revised, {});
    std::vector<ModelMotion> starts;
    for (const Quat& turn : axis_turns())
        if (const auto motion = fitted(former.box, revised.box, turn)) starts.push_back(*motion);
    starts.push_back({.from = former.box.centre(), .to = revised.box.centre()});
    for (const ModelMotion& motion : axes_onto_axes(Spread(former.points), Spread(revised.points)))
        starts.push_back(motion);
    const MotionFreedom most = std::min(freedom, MotionFreedom::similarity);
    for (const ModelMotion& start : starts) search.attempt(start, start.scale == 1 ? MotionFreedom::rigid : most);
    if (most == MotionFreedom::similarity)
        for (const ModelMotion& start : starts) search.attempt(start, most);
    if (freedom == MotionFreedom::affine) {
        if (search.found()) search.attempt(*search.found(), freedom);
        for (ModelMotion start : starts) {
            const Vec3 grown = revised.box.size() / glm::max(glm::abs(start.rotation * former.box.size()), Vec3(1e-30));
            Mat3 scales(0);
            for (int k = 0; k < 3; ++k) scales[k][k] = std::clamp(grown[k], 0.2, 5.0);
            start.set_linear(scales * glm::mat3_cast(start.rotation));
            search.attempt(start, freedom);
        }
    }
    const auto& found = search.found();
    if (!found) return found;
    const bool stretched = found->stretch != Mat3(1);
    search.refine(stretched ? MotionFreedom::affine : found->scale == 1 ? MotionFreedom::rigid : most);
    ModelMotion motion = about(*search.found(), former.box.centre());
    motion.scale = plain_scale(motion.scale);
    return motion;
}

/// Triangles by the name of their group, ascending.
std::map<std::string, std::vector<std::uint32_t>> triangles_by_name(const mesh::TriangleMesh& mesh) {
    std::vector<std::vector<std::uint32_t>> of_group(mesh.group_names.size());
    for (std::uint32_t t = 0; t < mesh.n_triangles(); ++t) of_group[mesh.triangle_groups[t]].push_back(t);
    std::map<std::string, std::vector<std::uint32_t>> of_name;
    for (std::size_t i = 0; i < of_group.size(); ++i) {
        std::vector<std::uint32_t>& all = of_name[mesh.group_names[i]];
        const auto middle = static_cast<std::ptrdiff_t>(all.size());
        all.insert(all.end(), of_group[i].begin(), of_group[i].end());
        std::inplace_merge(all.begin(), all.begin() + middle, all.end());
    }
    return of_name;
}

/// These triangles; every other array is empty.
mesh::TriangleMesh piece_of(const mesh::TriangleMesh& mesh, const std::vector<std::uint32_t>& triangles) {
    mesh::TriangleMesh part;
    for (const std::uint32_t t : triangles) {
        const auto first = static_cast<std::uint32_t>(part.positions.size());
        part.triangles.push_back({first, first + 1, first + 2});
        for (int k = 0; k < 3; ++k) {
            part.positions.push_back(mesh.positions[mesh.triangles[t][k]]);
            part.corner_normals.push_back(mesh.corner_normals[3 * t + k]);
            part.bounds.add(Vec3(part.positions.back()));
        }
    }
    part.neighbours.assign(3 * part.n_triangles(), kNone);
    return part;
}

std::optional<ModelMotion> search_part(const mesh::TriangleMesh& former_mesh, const mesh::TriangleMesh& revised_mesh,
                                       const ModelMotion& whole) {
    const mesh::SurfaceQuery former_query(former_mesh), revised_query(revised_mesh);
    const Side former(former_query), revised(revised_query);
    Search search(former, revised, whole);
    ModelMotion centred = whole;
    centred.to += revised.box.centre() - whole(former.box.centre());
    for (const ModelMotion& start : {centred, whole}) search.attempt(start, MotionFreedom::rigid);
    search.refine(MotionFreedom::rigid);
    if (!search.found()) return {};
    return about(*search.found(), former.box.centre());
}

}  // namespace

void ModelMotion::set_linear(const Mat3& linear) {
    Mat3 q = linear / std::cbrt(glm::determinant(linear));
    for (int i = 0; i < kPolarSteps; ++i) q = 0.5 * (q + glm::transpose(glm::inverse(q)));
    rotation = glm::normalize(glm::quat_cast(q));
    const Mat3 rest = glm::transpose(q) * linear;
    scale = std::cbrt(glm::determinant(rest));
    stretch = 0.5 * (rest + glm::transpose(rest)) / scale;
}

std::optional<ModelMotion> find_motion(const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised,
                                       MotionFreedom freedom) {
    return search_whole(Side(former), Side(revised), freedom);
}

ModelMotion ModelChange::of(const std::string& group) const {
    for (const PartMotion& part : parts)
        if (part.name == group) return part.motion;
    return whole.value_or(ModelMotion{});
}

ModelChange find_change(const mesh::SurfaceQuery& former, const mesh::SurfaceQuery& revised, MotionFreedom freedom) {
    ModelChange change{.whole = find_motion(former, revised, freedom)};
    const mesh::TriangleMesh &a = former.mesh(), &b = revised.mesh();
    if (a.triangle_groups.empty() || b.triangle_groups.empty()) return change;
    std::set<std::string> seen;
    auto was_by_name = triangles_by_name(a), is_by_name = triangles_by_name(b);
    for (const std::string& name : a.group_names) {
        if (name.empty() || !seen.insert(name).second || !is_by_name.contains(name)) continue;
        const mesh::TriangleMesh was = piece_of(a, was_by_name[name]), is = piece_of(b, is_by_name[name]);
        if (was.triangles.empty() || is.triangles.empty()) continue;
        if (const auto motion = search_part(was, is, change.whole.value_or(ModelMotion{})))
            change.parts.push_back({name, *motion});
    }
    return change;
}

// Of the length along any direction.
static double largest_stretch(const Mat3& stretch) {
    Eigen::Matrix3d m;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) m(i, j) = stretch[j][i];
    return (Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(m).eigenvalues().array() - 1).abs().maxCoeff();
}

Vec3 shift_of(const ModelMotion& motion) {
    return motion.to - motion.from;
}

double turn_of(const ModelMotion& motion) {
    return 2 * std::acos(std::min(1.0, std::abs(motion.rotation.w)));
}

Message describe(const ModelMotion& motion) {
    std::vector<Message> parts;
    Vec3 shift = shift_of(motion) / kMillimetre;
    // Another size about the origin moves the middle too: the size says that.
    const Vec3 by_size = (motion.scale - 1) * (motion.rotation * motion.from) / kMillimetre +
                         (motion.rotation * motion.from - motion.from) / kMillimetre;
    const bool about_origin = glm::length(shift - by_size) < 0.05;
    if (turn_of(motion) > 1e-6)
        parts.push_back(Message("turned by {} degrees", fmt::format("{:.3g}", turn_of(motion) / kDegree)));
    if (motion.scale != 1) parts.push_back(Message("{} times as large", fmt::format("{:.4g}", motion.scale)));
    if (const double most = largest_stretch(motion.stretch); most > kSameSize)
        parts.push_back(Message("stretched by up to {} %", fmt::format("{:.1f}", 100 * most)));
    for (int k = 0; k < 3; ++k)
        if (std::abs(shift[k]) < 0.05) shift[k] = 0;  // no "-0.0"
    if (parts.empty() || !about_origin)
        parts.push_back(
            Message("shifted by ({}) mm", fmt::format("{:.1f}, {:.1f}, {:.1f}", shift.x, shift.y, shift.z)));
    if (parts.size() == 1) return parts[0];
    if (parts.size() == 2) return Message("{} and {}", parts[0], parts[1]);
    if (parts.size() == 3) return Message("{}, {} and {}", parts[0], parts[1], parts[2]);
    return Message("{}, {}, {} and {}", parts[0], parts[1], parts[2], parts[3]);
}

}  // namespace tuft::stroke
