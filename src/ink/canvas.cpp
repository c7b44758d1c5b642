#include "ink/canvas.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>

#include "core/error.h"
#include "core/hash.h"

namespace tuft::ink {
namespace {

constexpr std::size_t kTexels = atlas::kTileTexels;

bool all_zero(const Plane& plane) {
    return std::all_of(plane.begin(), plane.end(), [](float v) { return v == 0.0f; });
}

}  // namespace

Canvas::Canvas(std::size_t n_slots) : slots_(n_slots), dirty_(n_slots, 0) {}
Canvas::~Canvas() = default;

Canvas::Canvas(const Canvas& other)
    : pigments_(other.pigments_), slots_(other.slots_.size()), dirty_(other.dirty_) {
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        if (!other.slots_[slot]) continue;
        slots_[slot] = std::make_unique<Tile>();
        for (int p = 0; p < kMaxPigments; ++p)
            if (const auto& plane = other.slots_[slot]->planes[p])
                slots_[slot]->planes[p] = std::make_unique<Plane>(*plane);
    }
    n_planes_ = other.n_planes_.load();
    n_tiles_ = other.n_tiles_.load();
}

Canvas& Canvas::operator=(const Canvas& other) {
    if (this != &other) *this = Canvas(other);
    return *this;
}

Canvas::Canvas(Canvas&& other) noexcept {
    *this = std::move(other);
}

Canvas& Canvas::operator=(Canvas&& other) noexcept {
    pigments_ = std::move(other.pigments_);
    slots_ = std::move(other.slots_);
    dirty_ = std::move(other.dirty_);
    n_planes_ = other.n_planes_.exchange(0);
    n_tiles_ = other.n_tiles_.exchange(0);
    return *this;
}

int Canvas::add_pigment(const Pigment& pigment) {
    for (std::size_t i = 0; i < pigments_.size(); ++i)
        if (pigments_[i].name == pigment.name) return static_cast<int>(i);
    if (pigments_.size() == kMaxPigments)
        throw Error("pigment '" + pigment.name + "' is one too many: a decoration holds at most " +
                    std::to_string(kMaxPigments) + " pigments");
    pigments_.push_back(pigment);
    return static_cast<int>(pigments_.size()) - 1;
}

void Canvas::set_pigment(int index, const Pigment& pigment) {
    assert(index >= 0 && index < static_cast<int>(pigments_.size()));
    pigments_[index] = pigment;
}

const Plane* Canvas::plane(std::uint32_t slot, int pigment) const {
    const auto& tile = slots_[slot];
    return tile ? tile->planes[pigment].get() : nullptr;
}

Plane& Canvas::touch(std::uint32_t slot, int pigment) {
    assert(pigment >= 0 && pigment < kMaxPigments);
    auto& tile = slots_[slot];
    if (!tile) {
        tile = std::make_unique<Tile>();
        n_tiles_.fetch_add(1, std::memory_order_relaxed);
    }
    auto& plane = tile->planes[pigment];
    if (!plane) {
        plane = std::make_unique<Plane>();
        plane->fill(0.0f);
        n_planes_.fetch_add(1, std::memory_order_relaxed);
    }
    dirty_[slot] = 1;
    return *plane;
}

std::vector<std::uint32_t> Canvas::touched_slots() const {
    std::vector<std::uint32_t> slots;
    for (std::size_t slot = 0; slot < slots_.size(); ++slot)
        if (slots_[slot]) slots.push_back(static_cast<std::uint32_t>(slot));
    return slots;
}

std::vector<std::uint32_t> Canvas::take_dirty() {
    std::vector<std::uint32_t> slots;
    for (std::size_t slot = 0; slot < dirty_.size(); ++slot) {
        if (!dirty_[slot]) continue;
        slots.push_back(static_cast<std::uint32_t>(slot));
        dirty_[slot] = 0;
    }
    return slots;
}

