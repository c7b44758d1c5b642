#pragma once

#include <array>
#include <cstdint>
#include <map>

/// \file
/// Cache of rejected merges and seam moves. Used by atlas/charts.
namespace tuft::atlas {

/// Rejected changes of pairs of charts. A change is not tried again while both charts have the same
/// `FlatChart::version`.
struct RejectedChanges {
    /// The seam that is changed, by a half-edge, and the versions of the charts beside it.
    using Change = std::array<std::uint32_t, 3>;

    std::map<Change, int> merged;  ///< how often each was rejected
    std::map<Change, int> moved;

    /// Returns how often a change was rejected.
    static int count(const std::map<Change, int>& rejected, const Change& change) {
        const auto it = rejected.find(change);
        return it == rejected.end() ? 0 : it->second;
    }
};

}  // namespace tuft::atlas
