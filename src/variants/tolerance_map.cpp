#include "variants/tolerance_map.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "core/text/units.h"

namespace tuft::variants {
namespace {

constexpr double kAlways = 0.95, kEver = 0.05;  // parts of the samples

using Bits = std::array<std::uint64_t, 4>;

bool has(const Bits& bits, std::size_t t) {
    return (bits[t / 64] >> (t % 64) & 1) != 0;
}

double area_of(const atlas::TexelTile& tile, const Bits& bits) {
    double area = 0;
    for (std::size_t t = 0; t < atlas::kTileTexels; ++t)
        if (has(bits, t)) area += tile.area[t];
    return area;
}

/// Box round the texels of charts in a tile.
Box box_of(const atlas::TexelMap& map, std::uint32_t slot) {
    Box box;
    for (int t = 0; t < atlas::kTileTexels; ++t)
        if (map.tiles[slot].cluster[static_cast<std::size_t>(t)] != atlas::kNoCluster)
            box.add(Vec3(map.position(slot, t)));
    return box;
}

/// Feet of which one can be the nearest to a point of the box.
std::vector<std::uint32_t> near_box(const Box& box, const std::vector<Vec3f>& feet) {
    const Vec3f centre(box.centre());
    const auto radius = static_cast<float>(0.5 * box.diagonal());
    float least = std::numeric_limits<float>::max();
    for (const Vec3f& f : feet) least = std::min(least, glm::length(f - centre));
    std::vector<std::uint32_t> near;
    for (std::uint32_t i = 0; i < feet.size(); ++i)
        if (glm::length(feet[i] - centre) <= least + 2.001f * radius) near.push_back(i);
    return near;
}

}  // namespace

ToleranceMap::ToleranceMap(const stroke::Model& model, Coverage planned)
    : model_(model),
      planned_(std::move(planned)),
      count_(atlas::kTileTexels * model.texels.n_slots()),
      squares_(planned_.feet.size()) {
    if (planned_.n_slots != model.texels.n_slots()) throw Error("a result is of another model than this");
}

double ToleranceMap::overlap_with_plan(const Coverage& sample) const {
    double both = 0, either = 0;
    for (std::size_t i = 0, j = 0; i < planned_.slots.size() || j < sample.slots.size();) {
        const std::uint32_t a = i < planned_.slots.size() ? planned_.slots[i] : kNone;
        const std::uint32_t b = j < sample.slots.size() ? sample.slots[j] : kNone;
        const std::uint32_t slot = std::min(a, b);
        const Bits none{}, &pa = a == slot ? planned_.painted[i] : none, &pb = b == slot ? sample.painted[j] : none;
        Bits all, common;
        for (std::size_t k = 0; k < 4; ++k) all[k] = pa[k] | pb[k], common[k] = pa[k] & pb[k];
        both += area_of(model_.texels.tiles[slot], common);
        either += area_of(model_.texels.tiles[slot], all);
        i += a == slot;
        j += b == slot;
    }
    return either > 0 ? both / either : 1;
}

void ToleranceMap::add(const Coverage& sample) {
    if (sample.n_slots != planned_.n_slots || sample.feet.size() != planned_.feet.size())
        throw Error("a sample is of another model or of other strokes than the plan");
    if (n_ >= std::numeric_limits<std::uint16_t>::max()) throw Error("there are too many samples");
    ++n_;
    for (std::size_t i = 0; i < sample.slots.size(); ++i)
        for (std::size_t t = 0; t < atlas::kTileTexels; ++t)
            if (has(sample.painted[i], t)) ++count_[atlas::kTileTexels * sample.slots[i] + t];
    for (std::size_t i = 0; i < sample.feet.size(); ++i) {
        const double d = glm::length(Vec3(sample.feet[i]) - Vec3(planned_.feet[i]));
        squares_[i] += d * d;
        distances_.push_back(static_cast<float>(d));
    }
    overlap_ += overlap_with_plan(sample);
}

MoveFigures ToleranceMap::figures() const {
    MoveFigures f;
    f.samples = n_;
    for (std::size_t i = 0; i < planned_.slots.size(); ++i)
        f.planned_mm2 += 1e6 * area_of(model_.texels.tiles[planned_.slots[i]], planned_.painted[i]);
    if (n_ == 0) return f;
    const double n = static_cast<double>(n_);
    for (std::size_t i = 0; i < count_.size(); ++i) {
        const double part = count_[i] / n;
        const double area = 1e6 * model_.texels.tiles[i / atlas::kTileTexels].area[i % atlas::kTileTexels];
        if (part >= kAlways) f.always_mm2 += area;
        if (part > kEver) f.ever_mm2 += area;
    }
    f.overlap = overlap_ / n;
    if (distances_.empty()) return f;
    double sum = 0;
    for (const double s : squares_) sum += s;
    f.rms_mm = std::sqrt(sum / static_cast<double>(distances_.size())) / kMillimetre;
    std::vector<float> sorted = distances_;
    const auto at = sorted.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(sorted.size() - 1) + 0.5);
    std::nth_element(sorted.begin(), at, sorted.end());
    f.most_95_mm = *at / kMillimetre;
    f.most_mm = *std::max_element(sorted.begin(), sorted.end()) / kMillimetre;
    return f;
}

Box ToleranceMap::box() const {
    Box box;
    for (const Vec3f& foot : planned_.feet) box.add(Vec3(foot));
    return box;
}

std::vector<float> ToleranceMap::probability() const {
    std::vector<float> out(count_.size());
    const float n = static_cast<float>(std::max<std::size_t>(n_, 1));
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = static_cast<float>(count_[i]) / n;
    return out;
}

std::vector<float> ToleranceMap::displacement() const {
    std::vector<float> out(count_.size());
    if (n_ == 0 || planned_.feet.empty()) return out;
    for (std::uint32_t slot = 0; slot < planned_.n_slots; ++slot) {
        const auto first = count_.begin() + static_cast<std::ptrdiff_t>(atlas::kTileTexels) * slot;
        if (std::all_of(first, first + atlas::kTileTexels, [](std::uint16_t c) { return c == 0; })) continue;
        const std::vector<std::uint32_t> near = near_box(box_of(model_.texels, slot), planned_.feet);
        for (int t = 0; t < atlas::kTileTexels; ++t) {
            const std::size_t i = std::size_t{atlas::kTileTexels} * slot + static_cast<std::size_t>(t);
            if (count_[i] == 0) continue;
            const Vec3f p = model_.texels.position(slot, t);
            const std::uint32_t foot = *std::min_element(near.begin(), near.end(), [&](auto a, auto b) {
                return glm::length(planned_.feet[a] - p) < glm::length(planned_.feet[b] - p);
            });
            out[i] = static_cast<float>(std::sqrt(squares_[foot] / static_cast<double>(n_)));
        }
    }
    return out;
}

}  // namespace tuft::variants
