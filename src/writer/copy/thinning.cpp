#include "writer/copy/thinning.h"

#include <algorithm>

namespace tuft::writer {
namespace {

/// One of the two passes. Returns whether a cell was taken.
bool thin_once(Cells& c, bool odd) {
    std::vector<std::size_t> taken;
    for (int j = 0; j < c.height; ++j)
        for (int i = 0; i < c.width; ++i) {
            if (!c.at(i, j)) continue;
            // Anticlockwise from above.
            const int p2 = c.at(i, j + 1), p3 = c.at(i + 1, j + 1), p4 = c.at(i + 1, j), p5 = c.at(i + 1, j - 1),
                      p6 = c.at(i, j - 1), p7 = c.at(i - 1, j - 1), p8 = c.at(i - 1, j), p9 = c.at(i - 1, j + 1);
            const int crossings = (!p2 && (p3 || p4)) + (!p4 && (p5 || p6)) + (!p6 && (p7 || p8)) + (!p8 && (p9 || p2));
            if (crossings != 1) continue;
            const int a = (p9 || p2) + (p3 || p4) + (p5 || p6) + (p7 || p8),
                      b = (p2 || p3) + (p4 || p5) + (p6 || p7) + (p8 || p9), n = std::min(a, b);
            if (n < 2 || n > 3) continue;
            const bool keep = odd ? ((p6 || p7 || !p9) && p8) : ((p2 || p3 || !p5) && p4);
            if (!keep) taken.push_back(std::size_t(j) * c.width + i);
        }
    for (const std::size_t k : taken) c.inside[k] = 0;
    return !taken.empty();
}

}  // namespace

void thin(Cells& cells) {
    for (bool any = true; any;) {
        any = thin_once(cells, false);
        any = thin_once(cells, true) || any;
    }
}

}  // namespace tuft::writer
