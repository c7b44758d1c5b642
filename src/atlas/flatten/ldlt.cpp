#include "atlas/flatten/ldlt.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include "atlas/flatten/dissection.h"
#include "core/simd.h"
#include "core/system/memory.h"
#include "core/system/parallel.h"

namespace tuft::atlas {
namespace {

constexpr std::uint32_t kLanes = 4;           // rows that are computed together
constexpr std::uint32_t kPanel = 32;          // pivots that are applied together to the columns after them
constexpr std::uint32_t kTogether = 8;        // of these columns at a time
constexpr std::size_t kManyValues = 1 << 18;  // numbers of L of which subtrees go to other threads

/// The numbers of kLanes rows, anywhere in memory.
using Lanes [[gnu::vector_size(kLanes * sizeof(double)), gnu::aligned(sizeof(double)), gnu::may_alias]] = double;

[[gnu::always_inline]] inline Lanes& lanes(double* at) {
    return *reinterpret_cast<Lanes*>(at);
}
[[gnu::always_inline]] inline const Lanes& lanes(const double* at) {
    return *reinterpret_cast<const Lanes*>(at);
}

constexpr std::uint32_t rounded_up(std::uint32_t n) {
    return (n + kLanes - 1) / kLanes * kLanes;
}

Neighbours neighbours_of(const SymmetricMatrix& matrix) {
    Neighbours graph;
    graph.start.assign(matrix.diagonal.size() + 1, 0);
    for (const SymmetricMatrix::Entry& e : matrix.entries) {
        ++graph.start[e.row + 1];
        ++graph.start[e.column + 1];
    }
    for (std::size_t i = 0; i + 1 < graph.start.size(); ++i) graph.start[i + 1] += graph.start[i];
    graph.neighbours.resize(2 * matrix.entries.size());
    std::vector<std::uint32_t> end(graph.start.begin(), graph.start.end() - 1);
    for (const SymmetricMatrix::Entry& e : matrix.entries) {
        graph.neighbours[end[e.row]++] = e.column;
        graph.neighbours[end[e.column]++] = e.row;
    }
    // Entries at one place are one neighbour.
    std::vector<std::uint32_t> neighbour_of(end.size(), ~0u);  // the last row that has this one
    std::uint32_t at = 0;
    for (std::uint32_t i = 0; i < end.size(); ++i) {
        const std::uint32_t from = std::exchange(graph.start[i], at);
        for (std::uint32_t k = from; k < end[i]; ++k) {
            const std::uint32_t v = graph.neighbours[k];
            if (std::exchange(neighbour_of[v], i) != i) graph.neighbours[at++] = v;
        }
    }
    graph.start.back() = at;
    graph.neighbours.resize(at);
    return graph;
}

/// Eliminates one pivot after the other from the columns of a panel, [begin, end), of a front. What is stored of a
/// column afterwards is L's.
[[gnu::always_inline]] inline bool eliminate_panel(double* f, std::uint32_t stride, std::uint32_t begin,
                                                   std::uint32_t end, double* inverse, double* pivots) {
    std::array<double, kPanel> factor;
    for (std::uint32_t j = begin; j < end; ++j) {
        double* const column = f + std::size_t{j} * stride;
        const double pivot = column[j];
        if (pivot == 0 || !std::isfinite(pivot)) return false;
        pivots[j - begin] = pivot;
        inverse[j] = 1 / pivot;
        for (std::uint32_t c = j + 1; c < end; ++c) factor[c - begin] = column[c];
        std::fill_n(column, j + 1, 0);
        const std::uint32_t from = j / kLanes * kLanes;
        for (std::uint32_t i = from; i < stride; i += kLanes) lanes(column + i) *= inverse[j];
        for (std::uint32_t c = j + 1; c < end; ++c) {
            double* const other = f + std::size_t{c} * stride;
            for (std::uint32_t i = from; i < stride; i += kLanes)
                lanes(other + i) -= lanes(column + i) * factor[c - begin];
        }
    }
    return true;
}

/// other[c][i] −= Σ_p column[p][i] weight[c][p] for n columns from row `from` on, a multiple of kLanes.
template <std::uint32_t n>
[[gnu::always_inline]] inline void subtract_panel(const double* columns, std::uint32_t n_columns, const double* weights,
                                                  double* others, std::size_t stride, std::uint32_t from) {
    for (std::uint32_t i = from; i < stride; i += kLanes) {
        Lanes sum[n];
        for (std::uint32_t c = 0; c < n; ++c) sum[c] = lanes(others + c * stride + i);
        for (std::uint32_t p = 0; p < n_columns; ++p) {
            const Lanes column = lanes(columns + p * stride + i);
            for (std::uint32_t c = 0; c < n; ++c) sum[c] -= column * weights[c * kPanel + p];
        }
        for (std::uint32_t c = 0; c < n; ++c) lanes(others + c * stride + i) = sum[c];
    }
}

/// Eliminates the pivots of a front with n rows, of which the lower half is given, from all its columns.
TUFT_CLONES bool eliminate(double* f, std::uint32_t stride, std::uint32_t n, std::uint32_t n_pivots, double* inverse) {
    std::array<double, kPanel> pivots;
    std::array<double, kTogether * kPanel> weights;
    for (std::uint32_t begin = 0; begin < n_pivots; begin += kPanel) {
        const std::uint32_t end = std::min(begin + kPanel, n_pivots);
        if (!eliminate_panel(f, stride, begin, end, inverse, pivots.data())) return false;
        const double* const columns = f + std::size_t{begin} * stride;
        for (std::uint32_t c = end; c < n; c += kTogether) {
            const std::uint32_t m = std::min(kTogether, n - c);
            for (std::uint32_t k = 0; k < m; ++k)
                for (std::uint32_t p = begin; p < end; ++p)
                    weights[k * kPanel + p - begin] = f[std::size_t{p} * stride + c + k] * pivots[p - begin];
            double* const others = f + std::size_t{c} * stride;
            const std::uint32_t from = c / kLanes * kLanes;
            if (m == kTogether)
                subtract_panel<kTogether>(columns, end - begin, weights.data(), others, stride, from);
            else
                for (std::uint32_t k = 0; k < m; ++k)
                    subtract_panel<1>(columns, end - begin, weights.data() + k * kPanel,
                                      others + std::size_t{k} * stride, stride, from);
        }
    }
    return true;
}

/// Takes what is known of the first rows out of those below them.
TUFT_CLONES void substitute_down(const double* column, std::size_t stride, std::uint32_t n_columns, double* x,
                                 double* y) {
    for (std::uint32_t j = 0; j < n_columns; ++j, column += stride) {
        const double xj = x[j], yj = y[j];
        for (std::size_t i = j / kLanes * kLanes; i < stride; i += kLanes) {
            lanes(x + i) -= lanes(column + i) * xj;
            lanes(y + i) -= lanes(column + i) * yj;
        }
    }
}

[[gnu::always_inline]] inline double sum_of(const Lanes& v) {
    return (v[0] + v[2]) + (v[1] + v[3]);
}

/// Takes what is known of the last rows out of the first ones.
TUFT_CLONES void substitute_up(const double* columns, std::size_t stride, std::uint32_t n_columns, double* x,
                               double* y) {
    for (std::uint32_t j = n_columns; j-- > 0;) {
        const double* const column = columns + j * stride;
        Lanes xs{}, ys{};
        for (std::size_t i = j / kLanes * kLanes; i < stride; i += kLanes) {
            xs += lanes(column + i) * lanes(x + i);
            ys += lanes(column + i) * lanes(y + i);
        }
        x[j] -= sum_of(xs);
        y[j] -= sum_of(ys);
    }
}

}  // namespace

/// The matrix in the order of elimination: of each row the entries in later columns.
struct LdltFactor::Rows {
    std::vector<double> diagonal;
    std::vector<std::size_t> start;
    std::vector<std::uint32_t> column;
    std::vector<double> value;

