#pragma once

#include <array>
#include <cstdint>
#include <map>

namespace tuft::atlas {

/// Changes to pairs of charts that were tried in vain, so that none is tried again while both
/// charts are as they were: `FlatChart::version` tells.
struct RejectedChanges {
    /// The seam that is changed, by a half-edge, and the versions of the charts beside it.
    using Change = std::array<std::uint32_t, 3>;

    std::map<Change, int> merged;  ///< how often each was rejected
    std::map<Change, int> moved;

    static int count(const std::map<Change, int>& rejected, const Change& change) {
        const auto it = rejected.find(change);
        return it == rejected.end() ? 0 : it->second;
    }
};

}  // namespace tuft::atlas
