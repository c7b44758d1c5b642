#include "writer/copy/thinning.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace tuft::writer {
namespace {

/// Whether one of the two passes takes a cell.
bool is_taken(const Cells& c, int i, int j, bool odd) {
    // Anticlockwise from above.
    const int p2 = c.at(i, j + 1), p3 = c.at(i + 1, j + 1), p4 = c.at(i + 1, j), p5 = c.at(i + 1, j - 1),
              p6 = c.at(i, j - 1), p7 = c.at(i - 1, j - 1), p8 = c.at(i - 1, j), p9 = c.at(i - 1, j + 1);
    const int crossings = (!p2 && (p3 || p4)) + (!p4 && (p5 || p6)) + (!p6 && (p7 || p8)) + (!p8 && (p9 || p2));
    if (crossings != 1) return false;
    const int a = (p9 || p2) + (p3 || p4) + (p5 || p6) + (p7 || p8),
              b = (p2 || p3) + (p4 || p5) + (p6 || p7) + (p8 || p9), n = std::min(a, b);
    if (n < 2 || n > 3) return false;
    return !(odd ? ((p6 || p7 || !p9) && p8) : ((p2 || p3 || !p5) && p4));
}

/// Takes cells off. Looks at those at the edge only: one among eight others is never taken.
class Thinning {
  public:
    explicit Thinning(Cells& cells) : c_(cells), seen_(cells.inside.size(), 0) {
        for (int j = 0; j < c_.height; ++j)
            for (int i = 0; i < c_.width; ++i)
                if (c_.at(i, j) && is_edge(i, j)) add(i, j);
    }

    /// One of the two passes. Returns whether a cell was taken.
    bool take(bool odd) {
        std::vector<std::size_t> taken, left;
        for (const std::size_t k : edge_) {
            const int i = static_cast<int>(k % c_.width), j = static_cast<int>(k / c_.width);
            (is_taken(c_, i, j, odd) ? taken : left).push_back(k);
        }
        edge_ = std::move(left);
        for (const std::size_t k : taken) c_.inside[k] = 0;
        for (const std::size_t k : taken) {
            const int i = static_cast<int>(k % c_.width), j = static_cast<int>(k / c_.width);
            for (int b = j - 1; b <= j + 1; ++b)
                for (int a = i - 1; a <= i + 1; ++a)
                    if (c_.at(a, b)) add(a, b);
        }
        return !taken.empty();
    }

  private:
    bool is_edge(int i, int j) const {
        for (int b = j - 1; b <= j + 1; ++b)
            for (int a = i - 1; a <= i + 1; ++a)
                if (!c_.at(a, b)) return true;
        return false;
    }
    void add(int i, int j) {
        const std::size_t k = std::size_t(j) * c_.width + i;
        if (seen_[k]) return;
        seen_[k] = 1;
        edge_.push_back(k);
    }

    Cells& c_;
    std::vector<std::uint8_t> seen_;
    std::vector<std::size_t> edge_;
};

}  // namespace

void thin(Cells& cells) {
    Thinning thinning(cells);
    for (bool any = true; any;) {
        any = thinning.take(false);
        any = thinning.take(true) || any;
    }
}

}  // namespace tuft::writer
