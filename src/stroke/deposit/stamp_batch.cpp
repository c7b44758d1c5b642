#include "stroke/deposit/stamp_batch.h"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>

#include "core/system/parallel.h"
#include "ink/exchange/tile_deposit.h"

namespace tuft::stroke {
namespace {

constexpr std::size_t kTilesPerReport = 512;

}  // namespace

StampBatch::StampBatch(StampTarget& target, const footprint::StampOptions& options)
    : target_(target), options_(options), plans_(kStamps) {
    batch_.reserve(kStamps);
    moved_.reserve(kStamps);
}

bool StampBatch::add(Stamp stamp) {
    batch_.push_back(std::move(stamp));
    return batch_.size() >= kStamps;
}

void StampBatch::plan() {
    const footprint::Surface surface = target_.model().surface();
    const double texel = target_.texels().texel_size;
    moved_.clear();
    for (const Stamp& stamp : batch_) moved_.push_back({stamp.footprint, joined_motion(stamp, texel)});
    {
        PlanScratchPool::Lease scratch(target_.scratch());
        around_ = footprint::find_neighbourhood(surface, moved_, options_, scratch, std::move(around_));
    }
    const auto plan_some = [&](std::size_t begin, std::size_t end) {
        PlanScratchPool::Lease scratch(target_.scratch());
        for (std::size_t i = begin; i < end; ++i)
            plans_[i] =
                footprint::plan_stamp(surface, batch_[i].footprint, moved_[i].motion,
                                      stamp_options(options_, batch_[i]), {scratch, std::move(plans_[i])}, around_);
    };
    parallel_for(batch_.size(), 2, std::ref(plan_some));  // by reference: a loop allocates nothing
}

// The tiles of each plan are in order: they are merged.
void StampBatch::sort_by_tile() {
    order_.clear();
    first_.clear();
    std::array<std::uint32_t, kStamps> at{};    // of each plan's tiles, the next
    std::array<std::uint32_t, kStamps> slot{};  // of that tile; kNone: no more
    const auto next_slot = [&](std::size_t i) {
        return at[i] < plans_[i].tiles.size() ? plans_[i].tiles[at[i]].slot : kNone;
    };
    slot.fill(kNone);
    for (std::size_t i = 0; i < batch_.size(); ++i) {
        if (plans_[i].empty()) continue;
        piecewise_ = footprint::choose_mode(plans_[i], piecewise_, options_);
        slot[i] = next_slot(i);
    }
    for (;;) {
        const std::uint32_t least = std::ranges::min(slot);
        if (least == kNone) break;
        first_.push_back(order_.size());
        for (std::size_t i = 0; i < kStamps; ++i) {
            if (slot[i] != least) continue;
            order_.push_back({least, static_cast<std::uint32_t>(i), at[i]++});
            slot[i] = next_slot(i);
        }
    }
    first_.push_back(order_.size());
}

// Over a batch the hand goes some texels on: one of its stamps gives the tone of all.
bool StampBatch::find_tone(std::uint32_t slot, const Stamp& stamp, std::span<float, atlas::kTileTexels> tone) {
    if (stamp.tone.even && !(stamp.grain_share > 0)) return false;
    std::ranges::fill(tone, 1.0f);
    atlas::TexelShape buffer;
    ink::apply_profile(tone, stamp.tone, atlas::shape_of(target_.texels(), slot, buffer));
    target_.apply_grain(slot, tone, stamp.grain_share);
    return true;
}

// All stamps of one tile, by one thread. `erased`: one for each stamp, or none.
double StampBatch::write_tile(std::span<const TileStamp> stamps, std::span<const ink::DepositLaw> laws,
                              std::span<ink::Amounts> erased, footprint::Unpacked& unpacked) {
    alignas(64) std::array<float, atlas::kTileTexels> exposure;
    const std::uint32_t slot = stamps.front().slot;
    const atlas::TexelTile& tile = target_.texels().tiles[slot];
    const MaskTexels* mask = target_.mask();
    if (mask && mask->none(slot)) return 0;
    alignas(64) std::array<float, atlas::kTileTexels> tone;
    std::optional<ink::TileDeposit> deposit;
    for (std::size_t k = 0; k < stamps.size(); ++k) {
        const footprint::StampJobs& plan = plans_[stamps[k].stamp];
        if (!footprint::evaluate_tile(target_.texels(), plan, plan.tiles[stamps[k].tile], unpacked, exposure)) continue;
        const Stamp& stamp = batch_[stamps[k].stamp];
        if (mask) mask->apply(slot, exposure);
        if (!erased.empty()) {
            erased[k] = ink::erase(target_.canvas(), {{slot, exposure, tile.area}, stamp.ds}, erase_starts_.at(slot),
                                   {.strength = stamp.erases});
            continue;
        }
        if (!deposit) {
            const bool toned = find_tone(slot, batch_[stamps[stamps.size() / 2].stamp], tone);
            deposit.emplace(target_.canvas(), slot, tile.area,
                            toned ? std::span<const float>(tone) : std::span<const float>());
        }
        if (stamp.by_hair) target_.expose_grain(slot, exposure, stamp.grain_film);
        ink::DepositParams ink = stamp.ink;
        ink.capacity = target_.capacity(slot, ink.capacity);
        deposit->add(exposure, ink, laws[stamps[k].stamp]);
    }
    return deposit ? deposit->finish() : 0;
}

double StampBatch::flush(const ProgressFn& going_on) {
    if (batch_.empty()) return 0;
    plan();
    sort_by_tile();
    const std::size_t n_tiles = first_.size() - 1;
    for (std::size_t t = 0; t < n_tiles; ++t) target_.snapshot(order_[first_[t]].slot);

    const bool erases = batch_.front().erases > 0;
    for (std::size_t t = 0; erases && t < n_tiles; ++t) {
        const std::uint32_t slot = order_[first_[t]].slot;
        if (!erase_starts_.contains(slot)) erase_starts_.emplace(slot, ink::erase_start(target_.canvas(), slot));
    }
    if (std::any_of(batch_.begin(), batch_.end(), [](const Stamp& s) { return s.by_hair || s.grain_share > 0; }))
        for (std::size_t t = 0; t < n_tiles; ++t) target_.prepare_grain(order_[first_[t]].slot);
    std::array<ink::DepositLaw, kStamps> laws;
    for (std::size_t i = 0; i < batch_.size(); ++i) laws[i] = ink::deposit_law(batch_[i].ink, batch_[i].ds);

    given_.assign(n_tiles, 0.0);
    erased_of_.assign(erases ? order_.size() : 0, {});
    for (std::size_t from = 0; from < n_tiles; from += kTilesPerReport) {
        report(going_on, "painting", 0);
        const std::size_t n = std::min(kTilesPerReport, n_tiles - from);
        const auto write_some = [&](std::size_t begin, std::size_t end) {
            footprint::Unpacked unpacked;
            for (std::size_t t = from + begin; t < from + end; ++t) {
                const std::size_t at = first_[t], n_stamps = first_[t + 1] - at;
                given_[t] = write_tile(std::span(order_).subspan(at, n_stamps), laws,
                                       erases ? std::span(erased_of_).subspan(at, n_stamps) : std::span<ink::Amounts>(),
                                       unpacked);
            }
        };
        parallel_for(n, 4, std::ref(write_some));
    }
    batch_.clear();
    for (const ink::Amounts& e : erased_of_) erased_ += e;
    double sum = 0;
    for (const double g : given_) sum += g;
    return sum;
}

void StampBatch::blot(const atlas::SeamLinks& seams) {
    std::function<bool(std::uint32_t, int)> free;
    if (const MaskTexels* mask = target_.mask())
        free = [mask](std::uint32_t slot, int texel) { return mask->coverage(slot, texel) == 255; };
    erased_ += ink::blot(target_.canvas(), target_.texels(), seams, erase_starts_, free,
                         [this](std::uint32_t slot) { target_.snapshot(slot); });
}

}  // namespace tuft::stroke
