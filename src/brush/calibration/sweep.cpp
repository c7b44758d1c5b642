#include "brush/calibration/sweep.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "brush/surface/tuft_surface.h"
#include "brush/tuft/tuft.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/system/parallel.h"
#include "core/text/units.h"

namespace tuft::brush {

namespace {

/// Where the sections meet the sheet z = 0, along x and to both sides.
struct Patch {
    double width = 0;
    double front = std::numeric_limits<double>::infinity();
    double back = -std::numeric_limits<double>::infinity();
    Vec2 right{0, std::numeric_limits<double>::infinity()};  ///< the points furthest to both sides
    Vec2 left{0, -std::numeric_limits<double>::infinity()};
    bool empty() const { return front > back; }
};

constexpr int kFineSections = 12;  ///< between two nodes: 0.1 mm along the tuft

/// How far the section reaches into the sheet; not positive where it does not touch.
double overlap(const Section& s) {
    return std::hypot(s.a * s.e.z, s.b * s.m.z) - std::abs(s.centre.z);
}

void add_section(const Section& s, Patch& patch) {
    const double ne = s.a * s.e.z, nm = s.b * s.m.z, reach = std::hypot(ne, nm), z = s.centre.z;
    if (reach <= 0 || std::abs(z) > reach) return;
    // ω = atan2(nm, ne) ± acos(-z/reach) by their cosines and sines, so that mirrored sections have mirrored ends.
    const double co = ne / reach, si = nm / reach, down = -z / reach, half = std::sqrt(std::max(0.0, 1 - down * down));
    double lo = std::numeric_limits<double>::infinity(), hi = -lo;
    for (const double sign : {-half, half}) {
        const Vec3 q = s.centre + s.a * (co * down - sign * si) * s.e + s.b * (si * down + sign * co) * s.m;
        lo = std::min(lo, q.y);
        hi = std::max(hi, q.y);
        patch.front = std::min(patch.front, q.x);
        patch.back = std::max(patch.back, q.x);
        if (q.y < patch.right.y) patch.right = Vec2(q);
        if (q.y > patch.left.y) patch.left = Vec2(q);
    }
    patch.width = std::max(patch.width, hi - lo);
}

/// Where the skin between two sections leaves the sheet, so that the patch's ends move evenly
/// with whatever moves the tuft, not from section to section.
void add_meeting(const Section& in, const Section& out, double inside, double outside, Patch& patch) {
    const double f = inside / (inside - outside);
    const auto point = [](const Section& s) {
        const double ne = s.a * s.e.z, nm = s.b * s.m.z, reach = std::hypot(ne, nm);
        const double side = s.centre.z < 0 ? 1 : -1;
        return reach > 0 ? s.centre + side * (s.a * ne / reach * s.e + s.b * nm / reach * s.m) : s.centre;
    };
    const Vec3 q = glm::mix(point(in), point(out), f);
    patch.front = std::min(patch.front, q.x);
    patch.back = std::max(patch.back, q.x);
}

/// What of a carried shape lies below the sheet: the ends of its edges where they cross it.
void add_shape(const TuftShape& shape, Patch& patch) {
    Box box;
    const auto add_edge = [&](std::uint32_t a, std::uint32_t b) {
        const double p = shape.height[a], q = shape.height[b];
        if (p > 0 && q > 0) return;
        const auto add = [&](const Vec3& at) {
            box.add(at);
            patch.front = std::min(patch.front, at.x);
            patch.back = std::max(patch.back, at.x);
            if (at.y < patch.right.y) patch.right = Vec2(at);
            if (at.y > patch.left.y) patch.left = Vec2(at);
        };
        const Vec3 &u = shape.position[a], &v = shape.position[b];
        add(p > 0 ? glm::mix(u, v, p / (p - q)) : u);
        add(q > 0 ? glm::mix(v, u, q / (q - p)) : v);
    };
    for (const auto& t : shape.carried->triangles)
        for (int k = 0; k < 3; ++k) add_edge(t[k], t[(k + 1) % 3]);
    for (const std::vector<std::uint32_t>& line : shape.carried->lines)
        for (std::size_t k = 0; k + 1 < line.size(); ++k) add_edge(line[k], line[k + 1]);
    patch.width = box.size().y;
}

Patch patch_of(const TuftState& state) {
    Patch patch;
    if (!state.shape.height.empty()) {
        add_shape(state.shape, patch);
        return patch;
    }
    for (const Branch& branch : state.branches) {
        const Recycled<Section> fine = refine_sections(branch.sections, kFineSections);
        double before = 0;
        for (std::size_t i = 0; i < fine.size(); ++i) {
            const double now = overlap(fine[i]);
            add_section(fine[i], patch);
            if (i > 0 && now > 0 && before <= 0) add_meeting(fine[i], fine[i - 1], now, before, patch);
            if (i > 0 && now <= 0 && before > 0) add_meeting(fine[i - 1], fine[i], before, now, patch);
            before = now;
        }
    }
    return patch;
}

/// The patch of a steady stroke along +x, and where the unbent tip is over the sheet.
struct Steady {
    Patch patch;
    double tip = 0;
    Recycled<Vec3> node;  ///< tip first, metres
};

Steady drag(const Preset& preset, double depth, const Vec2& lean, double roll) {
    constexpr double kStep = 0.02;  // of the length
    constexpr double kDrag = 3;     // lengths
    const int press = 20 + static_cast<int>(std::ceil(depth / (kStep * preset.length)));
    Tuft tuft = make_tuft(preset);
    const ContactPlane sheet;
    const Vec3 up = glm::normalize(Vec3{std::tan(lean.x), std::tan(lean.y), 1});
    const Vec3 tip_to_root = preset.length * up;
    Pose pose{tip_to_root, {1, 0, 0, 0}, 0};
    if (lean != Vec2{0} || roll != 0) {
        const Vec3 level = parallel_transport({1, 0, 0}, {0, 0, 1}, up);
        const Vec3 x = roll == 0 ? level : std::cos(roll) * level + std::sin(roll) * glm::cross(up, level);
        pose.rotation = glm::normalize(glm::quat_cast(Mat3(x, glm::cross(up, x), up)));
    }
    TuftState state = step(tuft, pose, {&sheet, 1}, 0);
    const int most = static_cast<int>(kDrag / kStep);
    Vec3 lag{0};
    int still = 0;
    for (int i = 1; i <= press + most && still < 5; ++i) {
        // The hand already moves while it presses, as a stroke begins.
        pose.position.x += kStep * preset.length;
        pose.position.z = tip_to_root.z - depth * std::min(1.0, static_cast<double>(i) / press);
        pose.time += 0.01;
        state = step(tuft, pose, {&sheet, 1}, 0.01);
        const Vec3 lag_t0 = lag;
        lag = tuft.trunk().memory.node.back() * preset.length - pose.position;
        still = i > press && glm::length(lag - lag_t0) < 1e-6 * preset.length ? still + 1 : 0;
    }
    return {patch_of(state), pose.position.x - tip_to_root.x, predicted_nodes(tuft, pose)};
}

}  // namespace

SteadyTuft sweep_at(const Preset& preset, double depth) {
    const auto [patch, foot, node] = drag(preset, depth, Vec2{0}, 0);
    SteadyTuft out{{depth}, {}};
    for (const Vec3& x : node) out.spine.emplace_back(x.x - foot, x.z);
    if (patch.empty()) return out;
    out.row.width = patch.width;
    out.row.drag = patch.back - patch.front;
    out.row.offset = foot - patch.back;
    return out;
}

std::vector<SweepRow> sweep_depth(const Preset& preset, std::span<const double> depths) {
    std::vector<SweepRow> rows(depths.size());
    parallel_for(depths.size(), 1, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) rows[i] = sweep_at(preset, depths[i]).row;
    });
    return rows;
}