    /// `graph`: of the matrix. Entries at one place are one.
    Rows(const SymmetricMatrix& matrix, const Neighbours& graph, const std::vector<std::uint32_t>& place)
        : diagonal(place.size()), start(place.size() + 1, 0) {
        const auto for_each_later = [&](std::size_t v, auto&& f) {
            for (std::uint32_t i = graph.start[v]; i < graph.start[v + 1]; ++i)
                if (const std::uint32_t other = place[graph.neighbours[i]]; other > place[v]) f(other);
        };
        for (std::size_t v = 0; v < place.size(); ++v) {
            diagonal[place[v]] = matrix.diagonal[v];
            for_each_later(v, [&](std::uint32_t) { ++start[place[v] + 1]; });
        }
        for (std::size_t i = 0; i < place.size(); ++i) start[i + 1] += start[i];
        column.resize(start.back());
        value.resize(start.back(), 0);
        for (std::size_t v = 0; v < place.size(); ++v) {
            std::size_t at = start[place[v]];
            for_each_later(v, [&](std::uint32_t other) { column[at++] = other; });
        }
        for (const SymmetricMatrix::Entry& e : matrix.entries) {
            const auto [row, later] = std::minmax(place[e.row], place[e.column]);
            std::size_t at = start[row];
            while (column[at] != later) ++at;
            value[at] += e.value;
        }
    }
};

/// What fronts leave of the columns beyond their pivots, until their parents take it. One for each thread.
struct LdltFactor::Stack {
    std::vector<double> values;           ///< of each the lower half of a square, column by column
    std::vector<std::uint32_t> fronts;    ///< whose they are
    std::vector<std::uint32_t> in_front;  ///< of each row of L: its row in the front being assembled
    std::vector<double> dense;            ///< the front being factored, column by column

