#include "stroke/deposit/stamp_exposure.h"

#include "core/system/parallel.h"

namespace tuft::stroke {
namespace {

void add(ink::NodeContents& sum, const ink::NodeContents& part) {
    for (int node = 0; node < ink::kNodes; ++node)
        for (int p = 0; p < ink::Reservoir::kPlanes; ++p) sum[node][p] += part[node][p];
}

// `tile`: a StampExposure::Tile.
template <class Tile>
ink::StampedTile stamped(const Tile& tile, const StampTarget& target, double ds) {
    return {{tile.slot, tile.exposure, target.texels().tiles[tile.slot].area}, ds};
}

}  // namespace

StampExposure::StampExposure(StampTarget& target, const footprint::StampOptions& options)
    : target_(target), options_(options) {}

struct StampExposure::Scratch {
    footprint::Unpacked unpacked;
    atlas::TexelShape shape;
    ink::HatBasis basis;
};

// The tile holds what the last stamp left in its place.
void StampExposure::expose_tile(Tile& tile, const Stamp& stamp, const footprint::TileJob& job, Scratch& scratch) {
    tile.slot = kNone;
    tile.areas = {};
    tile.given = tile.taken = {};
    if (!footprint::evaluate_tile(target_.texels(), plan_, job, scratch.unpacked, tile.exposure)) return;
    const MaskTexels* mask = target_.mask();
    if (mask && mask->none(job.slot)) return;
    if (mask) mask->apply(job.slot, tile.exposure);
    tile.slot = job.slot;
    if (stamp.by_hair) target_.expose_grain(job.slot, tile.exposure, stamp.grain_film);
    ink::place_texels(tile.places, stamp.grid, stamp.footprint.frame,
                      atlas::shape_of(target_.texels(), job.slot, scratch.shape));
    ink::HatBasis& basis = scratch.basis;
    ink::hat_basis(basis, tile.places, tile.exposure);
    ink::NodeAreas areas;
    ink::integrate_hats(areas, basis, nullptr, target_.texels().tiles[job.slot].area);
    for (int k = 0; k < basis.count; ++k) tile.areas[basis.node[k]] = areas[k];
}

ink::NodeAreas StampExposure::expose(const Stamp& stamp) {
    {
        PlanScratchPool::Lease scratch(target_.scratch());
        plan_ = footprint::plan_stamp(target_.model().surface(), stamp.footprint,
                                      joined_motion(stamp, target_.texels().texel_size), stamp_options(options_, stamp),
                                      {scratch, std::move(plan_)});
    }
    tiles_.resize(plan_.tiles.size());
    if (plan_.empty()) return {};
    piecewise_ = footprint::choose_mode(plan_, piecewise_, options_);
    for (const footprint::TileJob& job : plan_.tiles)
        if (stamp.by_hair) target_.prepare_grain(job.slot);
    parallel_for(tiles_.size(), 4, [&](std::size_t begin, std::size_t end) {
        Scratch scratch;
        for (std::size_t i = begin; i < end; ++i) expose_tile(tiles_[i], stamp, plan_.tiles[i], scratch);
    });
    ink::NodeAreas areas{};
    for (const Tile& tile : tiles_)
        if (tile.slot != kNone)
            for (int node = 0; node < ink::kNodes; ++node) areas[node] += tile.areas[node];
    return areas;
}

// act(tile, basis) by the one thread that works on the tile.
template <class Act>
ink::NodeContents StampExposure::act_on_tiles(Act act) {
    for (const Tile& tile : tiles_)
        if (tile.slot != kNone) target_.snapshot(tile.slot);
    parallel_for(tiles_.size(), 2, [&](std::size_t begin, std::size_t end) {
        ink::HatBasis basis;
        for (std::size_t i = begin; i < end; ++i) {
            if (tiles_[i].slot == kNone) continue;
            ink::hat_basis(basis, tiles_[i].places, tiles_[i].exposure);
            act(tiles_[i], basis);
        }
    });
    ink::NodeContents given{};
    for (const Tile& tile : tiles_) add(given, tile.given);
    return given;
}

ink::NodeContents StampExposure::exchange(const ink::TransferParams& params, double ds, double loose) {
    ink::Canvas& canvas = target_.canvas();
    return act_on_tiles([&](Tile& tile, const ink::HatBasis& basis) {
        if (canvas.has_film(tile.slot, ink::kOpenFilm))
            ink::bed_paste(canvas, tile.slot, ink::paste_height(canvas, tile.slot), tile.exposure, loose);
        const ink::ContactTile on{stamped(tile, target_, ds), tile.places, basis};
        const float capacity = target_.capacity(tile.slot, params.deposit.capacity);
        if (capacity == params.deposit.capacity) return ink::transfer(canvas, on, params, tile.given);
        ink::TransferParams on_tile = params;
        on_tile.deposit.capacity = capacity;
        ink::transfer(canvas, on, on_tile, tile.given);
    });
}

ink::NodeContents StampExposure::deposit(const ink::DepositParams& params, const ink::NodeMixes& mixes, double ds) {
    return act_on_tiles([&](Tile& tile, const ink::HatBasis& basis) {
        ink::DepositParams on_tile = params;
        on_tile.capacity = target_.capacity(tile.slot, params.capacity);
        ink::deposit_mixed(target_.canvas(), stamped(tile, target_, ds), basis, on_tile, mixes, tile.given);
    });
}

StampExposure::Exchanged StampExposure::plough(const ink::PasteParams& params, const ink::NodeMixes& mixes, double ds) {
    for (const Tile& tile : tiles_)
        if (tile.slot != kNone && !pastes_.contains(tile.slot))
            pastes_.emplace(tile.slot, std::make_unique<ink::Plane>(ink::open_pigment(target_.canvas(), tile.slot)));
    Exchanged exchanged;
    exchanged.given = act_on_tiles([&](Tile& tile, const ink::HatBasis& basis) {
        ink::PasteParams on_tile = params;
        on_tile.capacity = static_cast<double>(target_.capacity(tile.slot, static_cast<float>(params.capacity)));
        ink::deposit_paste(target_.canvas(), {stamped(tile, target_, ds), tile.places, basis}, on_tile, mixes,
                           *pastes_.at(tile.slot), {tile.given, tile.taken});
    });
    for (const Tile& tile : tiles_) add(exchanged.taken, tile.taken);
    return exchanged;
}

void StampExposure::level(const atlas::SeamLinks& seams, double length) {
    ink::level_paste(target_.canvas(), target_.texels(), seams, pastes_, length);
}

}  // namespace tuft::stroke
