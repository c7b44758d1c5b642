#include "stroke/painting/stamper.h"

#include <algorithm>
#include <array>

#include "core/parallel.h"
#include "ink/film/pool.h"
#include "ink/film/relief.h"

namespace tuft::stroke {

namespace {

constexpr double kHeldByRidges = 0.35;  // of the film that is laid

}  // namespace

PlanRooms::Room::Room(PlanRooms& rooms) : rooms_(rooms) {
    const std::lock_guard lock(rooms_.mutex_);
    if (rooms_.free_.empty()) {
        scratch_ = std::make_unique<footprint::PlanScratch>();
        rooms_.free_.reserve(++rooms_.made_);  // giving it back never throws
    } else {
        scratch_ = std::move(rooms_.free_.back());
        rooms_.free_.pop_back();
    }
}

PlanRooms::Room::~Room() {
    const std::lock_guard lock(rooms_.mutex_);
    rooms_.free_.push_back(std::move(scratch_));
}

Stamper::Stamper(const Model& model, ink::Canvas& canvas, const footprint::StampOptions& options,
                 const ink::Substrate& substrate, PlanRooms& rooms)
    : model_(model),
      canvas_(canvas),
      options_(options),
      rooms_(rooms),
      jobs_(kBatch),
      grain_rms_(substrate.relief),
      grain_length_(substrate.relief_length) {
    batch_.reserve(kBatch);
}

// Called by the one thread that works on the slot.
const Stamper::Grain& Stamper::grain(std::uint32_t slot) {
    if (!grain_[slot]) {
        grain_[slot] = std::make_unique<Grain>();
        atlas::TexelShape room;
        ink::relief_of_tile(atlas::shape_of(model_.texels, slot, room), static_cast<double>(grain_length_), *grain_[slot]);
    }
    return *grain_[slot];
}

// Edges of a picture are soft over a texel: single hairs begin that much within the stamp before, so that their marks join.
footprint::Motion Stamper::motion_of(const Stamp& stamp) const {
    footprint::Motion motion = stamp.motion;
    const double way = glm::length(motion.shift);
    if (stamp.apart > 0 && way > 0) motion.shift *= 1 + static_cast<double>(stamp.apart) * model_.texels.texel_size / way;
    return motion;
}

bool Stamper::add(Stamp stamp) {
    batch_.push_back(std::move(stamp));
    return batch_.size() >= kBatch;
}

double Stamper::flush(const ProgressFn& going_on) {
    constexpr std::size_t kTilesPerQuestion = 512;
    if (batch_.empty()) return 0;
    const footprint::Surface surface = model_.surface();
    parallel_for(batch_.size(), 2, [&](std::size_t begin, std::size_t end) {
        PlanRooms::Room room(rooms_);
        for (std::size_t i = begin; i < end; ++i)
            jobs_[i] = footprint::plan_stamp(surface, batch_[i].footprint, motion_of(batch_[i]), options_of(batch_[i]),
                                             room, std::move(jobs_[i]));
    });

    struct Job {
        std::uint32_t slot, stamp, tile;
    };
    std::vector<Job> order;
    for (std::uint32_t i = 0; i < batch_.size(); ++i) {
        if (jobs_[i].empty()) continue;
        piecewise_ = footprint::choose_mode(jobs_[i], piecewise_, options_);
        for (std::uint32_t k = 0; k < jobs_[i].tiles.size(); ++k)
            order.push_back({jobs_[i].tiles[k].slot, i, k});
    }
    std::sort(order.begin(), order.end(), [](const Job& a, const Job& b) {
        return a.slot != b.slot ? a.slot < b.slot : a.stamp < b.stamp;
    });
    std::vector<std::uint32_t> runs;  // where each slot's jobs start
    for (std::uint32_t k = 0; k < order.size(); ++k) {
        if (k > 0 && order[k].slot == order[k - 1].slot) continue;
        runs.push_back(k);
        keep(order[k].slot);
    }
    runs.push_back(static_cast<std::uint32_t>(order.size()));

    const bool erases = batch_.front().erases > 0;
    for (std::size_t r = 0; erases && r + 1 < runs.size(); ++r) {
        const std::uint32_t slot = order[runs[r]].slot;
        if (!starts_.contains(slot)) starts_.emplace(slot, ink::erase_start(canvas_, slot));
    }
    if (grain_.empty() && std::any_of(batch_.begin(), batch_.end(), [](const Stamp& s) { return s.by_hair; }))
        grain_.resize(model_.texels.n_slots());
    std::array<ink::DepositLaw, kBatch> laws;
    for (std::size_t i = 0; i < batch_.size(); ++i) laws[i] = ink::deposit_law(batch_[i].ink, batch_[i].ds);
    std::vector<double> given(order.size(), 0.0);
    std::vector<ink::Amounts> erased(erases ? order.size() : 0);
    const auto lay_tiles = [&](std::size_t begin, std::size_t end) {
        alignas(64) std::array<float, atlas::kTileTexels> exposure;
        footprint::Unpacked unpacked;
        for (std::size_t r = begin; r < end; ++r) {
            const std::uint32_t slot = order[runs[r]].slot;
            const atlas::TexelTile& tile = model_.texels.tiles[slot];
            if (mask_ && mask_->none(slot)) continue;
            for (std::uint32_t k = runs[r]; k < runs[r + 1]; ++k) {
                const Job& job = order[k];
                const footprint::StampJobs& plan = jobs_[job.stamp];
                if (!footprint::evaluate_tile(model_.texels, plan, plan.tiles[job.tile], unpacked,
                                              exposure))
                    continue;
                const Stamp& stamp = batch_[job.stamp];
                if (mask_) mask_->apply(slot, exposure);
                if (erases) {
                    erased[k] = ink::erase(canvas_, job.slot, exposure, tile.area, stamp.ds,
                                           starts_.at(job.slot), {.strength = stamp.erases});
                    continue;
                }
                if (stamp.by_hair)
                    ink::expose_relief(exposure, grain(slot), grain_rms_,
                                       static_cast<float>(stamp.grain_film));
                given[k] = ink::deposit(canvas_, slot, exposure, tile.area, stamp.ink, laws[job.stamp]);
            }
        }
    };
    for (std::size_t from = 0; from + 1 < runs.size(); from += kTilesPerQuestion) {
        report(going_on, "painting", 0);
        const std::size_t n = std::min(kTilesPerQuestion, runs.size() - 1 - from);
        parallel_for(n, 4, [&](std::size_t begin, std::size_t end) { lay_tiles(from + begin, from + end); });
    }
    batch_.clear();
    for (const ink::Amounts& e : erased) erased_ += e;
    double sum = 0;
    for (const double g : given) sum += g;
    return sum;
}

void Stamper::keep(std::uint32_t slot) {
    if (!before_.contains(slot)) before_.emplace(slot, canvas_.snapshot(slot));
}

ink::NodeAreas Stamper::expose(const Stamp& stamp) {
    PlanRooms::Room planning(rooms_);
    jobs_[0] = footprint::plan_stamp(model_.surface(), stamp.footprint, motion_of(stamp), options_of(stamp), planning,
                                     std::move(jobs_[0]));
    const footprint::StampJobs& plan = jobs_[0];
    exposed_.clear();
    if (plan.empty()) return {};
    piecewise_ = footprint::choose_mode(jobs_[0], piecewise_, options_);
    exposed_.resize(plan.tiles.size());
    if (grain_.empty() && stamp.by_hair) grain_.resize(model_.texels.n_slots());
    parallel_for(exposed_.size(), 4, [&](std::size_t begin, std::size_t end) {
        footprint::Unpacked unpacked;
        atlas::TexelShape room;
        ink::Tents tents;
        for (std::size_t i = begin; i < end; ++i) {
            Exposed& e = exposed_[i];
            const std::uint32_t slot = plan.tiles[i].slot;
            if (!footprint::evaluate_tile(model_.texels, plan, plan.tiles[i], unpacked, e.exposure)) continue;
            if (mask_ && mask_->none(slot)) continue;
            if (mask_) mask_->apply(slot, e.exposure);
            e.slot = slot;
            if (stamp.by_hair)
                ink::expose_relief(e.exposure, grain(slot), grain_rms_, static_cast<float>(stamp.grain_film));
            ink::place_texels(e.places, stamp.grid, stamp.footprint.frame, atlas::shape_of(model_.texels, slot, room));
            ink::tents_of(tents, e.places, e.exposure);
            ink::NodeAreas of_tents;
            ink::tent_sums(of_tents, tents, nullptr, model_.texels.tiles[slot].area);
            for (int k = 0; k < tents.count; ++k) e.areas[tents.node[k]] = of_tents[k];
        }
    });
    ink::NodeAreas areas{};
    for (const Exposed& e : exposed_)
        if (e.slot != kNone)
            for (int node = 0; node < ink::kNodes; ++node) areas[node] += e.areas[node];
    return areas;
}

// act(exposed tile, its tents) by the one thread that works on the slot.
template <class F>
ink::NodeContents Stamper::act_on_exposed(F act) {
    for (const Exposed& e : exposed_)
        if (e.slot != kNone) keep(e.slot);
    parallel_for(exposed_.size(), 2, [&](std::size_t begin, std::size_t end) {
        ink::Tents tents;
        for (std::size_t i = begin; i < end; ++i) {
            Exposed& e = exposed_[i];
            if (e.slot == kNone) continue;
            ink::tents_of(tents, e.places, e.exposure);
            act(e, tents);
        }
    });
    ink::NodeContents given{};
    for (const Exposed& e : exposed_)
        for (int node = 0; node < ink::kNodes; ++node)
            for (int p = 0; p < ink::Reservoir::kPlanes; ++p) given[node][p] += e.given[node][p];
    return given;
}

ink::NodeContents Stamper::exchange(const ink::TransferParams& params, double ds, double loose) {
    return act_on_exposed([&](Exposed& e, const ink::Tents& tents) {
        if (canvas_.has_film(e.slot, ink::kOpenFilm))
            ink::bed_paste(canvas_, e.slot, ink::paste_height(canvas_, e.slot), e.exposure, loose);
        ink::transfer(canvas_, e.slot, e.exposure, e.places, tents, model_.texels.tiles[e.slot].area, ds, params, e.given);
    });
}

ink::NodeContents Stamper::lay(const ink::DepositParams& params, const ink::NodeMixes& mixes, double ds) {
    return act_on_exposed([&](Exposed& e, const ink::Tents& tents) {
        ink::deposit_mixed(canvas_, e.slot, e.exposure, tents, model_.texels.tiles[e.slot].area, ds, params, mixes,
                           e.given);
    });
}

Stamper::Passed Stamper::plough(const ink::PasteParams& params, const ink::NodeMixes& mixes, double ds) {
    for (const Exposed& e : exposed_)
        if (e.slot != kNone && !pastes_.contains(e.slot))
            pastes_.emplace(e.slot, std::make_unique<ink::Plane>(ink::open_pigment(canvas_, e.slot)));
    Passed passed;
    passed.given = act_on_exposed([&](Exposed& e, const ink::Tents& tents) {
        ink::lay_paste(canvas_, e.slot, e.exposure, e.places, tents, model_.texels.tiles[e.slot].area, ds, params,
                       mixes, *pastes_.at(e.slot), e.given, e.taken);
    });
    for (const Exposed& e : exposed_)
        for (int node = 0; node < ink::kNodes; ++node)
            for (int p = 0; p < ink::Reservoir::kPlanes; ++p) passed.taken[node][p] += e.taken[node][p];
    return passed;
}

void Stamper::level(const atlas::SeamLinks& seams, double length) {
    ink::level_paste(canvas_, model_.texels, seams, pastes_, length);
}

bool Stamper::on_relief() const {
    return std::any_of(before_.begin(), before_.end(), [&](const auto& tile) {
        if (!canvas_.has_film(tile.first, ink::kFirstDryFilm)) return false;
        const ink::Plane z = ink::dry_relief(canvas_, tile.first);
        return *std::max_element(z.begin(), z.end()) > static_cast<float>(ink::kPlain);
    });
}

void Stamper::pool(const atlas::SeamLinks& seams, double film, double strength) {
    std::vector<const ink::TileSnapshot*> before;
    for (const auto& [slot, tile] : before_) before.push_back(&tile);
    std::sort(before.begin(), before.end(), [](const auto* a, const auto* b) { return a->slot < b->slot; });
    ink::PoolOptions options{.hold = kHeldByRidges * film, .strength = strength};
    if (mask_) options.free = [this](std::uint32_t slot, int texel) { return mask_->coverage(slot, texel) > 0; };
    ink::pool(canvas_, model_.texels, seams, before, options);
}

void Stamper::blot(const atlas::SeamLinks& seams) {
    std::function<bool(std::uint32_t, int)> free;
    if (mask_) free = [this](std::uint32_t slot, int texel) { return mask_->coverage(slot, texel) == 255; };
    erased_ += ink::blot(canvas_, model_.texels, seams, starts_, free, [this](std::uint32_t slot) { keep(slot); });
}

std::vector<ink::TileSnapshot> Stamper::take_before() {
    std::vector<ink::TileSnapshot> tiles;
    tiles.reserve(before_.size());
    for (auto& [slot, snapshot] : before_) tiles.push_back(std::move(snapshot));
    before_.clear();
    std::sort(tiles.begin(), tiles.end(),
              [](const ink::TileSnapshot& a, const ink::TileSnapshot& b) { return a.slot < b.slot; });
    return tiles;
}

}  // namespace tuft::stroke
