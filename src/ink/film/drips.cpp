#include "ink/film/drips.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace tuft::ink::wet {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kCapillaryLength = 2.7e-3;  // metres: √(σ / ρ g) of water
constexpr double kLeastSteepness = 0.1;      // sin α: beads on flatter places would be puddles
constexpr int kShifts = 6;                   // to the middle of the liquid, and from the critical radius to its own
constexpr int kTilts = 3;
constexpr double kCatchment = 2;  // radii from which a bead draws liquid in
constexpr double kStart = 1.3;    // volumes that run on: with less a bead does not come off a film
constexpr double kRing = 1.5;     // radii: about a bead lies the film that it stands on
constexpr double kRim = 1.1;      // a bead's own radius, and what it may have spread meanwhile
constexpr double kBead = 1.5;     // of `retained`: a film as thick as that is likely a bead
constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kSeparation = 2.2;  // critical radii between beads that move in the same step
constexpr double kLeastGrain = 0.8, kGrainPart = 0.5;
constexpr double kHopeful = 0.3;    // of what runs: less about a place will not come together
constexpr double kFastest = 1.5;    // bead_speed
constexpr double kAtRest = 1.01;    // of the critical radius
constexpr double kStops = 1.06;     // of the radius that a moving one needs: it comes to rest
constexpr double kMoving = 0.65;    // of what holds a bead at rest: so much holds one that runs
constexpr double kRestAngle = 0.5;  // of bead_angle: a bead's that came to rest
constexpr double kSummit = 0.3;     // radii: about the highest of a cap
constexpr double kFull = 0.8;       // of the height of a cap of its volume: one that runs is as high
constexpr double kTrack = 0.3;      // radii: of the trail next to the bead that left it, along and to each side
constexpr double kThinnest = 0.5;   // of the trail: what stays behind the slowest bead
constexpr double kTail = 5;         // radii that a bead at rest is drawn out upwards

double critical_radius(double angle, double steepness) {
    return 2 * kCapillaryLength * std::sqrt(angle / (kPi * std::max(steepness, kLeastSteepness)));
}
/// Film units · m² of a bead.
double amount_of(double radius, double angle) {
    return 0.25 * kPi * angle * radius * radius * radius / kFilmUnit;
}
/// Newton's method on the above, from a radius near by; rounds the same on every machine.
double radius_of(double amount, double angle) {
    const double cube = amount * kFilmUnit * 4 / (kPi * angle);
    double r = critical_radius(angle, 1);
    for (int i = 0; i < 40; ++i) r = (2 * r + cube / (r * r)) / 3;
    return r;
}

}  // namespace

Drips::Drips(const atlas::TexelMap& map, const atlas::SeamLinks& seams, const WetFilm::FreeFn& free)
    : map_(map), seams_(seams), free_(free), seen_of_slot_(map.n_slots(), kNone) {}

double Drips::least(const FilmParams& p) {
    // A bead on a dry wall, or what is above `retained` of a film, over the bead's disc and the ring round it.
    const double r = critical_radius(p.weight.bead_angle, 1), ring = kCatchment * kCatchment - 1;
    const double mean = std::pow(kLeastGrain, 1.5) * amount_of(r, p.weight.bead_angle) / (kPi * r * r);
    return std::min(p.retained + kStart * mean / (1 + ring), mean + p.weight.trail);
}

