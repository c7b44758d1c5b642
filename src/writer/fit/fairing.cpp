#include "writer/fit/fairing.h"

#include <algorithm>

namespace tuft::writer {
namespace {

/// Symmetric matrix of two bands beside its diagonal, and a right side.
struct Bands {
    std::vector<double> diagonal, first, second, right;

    explicit Bands(std::size_t n) : diagonal(n, 1), first(n, 0), second(n, 0), right(n, 0) {}

    std::vector<double> solved() {
        const std::size_t n = diagonal.size();
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t by = 1; by <= 2 && i + by < n; ++by) {
                const double part = (by == 1 ? first : second)[i] / diagonal[i];
                diagonal[i + by] -= part * (by == 1 ? first : second)[i];
                if (by == 1) first[i + 1] -= part * second[i];
                right[i + by] -= part * right[i];
            }
        for (std::size_t i = n; i-- > 0;) {
            if (i + 1 < n) right[i] -= first[i] * right[i + 1];
            if (i + 2 < n) right[i] -= second[i] * right[i + 2];
            right[i] /= diagonal[i];
        }
        return std::move(right);
    }
};

}  // namespace

std::vector<double> faired(const std::vector<double>& values, double stiffness) {
    if (values.size() < 4 || !(stiffness > 0)) return values;
    const std::size_t n = values.size() - 2;  // unknowns
    Bands bands(n);
    for (std::size_t i = 0; i < n; ++i) bands.right[i] = values[i + 1];
    constexpr double kDifference[] = {1, -2, 1};
    for (std::size_t c = 0; c < n; ++c)  // the difference about values[c + 1]
        for (std::size_t a = 0; a < 3; ++a)
            for (std::size_t b = 0; b < 3; ++b) {
                const std::size_t row = c + a, column = c + b;  // of the values
                if (row == 0 || row > n) continue;
                const double part = stiffness * kDifference[a] * kDifference[b];
                if (column == 0 || column > n)
                    bands.right[row - 1] -= part * values[column];
                else if (column >= row)
                    (column == row ? bands.diagonal : column == row + 1 ? bands.first : bands.second)[row - 1] += part;
            }
    const std::vector<double> inner = bands.solved();
    std::vector<double> out = values;
    for (std::size_t i = 0; i < n; ++i) out[i + 1] = inner[i];
    return out;
}

void make_fair(std::vector<Station>& stations, double way, double half) {
    std::vector<double> x, y, h;
    for (const Station& s : stations) x.push_back(s.centre.x), y.push_back(s.centre.y), h.push_back(s.half);
    x = faired(x, way), y = faired(y, way), h = faired(h, half);
    for (std::size_t i = 0; i < stations.size(); ++i) stations[i] = {{x[i], y[i]}, std::max(h[i], 0.0)};
}

}  // namespace tuft::writer