LinePlace line_place(const Preset& preset, double depth, const Vec2& lean, double roll) {
    const auto [patch, tip, node] = drag(preset, depth, lean, roll);
    if (patch.empty()) return {};
    return {tip - 0.5 * (patch.left.x + patch.right.x), 0.5 * (patch.left.y + patch.right.y)};
}

std::string sweep_csv(std::span<const SweepRow> rows) {
    std::string text = "z_mm,width_mm,drag_mm,offset_mm\n";
    for (const SweepRow& r : rows) {
        char line[128];
        std::snprintf(line, sizeof line, "%.4g,%.4f,%.4f,%.4f\n", r.depth / kMillimetre, r.width / kMillimetre,
                      r.drag / kMillimetre, r.offset / kMillimetre);
        text += line;
    }
    return text;
}

namespace {

std::vector<std::string> cells_of(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
        if (c == ',')
            cells.emplace_back();
        else if (c != '\r' && c != ' ' && c != '\t')
            cells.back() += c;
    }
    return cells;
}

}  // namespace

std::vector<SweepRow> read_sweep(const std::string& path) {
    const std::vector<char> bytes = read_file(path, 16 << 20);
    const char* const names[] = {"z_mm", "width_mm", "drag_mm", "offset_mm"};
    double SweepRow::*const members[] = {&SweepRow::depth, &SweepRow::width, &SweepRow::drag, &SweepRow::offset};
    int column[4] = {-1, -1, -1, -1}, excluded = -1;
    bool header = true;
    std::vector<SweepRow> rows;
    long number = 0;
    for (std::size_t at = 0; at < bytes.size();) {
        std::size_t end = at;
        while (end < bytes.size() && bytes[end] != '\n') ++end;
        const std::string line(bytes.data() + at, end - at);
        at = end + 1;
        ++number;
        const std::vector<std::string> cells = cells_of(line);
        if (cells.front().empty() ? cells.size() == 1 : cells.front()[0] == '#') continue;
        if (header) {
            header = false;
            for (std::size_t i = 0; i < cells.size(); ++i) {
                for (int k = 0; k < 4; ++k) {
                    if (cells[i] == names[k]) column[k] = static_cast<int>(i);
                }
                if (cells[i] == "excluded_by_authors") excluded = static_cast<int>(i);
            }
            if (column[0] < 0 || *std::max_element(column + 1, column + 4) < 0) {
                throw Error(path, number,
                            Message("no column '{}'; needed are z_mm and one or more of width_mm,drag_mm,offset_mm",
                                    std::string(column[0] < 0 ? "z_mm" : "width_mm")));
            }
            continue;
        }
        const auto value = [&](int i) {
            char* rest = nullptr;
            const std::string text = i < static_cast<int>(cells.size()) ? cells[i] : "";
            const double v = std::strtod(text.c_str(), &rest);
            if (text.empty() || *rest != 0 || !std::isfinite(v) || v < -1e4 || v > 1e4) {
                throw Error(path, number, Message("'{}' is not a length in millimetres", text));
            }
            return v;
        };
        if (excluded >= 0 && value(excluded) != 0) continue;
        SweepRow row;
        for (int k = 0; k < 4; ++k) {
            const double absent = std::numeric_limits<double>::quiet_NaN();
            row.*members[k] = column[k] < 0 ? absent : value(column[k]) * kMillimetre;
        }
        rows.push_back(row);
    }
    if (rows.empty()) throw Error(path, "has no measured rows");
    return rows;
}

std::optional<double> stated_length(const std::string& path) {
    const std::vector<char> bytes = read_file(path, 16 << 20);
    const std::string text(bytes.begin(), bytes.end());
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t end = std::min(text.find('\n', at), text.size());
        const std::string line = text.substr(at, end - at);
        at = end + 1;
        const std::size_t word = line.find("length ");
        if (line.empty() || line[0] != '#' || word == std::string::npos) continue;
        char* rest = nullptr;
        const double v = std::strtod(line.c_str() + word + 7, &rest);
        if (std::string_view(rest).starts_with(" mm") && v > 0 && v < 1e3) return v * kMillimetre;
    }
    return std::nullopt;
}

}  // namespace tuft::brush