TileSnapshot Canvas::snapshot(std::uint32_t slot) const {
    TileSnapshot out{.slot = slot, .planes = 0, .amounts = {}};
    if (!slots_[slot]) return out;
    for (int p = 0; p < kMaxPigments; ++p) {
        const auto& plane = slots_[slot]->planes[p];
        if (!plane) continue;
        out.planes = static_cast<std::uint8_t>(out.planes | 1u << p);
        out.amounts.insert(out.amounts.end(), plane->begin(), plane->end());
    }
    return out;
}

void Canvas::restore(const TileSnapshot& snapshot) {
    if (snapshot.slot >= slots_.size() ||
        snapshot.amounts.size() != kTexels * std::popcount(snapshot.planes) ||
        std::bit_width(snapshot.planes) > pigments_.size())
        throw Error("a saved tile does not fit this canvas");
    auto& tile = slots_[snapshot.slot];
    if (tile) {
        for (const auto& plane : tile->planes)
            if (plane) n_planes_.fetch_sub(1, std::memory_order_relaxed);
        n_tiles_.fetch_sub(1, std::memory_order_relaxed);
        tile.reset();
    }
    const float* from = snapshot.amounts.data();
    for (int p = 0; p < kMaxPigments; ++p) {
        if (!(snapshot.planes >> p & 1)) continue;
        std::copy(from, from + kTexels, touch(snapshot.slot, p).begin());
        from += kTexels;
    }
    dirty_[snapshot.slot] = 1;
}

void Canvas::clear() {
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        if (slots_[slot]) dirty_[slot] = 1;
        slots_[slot].reset();
    }
    n_planes_ = 0;
    n_tiles_ = 0;
}

std::size_t Canvas::memory_bytes() const {
    return n_planes_ * sizeof(Plane) + n_tiles_ * sizeof(Tile) +
           slots_.capacity() * sizeof(slots_[0]) + dirty_.capacity();
}

std::uint64_t Canvas::hash() const {
    std::uint64_t h = 0;
    for (const Pigment& p : pigments_) h = hash_bytes(p.name.data(), p.name.size(), h + 1);
    for (std::size_t slot = 0; slot < slots_.size(); ++slot) {
        if (!slots_[slot]) continue;
        for (int p = 0; p < kMaxPigments; ++p) {
            const auto& plane = slots_[slot]->planes[p];
            if (!plane || all_zero(*plane)) continue;
            const std::uint64_t place = slot * kMaxPigments + static_cast<std::uint64_t>(p);
            h = hash_bytes(&place, sizeof place, h);
            h = hash_bytes(plane->data(), kTexels * sizeof(float), h);
        }
    }
    return h;
}

bool Canvas::same_contents(const Canvas& other) const {
    if (slots_.size() != other.slots_.size() || pigments_.size() != other.pigments_.size())
        return false;
    for (std::size_t i = 0; i < pigments_.size(); ++i)
        if (pigments_[i].name != other.pigments_[i].name) return false;
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) {
        for (int p = 0; p < kMaxPigments; ++p) {
            const Plane* a = plane(slot, p);
            const Plane* b = other.plane(slot, p);
            if (a && b ? std::memcmp(a->data(), b->data(), kTexels * sizeof(float)) != 0
                       : (a && !all_zero(*a)) || (b && !all_zero(*b)))
                return false;
        }
    }
    return true;
}

double Canvas::total(const atlas::TexelMap& map, int pigment) const {
    assert(map.n_slots() == slots_.size());
    double sum = 0;
    for (std::uint32_t slot = 0; slot < slots_.size(); ++slot) {
        const Plane* w = plane(slot, pigment);
        if (!w) continue;
        for (std::size_t t = 0; t < kTexels; ++t)
            sum += static_cast<double>((*w)[t]) * static_cast<double>(map.tiles[slot].area[t]);
    }
    return sum;
}

}  // namespace tuft::ink
