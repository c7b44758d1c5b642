#include "variants/result.h"

#include <cstring>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "stroke/placement/placement.h"

namespace tuft::variants {
namespace {

constexpr std::array<char, 8> kMagic{'t', 'u', 'f', 't', 'c', 'o', 'v', '1'};
constexpr double kMostOff = 0.1;  // part of the samples, as for strokes on a revised model

using Sums = std::array<float, atlas::kTileTexels>;

/// Adds all films of a tile. Returns false where there are none.
bool add_films(const ink::Canvas& canvas, std::uint32_t slot, Sums& sums) {
    if (!canvas.touched(slot)) return false;
    for (int film = 0; film < ink::kFilms; ++film)
        for (int p = 0; p < static_cast<int>(canvas.pigments().size()); ++p)
            if (const ink::Plane* plane = canvas.film_plane(slot, film, p))
                for (std::size_t t = 0; t < sums.size(); ++t) sums[t] += (*plane)[t];
    return true;
}

/// Every n-th sample of all strokes together.
class Every {
  public:
    explicit Every(std::size_t total) : step_(std::max<std::size_t>(1, (total + kMostFeet - 1) / kMostFeet)) {}
    bool next() { return count_++ % step_ == 0; }

  private:
    std::size_t step_, count_ = 0;
};

std::vector<const stroke::StrokeSamples*> traces_on_model(const std::vector<stroke::JournalEntry>& entries) {
    std::vector<const stroke::StrokeSamples*> traces;
    for (const stroke::JournalEntry& e : entries)
        if (const auto* s = e.as<stroke::PaintStroke>(); s && !stroke::on_palette(e)) traces.push_back(&s->trace);
    return traces;
}

template <class T>
void put(std::vector<char>& out, const T* values, std::size_t n) {
    const std::size_t at = out.size();
    out.resize(at + n * sizeof(T));
    if (n > 0) std::memcpy(out.data() + at, values, n * sizeof(T));
}

/// Numbers one after the other, none beyond the end.
class ByteReader {
  public:
    ByteReader(const std::vector<char>& bytes, const std::string& source) : bytes_(bytes), source_(source) {}

    [[noreturn]] void fail() const { throw Error(source_, "is damaged"); }
    template <class T>
    void get(T* out, std::size_t n) {
        if (n > (bytes_.size() - at_) / sizeof(T)) fail();
        if (n > 0) std::memcpy(out, bytes_.data() + at_, n * sizeof(T));
        at_ += n * sizeof(T);
    }
    std::uint32_t count(std::size_t size) {
        std::uint32_t n = 0;
        get(&n, 1);
        if (n > (bytes_.size() - at_) / size) fail();
        return n;
    }
    bool at_end() const { return at_ == bytes_.size(); }

  private:
    const std::vector<char>& bytes_;
    const std::string& source_;
    std::size_t at_ = 0;
};

}  // namespace

Coverage coverage_of(const stroke::Document& painting, double& area) {
    const atlas::TexelMap& map = painting.model().texels;
    Coverage out;
    out.n_slots = static_cast<std::uint32_t>(map.n_slots());
    area = 0;
    const std::vector<stroke::LayerTexels> layers = painting.layers().canvases();
    for (std::uint32_t slot = 0; slot < out.n_slots; ++slot) {
        Sums sums{};
        bool any = false;
        for (const stroke::LayerTexels& layer : layers) any |= add_films(*layer.canvas, slot, sums);
        if (!any) continue;
        std::array<std::uint64_t, 4> bits{};
        for (std::size_t t = 0; t < sums.size(); ++t)
            if (sums[t] >= kPaintedFilm && map.tiles[slot].cluster[t] != atlas::kNoCluster) {
                bits[t / 64] |= std::uint64_t{1} << (t % 64);
                area += map.tiles[slot].area[t];
            }
        if (bits == std::array<std::uint64_t, 4>{}) continue;
        out.slots.push_back(slot);
        out.painted.push_back(bits);
    }
    return out;
}

std::vector<Vec3f> feet_of(const std::vector<stroke::JournalEntry>& entries, const stroke::Model& model,
                           std::vector<bool>& off) {
    const auto traces = traces_on_model(entries);
    std::size_t total = 0;
    for (const stroke::StrokeSamples* trace : traces) total += trace->samples.size();
    Every every(total);
    std::vector<Vec3f> feet;
    off.clear();
    for (const stroke::StrokeSamples* trace : traces) {
        if (trace->flat) {
            const stroke::SurfaceTrace mapped = stroke::map_to_surface(*model.query, *trace);
            for (const stroke::SurfaceSample& s : mapped.samples)
                if (every.next()) feet.emplace_back(s.position);
            off.push_back(static_cast<double>(mapped.missed) > kMostOff * static_cast<double>(mapped.samples.size()));
            continue;
        }
        off.push_back(false);
        for (const stroke::StrokeSample& s : trace->samples)
            if (every.next()) {
                const auto near = model.query->closest_point(s.position);
                feet.emplace_back(near ? near->position : s.position);
            }
    }
    return feet;
}

std::vector<char> bytes_of(const Coverage& c) {
    std::vector<char> out(kMagic.begin(), kMagic.end());
    const auto n = static_cast<std::uint32_t>(c.slots.size()), feet = static_cast<std::uint32_t>(c.feet.size());
    put(out, &c.n_slots, 1);
    put(out, &n, 1);
    put(out, c.slots.data(), c.slots.size());
    put(out, c.painted.data(), c.painted.size());
    put(out, &feet, 1);
    put(out, c.feet.data(), c.feet.size());
    return out;
}

Coverage coverage_of_bytes(const std::vector<char>& bytes, const std::string& source) {
    ByteReader in(bytes, source);
    std::array<char, 8> magic{};
    in.get(magic.data(), magic.size());
    if (magic != kMagic) in.fail();
    Coverage c;
    in.get(&c.n_slots, 1);
    c.slots.resize(in.count(sizeof(std::uint32_t) + 4 * sizeof(std::uint64_t)));
    c.painted.resize(c.slots.size());
    in.get(c.slots.data(), c.slots.size());
    in.get(c.painted.data(), c.painted.size());
    c.feet.resize(in.count(sizeof(Vec3f)));
    in.get(c.feet.data(), c.feet.size());
    for (std::size_t i = 0; i < c.slots.size(); ++i)
        if (c.slots[i] >= c.n_slots || (i > 0 && c.slots[i] <= c.slots[i - 1])) in.fail();
    for (const Vec3f& p : c.feet)
        if (!within(Vec3(p), 2 * kFarthest)) in.fail();
    if (!in.at_end() || c.feet.size() > kMostFeet) in.fail();
    return c;
}

}  // namespace tuft::variants