/// The texels within `radius` of `centre` that hang together with `start`.
void Drips::collect_disc(const atlas::TexelRef& start, const Vec3& centre, double radius) {
    disc_.clear();
    std::uint32_t last_slot = kNone, last_seen = 0;
    const auto bits_of = [&](std::uint32_t slot) -> std::array<std::uint64_t, atlas::kTileTexels / 64>& {
        if (slot != last_slot) {
            std::uint32_t& seen = seen_of_slot_[slot];
            if (seen == kNone) {
                seen = static_cast<std::uint32_t>(seen_slots_.size());
                seen_slots_.push_back(slot);
                if (seen_.size() < seen_slots_.size()) seen_.emplace_back();
                seen_[seen].fill(0);
            }
            last_slot = slot;
            last_seen = seen;
        }
        return seen_[last_seen];
    };
    const auto visit = [&](const atlas::TexelRef& ref, const Vec3* from, double reach) {
        std::uint64_t& bits = bits_of(ref.slot)[ref.texel / 64];
        const std::uint64_t bit = std::uint64_t{1} << (ref.texel % 64);
        if (bits & bit) return;
        const Vec3 at(map_.position(ref.slot, ref.texel));
        const double distance = glm::distance(at, centre);
        if (from && distance > radius) return;
        if (from && reach > 0 && glm::distance(at, *from) > reach) return;
        bits |= bit;
        disc_.push_back({ref, at, static_cast<double>(map_.tiles[ref.slot].area[ref.texel]), distance});
    };
    visit(start, nullptr, 0);
    for (std::size_t i = 0; i < disc_.size(); ++i) {
        const Near here = disc_[i];
        const int column = here.ref.texel % atlas::kTile, row = here.ref.texel / atlas::kTile;
        for (const auto& [dx, dy] : {std::pair{-1, 0}, {1, 0}, {0, -1}, {0, 1}})
            if (const atlas::TexelRef next = beside(here.ref, column + dx, row + dy);
                next.valid() && !is_separate(here.ref, next))
                visit(next, &here.at, static_cast<double>(std::max(map_.reach[here.ref.slot], map_.reach[next.slot])));
        const auto links =
            std::span(seams_.links)
                .subspan(seams_.start[here.ref.slot], seams_.start[here.ref.slot + 1] - seams_.start[here.ref.slot]);
        if (links.empty()) continue;
        const auto first = std::lower_bound(links.begin(), links.end(), here.ref.texel,
                                            [](const atlas::SeamLink& l, std::uint8_t t) { return l.texel < t; });
        for (auto l = first; l != links.end() && l->texel == here.ref.texel; ++l)
            if (const atlas::TexelRef next{l->other_slot, l->other_texel}; !is_separate(here.ref, next))
                visit(next, &here.at, 0);
    }
    for (const std::uint32_t slot : seen_slots_) seen_of_slot_[slot] = kNone;
    seen_slots_.clear();
}

/// By the edge of a stencil edge.
bool Drips::is_separate(const atlas::TexelRef& a, const atlas::TexelRef& b) const {
    return free_ && (free_(a.slot, a.texel) == 0) != (free_(b.slot, b.texel) == 0);
}

/// The texel in this column and row of a tile, or of one of those round it.
atlas::TexelRef Drips::beside(const atlas::TexelRef& ref, int column, int row) const {
    constexpr int n = atlas::kTile;
    if (column >= 0 && column < n && row >= 0 && row < n) {
        const auto texel = static_cast<std::uint8_t>(row * n + column);
        return map_.tiles[ref.slot].cluster[texel] == atlas::kNoCluster ? atlas::TexelRef{}
                                                                        : atlas::TexelRef{ref.slot, texel};
    }
    const atlas::TexelPlace first = atlas::texel_place(map_, ref.slot, 0);
    return atlas::texel_ref(map_, first.x + column, first.y + row);
}

struct Drips::Bead {
    atlas::TexelRef place;  ///< the texel next to its middle
    Vec3 at{0};
    double amount = 0;  ///< film units · m²
    std::array<double, kMaxPigments> pigment{};
};

class Drips::Run {
  public:
    Run(Drips& drips, Canvas& canvas, const FilmParams& params, const BeforeFn& before)
        : d_(drips),
          canvas_(canvas),
          p_(params),
          before_(before),
          n_pigments_(static_cast<int>(canvas.pigments().size())) {}

    std::vector<std::uint32_t> written;

