#include "atlas/seams/straighten.h"

#include "atlas/seams/seam_paths.h"

namespace tuft::atlas {
namespace {

constexpr int kRounds = 2;
constexpr float kReach = 0.25f;  // how far a seam may leave its chain, over the chain's length

}  // namespace

void straighten_seams(const Patch& patch, std::vector<std::uint8_t>& seam) {
    SeamPaths paths(patch, std::move(seam));
    PathSearch search = paths.make_search();
    for (int round = 0; round < kRounds; ++round) {
        std::vector<std::uint8_t> seen(paths.seams().size(), 0);
        const auto see = [&](const std::vector<std::uint32_t>& halves) {
            for (const std::uint32_t h : halves) seen[h] = seen[patch.twin[h]] = 1;
        };
        for (std::uint32_t h = 0; h < seen.size(); ++h) {
            if (seen[h] || !paths.starts_chain(h)) continue;
            std::vector<std::uint32_t> chain = paths.chain_from(h);
            see(chain);
            const SeamMove move = paths.shorten(std::move(chain), kReach, Corners::stay, search);
            if (move.path.empty()) continue;
            paths.move(move);
            see(move.path);
        }
    }
    seam = paths.seams();
}

}  // namespace tuft::atlas
