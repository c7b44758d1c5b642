#include "stroke/placement/levelling.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/hat.h"
#include "stroke/placement/smoothed_surface.h"

namespace tuft::stroke {

namespace {

constexpr double kCells = 64;       // to a radius of path, over which normals are averaged first
constexpr double kNear = 0.5;       // radians: normals further off belong to a groove's wall
constexpr double kStations = 16;    // to a radius of path, at which heights are found
constexpr double kSoft = 0.25;      // radii over which a line is fitted to them
constexpr double kSupport = 1.001;  // of them: the outermost station counts a little
constexpr double kMostCells = 2e6;  // cells, or stations, of one path

/// Means of the normals over even cells of path.
class CellNormals {
  public:
    CellNormals(std::span<const SurfaceSample> samples, std::span<const double> along, double cell)
        : cell_(cell), normals_(static_cast<std::size_t>(along.back() / cell) + 1, Vec3{0}) {
        for (std::size_t i = 0; i + 1 < samples.size(); ++i) add(samples[i], samples[i + 1], along[i], along[i + 1]);
        for (Vec3& n : normals_)
            if (const double size = glm::length(n); size > 0) n /= size;
    }

    /// Mean over [from, to], by path length, of what lies near it; nothing where they cancel.
    std::optional<Vec3> mean(double from, double to) const {
        Vec3 mean{0};
        for (int pass = 0; pass < 4; ++pass) {
            const double size = glm::length(mean);
            if (pass > 0 && !(size > 0)) return std::nullopt;
            const Vec3 axis = pass > 0 ? mean / size : mean;
            mean = Vec3{0};
            for (std::size_t k = cell_at(from); k <= cell_at(to); ++k) {
                const double begin = static_cast<double>(k) * cell_;
                double weight = std::min(to, begin + cell_) - std::max(from, begin);
                if (pass > 0) {
                    const double off = std::acos(std::clamp(glm::dot(axis, normals_[k]), -1.0, 1.0));
                    weight *= std::max(0.0, 1 - off * off / (kNear * kNear));
                }
                mean += weight * normals_[k];
            }
        }
        const double size = glm::length(mean);
        return size > 0 ? std::optional(mean / size) : std::nullopt;
    }

  private:
    std::size_t cell_at(double s) const { return std::min(static_cast<std::size_t>(s / cell_), normals_.size() - 1); }

    void add(const SurfaceSample& a, const SurfaceSample& b, double from, double to) {
        if (!(to > from)) return;
        for (std::size_t k = cell_at(from); k <= cell_at(to); ++k) {
            const double begin = std::max(from, static_cast<double>(k) * cell_);
            const double end = std::min(to, static_cast<double>(k + 1) * cell_);
            if (end <= begin) continue;
            const double middle = (0.5 * (begin + end) - from) / (to - from);
            normals_[k] += (end - begin) * glm::mix(a.normal, b.normal, middle);
        }
    }

    double cell_;
    std::vector<Vec3> normals_;
};

/// Levels at even stations of path, found as they are asked for.
class Stations {
  public:
    Stations(const mesh::SurfaceQuery& query, std::span<const SurfaceSample> samples, std::span<const double> along,
             std::span<const LevelledSurface> levelled, double radius)
        : query_(query), samples_(samples), along_(along), levelled_(levelled), radius_(radius) {
        const double n = std::clamp(std::ceil(along.back() * kStations / radius), 1.0, kMostCells);
        spacing_ = along.back() / n;
        levels_.resize(static_cast<std::size_t>(n) + 1);
    }

    /// Height over `position` along `normal` of the line through the stations near it, which lies at `s`.
    double height(const Vec3& position, const Vec3& normal, double s) {
        const double soft = kSoft * radius_;
        const auto at = [&](double x) {
            return spacing_ > 0 ? std::clamp(x / spacing_, 0.0, static_cast<double>(levels_.size() - 1)) : 0.0;
        };
        double w = 0, x = 0, xx = 0, z = 0, xz = 0;
        for (auto k = static_cast<std::size_t>(std::ceil(at(s - soft))); static_cast<double>(k) <= at(s + soft); ++k) {
            const double off = static_cast<double>(k) * spacing_ - s, weight = hat(off, kSupport * soft);
            if (weight <= 0) continue;
            const double up = glm::dot(level(k) - position, normal);
            w += weight, x += weight * off, xx += weight * off * off, z += weight * up, xz += weight * off * up;
        }
        const double det = w * xx - x * x;
        return w <= 0 ? 0 : det > 1e-9 * w * xx ? (z * xx - x * xz) / det : z / w;
    }

  private:
    const Vec3& level(std::size_t k) {
        if (!levels_[k]) {
            const double s = std::min(static_cast<double>(k) * spacing_, along_.back());
            const auto above = std::upper_bound(along_.begin(), along_.end(), s);
            const auto j = std::min<std::size_t>(static_cast<std::size_t>(above - along_.begin()), samples_.size() - 1);
            const std::size_t i = j > 0 ? j - 1 : 0;
            const double span = along_[j] - along_[i], part = span > 0 ? (s - along_[i]) / span : 1;
            const Vec3 place = glm::mix(samples_[i].position, samples_[j].position, part);
            const Vec3 mean = glm::mix(levelled_[i].normal, levelled_[j].normal, part);
            const double size = glm::length(mean);
            const Vec3 normal = size > 0 ? mean / size : levelled_[j].normal;
            levels_[k] = place + level_at(query_, place, normal, radius_) * normal;
        }
        return *levels_[k];
    }

    const mesh::SurfaceQuery& query_;
    std::span<const SurfaceSample> samples_;
    std::span<const double> along_;
    std::span<const LevelledSurface> levelled_;
    double radius_, spacing_ = 0;
    std::vector<std::optional<Vec3>> levels_;
};

}  // namespace

std::vector<LevelledSurface> level_surface(const mesh::SurfaceQuery& query, std::span<const SurfaceSample> samples,
                                           std::span<const double> along, double radius) {
    std::vector<LevelledSurface> levelled;
    levelled.reserve(samples.size());
    for (const SurfaceSample& s : samples) levelled.push_back({s.normal, 0});
    if (radius <= 0 || samples.empty()) return levelled;
    const double length = along.back();
    if (length > 0) {
        const double cell = std::max(radius / kCells, length / kMostCells);
        const CellNormals cells(samples, along, cell);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const double reach = std::min({radius, along[i], length - along[i]});
            if (!(reach > 0)) continue;
            // Within a cell of an end the sample's own normal says more than the cell's.
            const double part = std::min(1.0, reach / (2 * cell));
            if (const auto mean = cells.mean(along[i] - reach, along[i] + reach))
                if (const Vec3 n = glm::mix(levelled[i].normal, *mean, part); glm::length(n) > 1e-6)
                    levelled[i].normal = glm::normalize(n);
        }
    }
    Stations stations(query, samples, along, levelled, radius);
    for (std::size_t i = 0; i < samples.size(); ++i)
        levelled[i].height = stations.height(samples[i].position, levelled[i].normal, along[i]);
    return levelled;
}

}  // namespace tuft::stroke