    void run(const Seed& seed, double seconds) {
        const double start_radius = critical_radius(p_.weight.bead_angle, steepness(seed.place));
        Bead bead{.place = seed.place, .at = Vec3(d_.map_.position(seed.place.slot, seed.place.texel))};
        if (steepness(seed.place) < kLeastSteepness) return;
        const double enough = amount_of(start_radius, p_.weight.bead_angle);
        for (const Seen& other : seen_)
            if (glm::distance(other.at, bead.at) < other.radius) return;
        double reach = start_radius;
        for (int i = 0; i < kShifts; ++i) {
            if (!centre(bead, reach) || bead.amount < kHopeful * enough) return;
            reach = std::max(start_radius, kRim * radius_of(bead.amount, p_.weight.bead_angle));
        }
        for (const Seen& other : seen_)
            if (glm::distance(other.at, bead.at) < kSeparation * start_radius) return;
        const double grain = 1 + kGrainPart * (seed.grain - 1), radius = critical(bead, grain);
        const double starts = kStart * amount_of(kAtRest * radius, p_.weight.bead_angle);
        d_.collect_disc(bead.place, bead.at, kCatchment * reach);
        const WetBase base = fit_base(bead, reach);
        const auto [inside, round] = amounts(bead, base, reach);
        const double least = is_running(bead, base, inside) ? std::sqrt(kMoving) : kAtRest,
                     runs = amount_of(least * radius, p_.weight.bead_angle);
        if (inside < runs && inside + round < starts) return;
        seen_.push_back({bead.at, reach});
        bead.amount = 0;
        if (inside < runs)
            draw_in(bead, base, reach, std::clamp((starts - inside) / round, 0.0, 1.0), kAny);
        else
            draw_in(bead, base, reach, std::min(p_.weight.drain * seconds, 1.0),
                    kBead * p_.retained);  // leaves other beads whole
        deposit_bead(bead, move(bead, grain, seconds));
        seen_.push_back({bead.at, radius_of(bead.amount, p_.weight.bead_angle)});
    }

  private:
    Vec3 downhill(const atlas::TexelRef& place) const {
        const Vec3 n(d_.map_.normal(place.slot, place.texel));
        return p_.weight.down - n * glm::dot(n, p_.weight.down);
    }
    double steepness(const atlas::TexelRef& place) const { return glm::length(downhill(place)); }
    double critical(const Bead& bead, double grain) const {
        return critical_radius(p_.weight.bead_angle, steepness(bead.place)) * std::sqrt(grain);
    }
    /// Of what runs; `critical` of what is at rest.
    double critical_moving(const Bead& bead, double grain) const { return std::sqrt(kMoving) * critical(bead, grain); }
    float liquid(const atlas::TexelRef& ref) const {
        const Plane* w = canvas_.liquid(ref.slot, Liquid::film);
        return w ? (*w)[ref.texel] : 0;
    }
    void write(std::uint32_t slot) {
        if (!written.empty() && written.back() == slot) return;
        if (std::find(written.begin(), written.end(), slot) == written.end()) {
            if (before_) before_(slot);
            canvas_.mark_dirty(slot);
        } else {
            std::erase(written, slot);
        }
        written.push_back(slot);
    }

    /// Sets the amount about the bead's middle, and the middle where most of it is.
    bool centre(Bead& bead, double radius) {
        d_.collect_disc(bead.place, bead.at, radius);
        double sum = 0;
        Vec3 moment{0};
        for (const Near& n : d_.disc_) {
            const double over = std::max(0.0, static_cast<double>(liquid(n.ref)) - p_.weight.trail) * n.area;
            sum += over;
            moment += over * n.at;
        }
        bead.amount = sum;
        if (!(sum > 0)) return false;
        put_at(bead, moment / sum);
        return true;
    }

    /// Onto the surface next to a point near it; `collect_disc` has been there.
    void put_at(Bead& bead, const Vec3& at) const {
        double least = 1e300;
        const Near* nearest = nullptr;
        for (const Near& n : d_.disc_)
            if (const double distance = glm::dot(n.at - at, n.at - at); distance < least)
                least = distance, nearest = &n;
        bead.place = nearest->ref;
        const Vec3 n(d_.map_.normal(bead.place.slot, bead.place.texel));
        bead.at = at - n * glm::dot(n, at - nearest->at);
    }

    /// The trail of a bead whose middle is here: round in front, and straight where it came from.
    struct Trail {
        Vec3 at{0}, down{0};
        double half = 0, film = 0;
    };
    Trail trail_of(const Bead& bead, double radius) const {
        const Vec3 down = downhill(bead.place);
        // Fast drops are pointed behind.
        const double steep = glm::length(down),
                     critical = std::sqrt(kMoving) * critical_radius(p_.weight.bead_angle, steep);
        const double ratio = radius / critical, pace = std::clamp(ratio * ratio - 1, 0.0, kFastest);
        return {bead.at, down / steep, std::min(radius, std::sqrt(radius * critical)),
                p_.weight.trail * std::clamp(std::cbrt(pace * pace), kThinnest, 1.0)};
    }
    double trail(const Near& n, const Trail& t) const {
        const Vec3 d = n.at - t.at;
        const double along = std::min(0.0, glm::dot(d, t.down)), square = glm::dot(d, d) - along * along;
        // Texels at its edge are covered in part.
        const double covered = std::clamp((t.half - std::sqrt(square)) / d_.map_.texel_size + 0.5, 0.0, 1.0);
        const double inner = 0.5 * d_.map_.texel_size, profile = 1 - square / (t.half * t.half);
        return t.film * covered * std::sqrt(std::max(profile, inner / t.half));
    }