    explicit Stack(std::size_t n_rows) : in_front(n_rows) {}
};

void LdltFactor::find_fronts(const Rows& rows) {
    beyond_.clear();
    std::vector<std::uint32_t> met(place_.size(), 0), roots;
    std::size_t size = 0;
    for (std::uint32_t s = 0; s < fronts_.size(); ++s) {
        Front& front = fronts_[s];
        const std::uint32_t last = front.first + front.n_pivots;
        front.beyond = beyond_.size();
        const auto meet = [&](std::uint32_t row) {
            if (row < last || std::exchange(met[row], s + 1) == s + 1) return;
            beyond_.push_back(row);
        };
        for (std::size_t i = rows.start[front.first]; i < rows.start[last]; ++i) meet(rows.column[i]);
        front.subtree = s;
        for (std::uint32_t c = 0; c < front.n_children; ++c) {
            const Front& child = fronts_[roots.back()];
            front.subtree = child.subtree;
            roots.pop_back();
            for (std::size_t i = 0; i < child.n_beyond; ++i) meet(beyond_[child.beyond + i]);
        }
        roots.push_back(s);
        std::sort(beyond_.begin() + static_cast<std::ptrdiff_t>(front.beyond), beyond_.end());
        front.n_beyond = static_cast<std::uint32_t>(beyond_.size() - front.beyond);
        front.stride = rounded_up(front.n_pivots + front.n_beyond);
        front.values = size;
        size += std::size_t{front.n_pivots} * front.stride;
    }
    n_values_used_ = size;
    find_subtrees();
    if (size > n_values_) {
        values_ = std::make_unique_for_overwrite<double[]>(n_values_ = size);
        prefer_large_pages(values_.get(), sizeof(double) * size);
    }
}

/// Numbers of L that fronts `first` to `last` − 1 have.
std::size_t LdltFactor::n_values(std::uint32_t first, std::uint32_t last) const {
    const auto begins_at = [&](std::uint32_t s) { return s < fronts_.size() ? fronts_[s].values : n_values_used_; };
    return begins_at(last) - begins_at(first);
}

/// The largest subtrees of up to an eighth of L, none where L is small.
void LdltFactor::find_subtrees() {
    largest_stride_ = 0;
    for (const Front& front : fronts_) largest_stride_ = std::max(largest_stride_, front.stride);
    subtrees_.clear();
    if (n_values_used_ < kManyValues) return;
    for (auto end = static_cast<std::uint32_t>(fronts_.size()); end > 0;) {
        const std::uint32_t first = fronts_[end - 1].subtree;
        const bool small = 8 * n_values(first, end) <= n_values_used_;
        if (small && 64 * n_values(first, end) >= n_values_used_) subtrees_.push_back(end - 1);
        end = small ? first : end - 1;
    }
    std::reverse(subtrees_.begin(), subtrees_.end());
}

/// Makes the lower half of the front from the matrix and what its children left.
void LdltFactor::assemble(const Rows& rows, const Front& front, Stack& stack) {
    const std::size_t stride = front.stride;
    stack.dense.assign(stride * (front.n_pivots + front.n_beyond), 0);
    for (std::uint32_t i = 0; i < front.n_pivots; ++i) stack.in_front[front.first + i] = i;
    for (std::uint32_t i = 0; i < front.n_beyond; ++i) stack.in_front[beyond_[front.beyond + i]] = front.n_pivots + i;
    for (std::uint32_t j = 0; j < front.n_pivots; ++j) {
        double* const column = stack.dense.data() + j * stride;
        column[j] = rows.diagonal[front.first + j];
        for (std::size_t i = rows.start[front.first + j]; i < rows.start[front.first + j + 1]; ++i)
            column[stack.in_front[rows.column[i]]] += rows.value[i];
    }
    for (std::uint32_t c = 0; c < front.n_children; ++c) {
        const Front& child = fronts_[stack.fronts.back()];
        stack.fronts.pop_back();
        const std::size_t n = child.n_beyond, n_left = n * (n + 1) / 2;
        const std::uint32_t* const row = beyond_.data() + child.beyond;
        const double* left = stack.values.data() + stack.values.size() - n_left;
        for (std::size_t j = 0; j < n; ++j) {
            double* const column = stack.dense.data() + stack.in_front[row[j]] * stride;
            for (std::size_t i = j; i < n; ++i) column[stack.in_front[row[i]]] += *left++;
        }
        stack.values.resize(stack.values.size() - n_left);
    }
}

/// Factors one after the other all fronts of whole subtrees, or one whose children are on the stack.
bool LdltFactor::factor_in_turn(const Rows& rows, std::uint32_t first, std::uint32_t last, Stack& stack) {
    for (std::uint32_t s = first; s < last; ++s) {
        const Front& front = fronts_[s];
        const std::uint32_t size = front.n_pivots + front.n_beyond;
        assemble(rows, front, stack);
        double* const dense = stack.dense.data();
        if (!eliminate(dense, front.stride, size, front.n_pivots, inverse_.data() + front.first)) return false;
        std::memcpy(values_.get() + front.values, dense, sizeof(double) * front.n_pivots * std::size_t{front.stride});
        for (std::uint32_t c = front.n_pivots; c < size; ++c) {
            const double* const column = dense + c * std::size_t{front.stride};
            stack.values.insert(stack.values.end(), column + c, column + size);
        }
        stack.fronts.push_back(s);
    }
    return true;
}

/// Factors the fronts `first` to `last` − 1, whole subtrees, the large ones at the same time, and leaves on the stack
/// what their roots leave.
bool LdltFactor::factor(const Rows& rows, std::uint32_t first, std::uint32_t last, Stack& stack) {
    if (n_values(first, last) < kManyValues) return factor_in_turn(rows, first, last, stack);
    std::vector<std::uint32_t> roots;
    for (std::uint32_t end = last; end > first; end = fronts_[end - 1].subtree) roots.push_back(end - 1);
    std::reverse(roots.begin(), roots.end());
    if (roots.size() == 1) return factor(rows, first, last - 1, stack) && factor_in_turn(rows, last - 1, last, stack);
    std::vector<Stack> parts(roots.size(), Stack(0));
    std::vector<std::uint8_t> done(roots.size(), 0);
    parallel_for(roots.size(), 1, [&](std::size_t k, std::size_t end) {
        for (; k < end; ++k) {
            parts[k].in_front.resize(place_.size());
            done[k] = factor(rows, fronts_[roots[k]].subtree, roots[k] + 1, parts[k]);
            parts[k].in_front = {};
            parts[k].dense = {};
        }
    });
    for (Stack& part : parts) {
        if (stack.values.empty())
            stack.values = std::move(part.values);
        else
            stack.values.insert(stack.values.end(), part.values.begin(), part.values.end());
        part.values = {};
        stack.fronts.insert(stack.fronts.end(), part.fronts.begin(), part.fronts.end());
    }
    return std::find(done.begin(), done.end(), 0) == done.end();
}

bool LdltFactor::compute(SymmetricMatrix matrix, std::span<const Vec2> at) {
    const std::size_t n = matrix.diagonal.size();
    Neighbours graph = neighbours_of(matrix);
    {
        const Dissection dissection = dissect(graph, at);
        place_.resize(n);
        for (std::uint32_t i = 0; i < n; ++i) place_[dissection.order[i]] = i;
        fronts_.clear();
        fronts_.reserve(dissection.parts.size());
        for (const Dissection::Part& part : dissection.parts)
            fronts_.push_back({.first = part.first, .n_pivots = part.n, .n_children = part.n_children});
    }
    const Rows rows(matrix, graph, place_);
    matrix = {};
    graph = {};
    find_fronts(rows);
    inverse_.resize(n);
    Stack stack(n);
    return factor(rows, 0, static_cast<std::uint32_t>(fronts_.size()), stack);
}

/// Eliminates the rows of fronts `first` to `last` − 1 from the right hand sides of later ones. What goes to rows from
/// `end_row` on, which others change at the same time, is `passed` on.
void LdltFactor::solve_down(std::uint32_t first, std::uint32_t last, std::uint32_t end_row,
                            std::vector<RowUpdate>& passed) {
    std::vector<double> x(largest_stride_), y(largest_stride_);
    for (std::uint32_t s = first; s < last; ++s) {
        const Front& front = fronts_[s];
        std::fill_n(x.begin(), front.stride, 0);
        std::fill_n(y.begin(), front.stride, 0);
        std::copy_n(x_.begin() + front.first, front.n_pivots, x.begin());
        std::copy_n(y_.begin() + front.first, front.n_pivots, y.begin());
        substitute_down(values_.get() + front.values, front.stride, front.n_pivots, x.data(), y.data());
        for (std::uint32_t i = 0; i < front.n_pivots; ++i) {
            x_[front.first + i] = x[i] * inverse_[front.first + i];
            y_[front.first + i] = y[i] * inverse_[front.first + i];
        }
        for (std::uint32_t i = 0; i < front.n_beyond; ++i) {
            const std::uint32_t row = beyond_[front.beyond + i];
            if (row >= end_row) {
                passed.push_back({x[front.n_pivots + i], y[front.n_pivots + i], row});
                continue;
            }
            x_[row] += x[front.n_pivots + i];
            y_[row] += y[front.n_pivots + i];
        }
    }
}

/// Solves the rows of fronts `first` to `last` − 1, those of all later ones being solved.
void LdltFactor::solve_up(std::uint32_t first, std::uint32_t last) {
    std::vector<double> x(largest_stride_), y(largest_stride_);
    for (std::uint32_t s = last; s-- > first;) {
        const Front& front = fronts_[s];
        std::fill_n(x.begin(), front.stride, 0);
        std::fill_n(y.begin(), front.stride, 0);
        std::copy_n(x_.begin() + front.first, front.n_pivots, x.begin());
        std::copy_n(y_.begin() + front.first, front.n_pivots, y.begin());
        for (std::uint32_t i = 0; i < front.n_beyond; ++i) {
            const std::uint32_t row = beyond_[front.beyond + i];
            x[front.n_pivots + i] = x_[row];
            y[front.n_pivots + i] = y_[row];
        }
        substitute_up(values_.get() + front.values, front.stride, front.n_pivots, x.data(), y.data());
        std::copy_n(x.begin(), front.n_pivots, x_.begin() + front.first);
        std::copy_n(y.begin(), front.n_pivots, y_.begin() + front.first);
    }
}

void LdltFactor::solve(std::span<Vec2> x) {
    x_.resize(x.size());
    y_.resize(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) {
        x_[place_[i]] = x[i].x;
        y_[place_[i]] = x[i].y;
    }
    const auto n_fronts = static_cast<std::uint32_t>(fronts_.size());
    const auto n_rows = static_cast<std::uint32_t>(x.size());
    const auto subtree_of = [&](std::size_t k) { return fronts_[subtrees_[k]].subtree; };
    passed_.resize(subtrees_.size() + 1);
    parallel_for(subtrees_.size(), 1, [&](std::size_t k, std::size_t end) {
        for (; k < end; ++k) {
            const Front& root = fronts_[subtrees_[k]];
            passed_[k].clear();
            solve_down(root.subtree, subtrees_[k] + 1, root.first + root.n_pivots, passed_[k]);
        }
    });
    // The same sums in the same order as one thread would make them.
    std::uint32_t next = 0;
    for (std::size_t k = 0; k < subtrees_.size(); ++k) {
        solve_down(next, subtree_of(k), n_rows, passed_.back());
        for (const RowUpdate& p : passed_[k]) {
            x_[p.row] += p.x;
            y_[p.row] += p.y;
        }
        next = subtrees_[k] + 1;
    }
    solve_down(next, n_fronts, n_rows, passed_.back());
    for (std::size_t k = subtrees_.size() + 1, last = n_fronts; k-- > 0;) {
        solve_up(k > 0 ? subtrees_[k - 1] + 1 : 0, static_cast<std::uint32_t>(last));
        if (k > 0) last = subtree_of(k - 1);
    }
    parallel_for(subtrees_.size(), 1, [&](std::size_t k, std::size_t end) {
        for (; k < end; ++k) solve_up(subtree_of(k), subtrees_[k] + 1);
    });
    for (std::size_t i = 0; i < x.size(); ++i) x[i] = {x_[place_[i]], y_[place_[i]]};
}

}  // namespace tuft::atlas