    /// The film a bead stands on, from what lies round it: `retained` at most.
    struct WetBase {
        double mean = 0;
        Vec3 slope{0};
        Trail trail;
    };
    /// `collect_disc` has been as far as kRing.
    WetBase fit_base(const Bead& bead, double radius) const {
        double sum = 0, area = 0, square = 0;
        Vec3 moment{0}, middle{0};
        for (const Near& n : d_.disc_) {
            if (n.distance < radius || n.distance > kRing * radius) continue;
            const double w = std::min(static_cast<double>(liquid(n.ref)), p_.retained) * n.area;
            const Vec3 d = n.at - bead.at;
            sum += w;
            area += n.area;
            moment += w * d;
            middle += n.area * d;
            square += n.area * glm::dot(d, d);
        }
        const Trail trail = trail_of(bead, radius_of(bead.amount, p_.weight.bead_angle));
        if (!(area > 0)) return {.trail = trail};
        const double mean = sum / area;
        return {mean, (moment - mean * middle) * (2 / square), trail};  // least squares on a full ring
    }
    /// What it leaves there when it goes: the base, or its trail.
    double rest(const Bead& bead, const WetBase& base, const Near& n) const {
        return std::max(std::clamp(base.mean + glm::dot(base.slope, n.at - bead.at), 0.0, p_.retained),
                        trail(n, base.trail));
    }
    /// Above the base within `radius`, and above `retained` round it.
    std::pair<double, double> amounts(const Bead& bead, const WetBase& base, double radius) const {
        double inside = 0, round = 0;
        for (const Near& n : d_.disc_) {
            const auto w = static_cast<double>(liquid(n.ref));
            if (n.distance < radius)
                inside += std::max(0.0, w - rest(bead, base, n)) * n.area;
            else
                round += std::max(0.0, w - p_.retained) * n.area;
        }
        return {inside, round};
    }
    /// Whether what lies there was laid down as a cap, which one at rest is not any more, and hangs on a trail: a dot
    /// that was put on dry surface is held by the line all round it. `collect_disc` has been there.
    bool is_running(const Bead& bead, const WetBase& base, double amount) const {
        const double radius = radius_of(amount, p_.weight.bead_angle);
        return is_full(bead, base, radius) && is_wet_behind(bead, radius);
    }
    bool is_full(const Bead& bead, const WetBase& base, double radius) const {
        const double cap = 0.5 * p_.weight.bead_angle * radius / kFilmUnit;
        double sum = 0, area = 0;
        for (const Near& n : d_.disc_)
            if (n.distance < kSummit * radius)
                sum += (static_cast<double>(liquid(n.ref)) - rest(bead, base, n)) * n.area, area += n.area;
        return sum > kFull * cap * (1 - 0.5 * kSummit * kSummit) * area;
    }
    bool is_wet_behind(const Bead& bead, double radius) const {
        const Vec3 down = glm::normalize(downhill(bead.place));
        const double from = kRim * radius, to = from + std::max(kTrack * radius, 1.5 * d_.map_.texel_size);
        double wet = 0, area = 0;
        for (const Near& n : d_.disc_) {
            const Vec3 d = n.at - bead.at;
            const double behind = -glm::dot(d, down),
                         across = std::sqrt(std::max(0.0, glm::dot(d, d) - behind * behind));
            if (behind < from || behind > to || across > kTrack * radius) continue;
            wet += std::min(static_cast<double>(liquid(n.ref)), kThinnest * p_.weight.trail) * n.area;
            area += n.area;
        }
        return wet > 0.5 * kThinnest * p_.weight.trail * area;
    }
    /// All of the one and `part` of the other, where it is less than `thick`, go into the bead.
    void draw_in(Bead& bead, const WetBase& base, double radius, double part, double thick) {
        for (const Near& n : d_.disc_) {
            const auto w = static_cast<double>(liquid(n.ref));
            if (n.distance < radius)
                take(bead, n, rest(bead, base, n));
            else if (w > p_.retained && w < thick)
                take(bead, n, w - part * (w - p_.retained));
        }
    }

    /// What the bead meets on its way, above `retained`; another bead that it touches comes whole.
    void take_up(Bead& bead, double radius) {
        const Near* thickest = &d_.disc_.front();
        for (const Near& n : d_.disc_)
            if (liquid(n.ref) > liquid(thickest->ref)) thickest = &n;
        if (static_cast<double>(liquid(thickest->ref)) > kBead * p_.retained) {
            Bead other{.place = thickest->ref, .at = thickest->at};
            for (int i = 0; i < kShifts && centre(other, radius); ++i) {
            }
            d_.collect_disc(other.place, other.at, kRing * radius);
            const WetBase base = fit_base(other, kRim * radius);
            for (const Near& n : d_.disc_)
                if (n.distance < kRim * radius) take(bead, n, rest(other, base, n));
            d_.collect_disc(bead.place, bead.at, radius);
        }
        for (const Near& n : d_.disc_) take(bead, n, std::max(p_.retained, p_.weight.trail));
    }

    /// What is thicker than `rest`, with its pigments.
    void take(Bead& bead, const Near& n, double rest_liquid) {
        const auto rest_w = static_cast<float>(rest_liquid);
        if (const float w = liquid(n.ref); w > rest_w) {
            write(n.ref.slot);
            canvas_.touch_liquid(n.ref.slot, Liquid::film)[n.ref.texel] = rest_w;
            bead.amount += (static_cast<double>(w) - static_cast<double>(rest_w)) * n.area;
            const float part = rest_w / w;
            for (int k = 0; k < n_pigments_; ++k) {
                if (!canvas_.plane(n.ref.slot, k)) continue;
                float& p = canvas_.touch(n.ref.slot, k)[n.ref.texel];
                const float rest = p * part;
                bead.pigment[k] += (static_cast<double>(p) - static_cast<double>(rest)) * n.area;
                p = rest;
            }
        }
    }

    /// Moves `part` of the bead onto a texel: booked is what the texel took.
    void give(Bead& bead, const Near& n, double part) {
        if (!(part > 0)) return;
        write(n.ref.slot);
        const auto add = [&](float& to, double& from) {
            const float before = to;
            to = static_cast<float>(static_cast<double>(to) + part * from / n.area);
            return (static_cast<double>(to) - static_cast<double>(before)) * n.area;
        };
        given_.amount += add(canvas_.touch_liquid(n.ref.slot, Liquid::film)[n.ref.texel], bead.amount);
        for (int k = 0; k < n_pigments_; ++k)
            if (bead.pigment[k] > 0)
                given_.pigment[k] += add(canvas_.touch(n.ref.slot, k)[n.ref.texel], bead.pigment[k]);
    }
    void book(Bead& bead) {
        bead.amount = std::max(0.0, bead.amount - given_.amount);
        for (int k = 0; k < n_pigments_; ++k) bead.pigment[k] = std::max(0.0, bead.pigment[k] - given_.pigment[k]);
        given_ = {};
    }

    void leave_trail(Bead& bead, double radius) {
        const Trail here = trail_of(bead, radius);
        for (const Near& n : d_.disc_) {
            const double lacking = (trail(n, here) - static_cast<double>(liquid(n.ref))) * n.area;
            if (lacking > 0 && bead.amount > 0) give(bead, n, std::min(lacking / bead.amount, 1e-3));
        }
        book(bead);
    }

    /// Whether it came to rest where the surface holds it.
    bool move(Bead& bead, double grain, double seconds) {
        double radius = radius_of(bead.amount, p_.weight.bead_angle);
        d_.collect_disc(bead.place, bead.at, radius);
        leave_trail(bead, radius);
        const double least_step = 0.5 * d_.map_.texel_size;
        while (seconds > 0) {
            const Vec3 down = downhill(bead.place);
            const double steep = glm::length(down), ratio = radius / critical_moving(bead, grain);
            if (steep < kLeastSteepness) return false;
            if (ratio < kStops) return true;
            const double speed = p_.weight.bead_speed * std::min(ratio * ratio - 1, kFastest);
            const double step = std::min(std::max(least_step, 0.08 * radius), speed * seconds);
            seconds -= step / speed;
            d_.collect_disc(bead.place, bead.at, radius);
            const Vec3 was = bead.at;
            put_at(bead, bead.at + down * (step / steep));
            if (glm::distance(was, bead.at) < 0.1 * step) return false;  // an edge of the model
            d_.collect_disc(bead.place, bead.at, radius);
            take_up(bead, radius);
            leave_trail(bead, radius);
            radius = radius_of(bead.amount, p_.weight.bead_angle);
        }
        return radius < kStops * critical_moving(bead, grain);
    }

    /// As a cap whose middle is the bead's; what rounding leaves over goes to the texel there. At rest it is blunt in
    /// front, where it meets dry surface, and drawn out behind, where its own trail holds it at a lower angle.
    void deposit_bead(Bead& bead, bool rests) {
        const double radius = radius_of(bead.amount, p_.weight.bead_angle), square = radius * radius;
        if (rests) return hang(bead);
        d_.collect_disc(bead.place, bead.at, radius);
        // Texels lie unevenly at seams: without the tilt a bead would creep to one side, step by step.
        Vec3 tilt{0};
        const auto height = [&](const Near& n) {
            return std::max(0.0, 1 - n.distance * n.distance / square) * n.area *
                   std::clamp(1 - glm::dot(tilt, n.at - bead.at), 0.5, 1.5);
        };
        double sum = 0;
        for (int i = 0; i < kTilts; ++i) {
            Vec3 moment{0};
            sum = 0;
            for (const Near& n : d_.disc_) sum += height(n), moment += height(n) * (n.at - bead.at);
            if (sum > 0 && i + 1 < kTilts) tilt += moment / sum * (6 / square);  // a cap's mean square is R²/6 each way
        }
        spread(bead, sum, height);
    }
    void hang(Bead& bead) {
        const double radius = radius_of(bead.amount, kRestAngle * p_.weight.bead_angle);
        d_.collect_disc(bead.place, bead.at, kTail * radius);
        const Vec3 down = glm::normalize(downhill(bead.place));
        const auto height = [&](const Near& n) {
            const Vec3 d = n.at - bead.at;
            const double along = glm::dot(d, down), across = std::max(0.0, glm::dot(d, d) - along * along);
            const double behind = std::max(0.0, -along) / radius, front = std::max(0.0, along) / radius;
            const double cap =
                std::max(0.0, 1 - across / (radius * radius) - front * front - behind * behind / (kTail * kTail));
            // A cap before its middle; behind, it runs out flat into the trail, where there is one.
            const double trail =
                std::clamp(static_cast<double>(liquid(n.ref)) / (kThinnest * p_.weight.trail), 0.0, 1.0);
            const double wet = std::lerp(1.0, trail, std::clamp(2 * behind - 1, 0.0, 1.0));
            return wet * std::lerp(cap, cap * cap, std::min(behind, 1.0)) * n.area;
        };
        // Before any of it is given: what lies there counts.
        std::vector<double>& part = d_.part_;
        part.clear();
        double sum = 0;
        for (const Near& n : d_.disc_) sum += part.emplace_back(height(n));
        spread(bead, sum, [&](const Near& n) { return part[static_cast<std::size_t>(&n - d_.disc_.data())]; });
    }
    /// In parts of `height`, which sum to `sum`.
    template <class Fn>
    void spread(Bead& bead, double sum, Fn height) {
        if (sum > 0)
            for (const Near& n : d_.disc_) give(bead, n, height(n) / sum);
        book(bead);
        give(bead, d_.disc_.front(), 1);
        given_ = {};
    }

    Drips& d_;
    Canvas& canvas_;
    const FilmParams& p_;
    const BeforeFn& before_;
    int n_pigments_;
    Bead given_{};
    struct Seen {
        Vec3 at;
        double radius;
    };
    std::vector<Seen> seen_;  ///< beads, where they were and where they went
};

std::vector<std::uint32_t> Drips::run(Canvas& canvas, std::span<const Seed> seeds, const FilmParams& params,
                                      double seconds, const BeforeFn& before) {
    Run run(*this, canvas, params, before);
    for (const Seed& seed : seeds) run.run(seed, seconds);
    std::sort(run.written.begin(), run.written.end());
    return std::move(run.written);
}

}  // namespace tuft::ink::wet
