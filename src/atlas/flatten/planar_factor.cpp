#include "atlas/flatten/planar_factor.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numeric>

namespace tuft::atlas {
namespace {

using Dense = Eigen::Map<Eigen::MatrixXd>;
constexpr Eigen::Index kPanel =
    24;                           // columns that are eliminated before those after them are touched
constexpr Eigen::Index kFew = 8;  // columns that are not worth packing for a product

/// Eliminates the columns of a front, of which the lower half counts: `panel` has its first
/// columns, `rest` the square below and right of them. L comes in place of the panel, 1 on its
/// diagonal left out, what is left in that of the rest.
bool eliminate(Dense& panel, Dense& rest, double* diagonal) {
    const Eigen::Index size = panel.rows(), n = panel.cols();
    for (Eigen::Index first = 0; first < n; first += kPanel) {
        const Eigen::Index past = std::min(first + kPanel, n);
        for (Eigen::Index j = first; j < past; ++j) {
            const double d = panel(j, j);
            if (d == 0 || !std::isfinite(d)) return false;
            diagonal[j] = d;
            for (Eigen::Index k = j + 1; k < past; ++k)
                if (const double l = panel(k, j) / d; l != 0)
                    panel.col(k).tail(size - k) -= l * panel.col(j).tail(size - k);
            panel.col(j).tail(size - j - 1) /= d;
        }
        if (past == n) continue;
        const auto below = panel.block(past, first, size - past, past - first);
        const Eigen::MatrixXd scaled =
            Eigen::Map<Eigen::VectorXd>(diagonal + first, past - first).asDiagonal() *
            below.topRows(n - past).transpose();
        panel.bottomRightCorner(size - past, n - past).noalias() -= below * scaled;
    }
    if (rest.size() == 0) return true;
    const auto below = panel.bottomRows(rest.rows());
    if (n <= kFew) {
        for (Eigen::Index j = 0; j < rest.cols(); ++j)
            for (Eigen::Index k = 0; k < n; ++k)
                rest.col(j).tail(rest.rows() - j) -=
                    diagonal[k] * below(j, k) * below.col(k).tail(rest.rows() - j);
        return true;
    }
    const Eigen::MatrixXd scaled = below * Eigen::Map<Eigen::VectorXd>(diagonal, n).asDiagonal();
    rest.triangularView<Eigen::Lower>() -= scaled * below.transpose();
    return true;
}

constexpr std::size_t kAtOnce = 4;  // columns

/// b += Σ l_j p_j over `columns` columns of `n` rows, `stride` apart.
void add_columns(const double* __restrict l, std::size_t stride, std::size_t columns, std::size_t n,
                 const Vec2* p, double* __restrict bx, double* __restrict by) {
    if (columns < kAtOnce) {
        for (std::size_t j = 0; j < columns; ++j)
            for (std::size_t i = 0; i < n; ++i) {
                bx[i] += l[j * stride + i] * p[j].x;
                by[i] += l[j * stride + i] * p[j].y;
            }
        return;
    }
    const Vec2 p0 = p[0], p1 = p[1], p2 = p[2], p3 = p[3];
    const double *l0 = l, *l1 = l + stride, *l2 = l1 + stride, *l3 = l2 + stride;
    for (std::size_t i = 0; i < n; ++i) {
        bx[i] += (l0[i] * p0.x + l1[i] * p1.x) + (l2[i] * p2.x + l3[i] * p3.x);
        by[i] += (l0[i] * p0.y + l1[i] * p1.y) + (l2[i] * p2.y + l3[i] * p3.y);
    }
}

/// p_j −= l_j · b over the same.
void take_columns(const double* __restrict l, std::size_t stride, std::size_t columns,
                  std::size_t n, const double* __restrict bx, const double* __restrict by,
                  Vec2* p) {
    constexpr std::size_t kLanes = 2;
    std::size_t j = 0;
    for (; j + 2 <= columns; j += 2) {
        const double *l0 = l + j * stride, *l1 = l0 + stride;
        double x0[kLanes] = {}, y0[kLanes] = {}, x1[kLanes] = {}, y1[kLanes] = {};
        std::size_t i = 0;
        for (; i + kLanes <= n; i += kLanes)
            for (std::size_t k = 0; k < kLanes; ++k) {
                x0[k] += l0[i + k] * bx[i + k];
                y0[k] += l0[i + k] * by[i + k];
                x1[k] += l1[i + k] * bx[i + k];
                y1[k] += l1[i + k] * by[i + k];
            }
        for (; i < n; ++i) {
            x0[0] += l0[i] * bx[i];
            y0[0] += l0[i] * by[i];
            x1[0] += l1[i] * bx[i];
            y1[0] += l1[i] * by[i];
        }
        p[j] -= Vec2(x0[0] + x0[1], y0[0] + y0[1]);
        p[j + 1] -= Vec2(x1[0] + x1[1], y1[0] + y1[1]);
    }
    for (; j < columns; ++j) {
        Vec2 sum(0);
        for (std::size_t i = 0; i < n; ++i) sum += l[j * stride + i] * Vec2(bx[i], by[i]);
        p[j] -= sum;
    }
}

}  // namespace

LowerMatrix::LowerMatrix(std::size_t size, std::span<const Entry> entries)
    : start(size + 1, 0), row(entries.size()), value(entries.size()) {
    for (const Entry& e : entries) ++start[e.column + 1];
    std::partial_sum(start.begin(), start.end(), start.begin());
    std::vector<std::uint32_t> next(start.begin(), start.end() - 1);
    for (const Entry& e : entries) {
        const std::uint32_t at = next[e.column]++;
        row[at] = e.row;
        value[at] = e.value;
    }
}

bool PlanarFactor::compute(const LowerMatrix& lower, const Dissection& dissection) {
    const auto& [start, row, value] = lower;
    const std::size_t n = start.size() - 1;
    const std::size_t n_nodes = dissection.nodes.size();
    blocks_.clear();
    rows_.clear();
    values_.clear();
    diagonal_.assign(n, 0);
    tallest_ = 0;
    std::vector<std::vector<double>> left(n_nodes);  // of each front, until its parent takes it
    std::vector<std::uint32_t> first_child(n_nodes, Dissection::kNoParent),
        next(n_nodes, Dissection::kNoParent);
    std::vector<std::uint32_t> place(n, 0), seen(n, Dissection::kNoParent);
    for (std::uint32_t node = 0; node < n_nodes; ++node) {
        const auto [begin, end, parent] = dissection.nodes[node];
        Block block{begin, end, rows_.size(), 0, values_.size()};
        const auto reach = [&](std::uint32_t i) {
            if (i < end || seen[i] == node) return;
            seen[i] = node;
            rows_.push_back(i);
        };
        for (std::uint32_t j = begin; j < end; ++j)
            for (std::uint32_t k = start[j]; k < start[j + 1]; ++k) reach(row[k]);
        for (std::uint32_t child = first_child[node]; child != Dissection::kNoParent;
             child = next[child])
            for (std::size_t i = 0; i < blocks_[child].n_rows; ++i)
                reach(rows_[blocks_[child].first_row + i]);
        std::sort(rows_.begin() + static_cast<std::ptrdiff_t>(block.first_row), rows_.end());
        block.n_rows = rows_.size() - block.first_row;

        const std::size_t own = end - begin, size = own + block.n_rows;
        for (std::uint32_t j = begin; j < end; ++j) place[j] = j - begin;
        for (std::size_t i = 0; i < block.n_rows; ++i)
            place[rows_[block.first_row + i]] = static_cast<std::uint32_t>(own + i);
        values_.resize(block.values + own * size);
        left[node].resize(block.n_rows * block.n_rows);
        Dense panel(values_.data() + block.values, Eigen::Index(size), Eigen::Index(own)),
            rest(left[node].data(), Eigen::Index(block.n_rows), Eigen::Index(block.n_rows));
        for (std::uint32_t j = begin; j < end; ++j)
            for (std::uint32_t k = start[j]; k < start[j + 1]; ++k)
                panel(place[row[k]], place[j]) += value[k];
        for (std::uint32_t child = first_child[node]; child != Dissection::kNoParent;
             child = next[child]) {
            const Block& from = blocks_[child];
            const std::uint32_t* at = rows_.data() + from.first_row;
            const double* value_left = left[child].data();
            for (std::size_t j = 0; j < from.n_rows; ++j, value_left += from.n_rows) {
                const std::size_t column = place[at[j]];
                double* to = column < own ? &panel(0, Eigen::Index(column))
                                          : rest.data() + (column - own) * block.n_rows;
                const std::size_t above = column < own ? 0 : own;
                for (std::size_t i = j; i < from.n_rows; ++i)
                    to[place[at[i]] - above] += value_left[i];
            }
            std::vector<double>().swap(left[child]);
        }
        if (!eliminate(panel, rest, diagonal_.data() + begin)) return false;
        if (parent != Dissection::kNoParent) {
            next[node] = first_child[parent];
            first_child[parent] = node;
        }
        blocks_.push_back(block);
        tallest_ = std::max(tallest_, block.n_rows);
    }
    return true;
}

void PlanarFactor::solve(std::span<Vec2> x) const {
    std::vector<double> below(2 * tallest_);
    double *bx = below.data(), *by = bx + tallest_;
    for (const Block& block : blocks_) {
        const std::size_t own = block.end - block.begin, n = block.n_rows, size = own + n;
        const double* l = values_.data() + block.values;
        Vec2* p = x.data() + block.begin;
        for (std::size_t j = 0; j < own; ++j)
            for (std::size_t i = j + 1; i < own; ++i) p[i] -= l[j * size + i] * p[j];
        std::fill_n(bx, n, 0.0);
        std::fill_n(by, n, 0.0);
        for (std::size_t j = 0; j < own; j += kAtOnce)
            add_columns(l + j * size + own, size, std::min(kAtOnce, own - j), n, p + j, bx, by);
        const std::uint32_t* row = rows_.data() + block.first_row;
        for (std::size_t i = 0; i < n; ++i) x[row[i]] -= Vec2(bx[i], by[i]);
    }
    for (std::size_t i = 0; i < x.size(); ++i) x[i] /= diagonal_[i];
    for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) {
        const std::size_t own = block->end - block->begin, n = block->n_rows, size = own + n;
        const double* l = values_.data() + block->values;
        Vec2* p = x.data() + block->begin;
        const std::uint32_t* row = rows_.data() + block->first_row;
        for (std::size_t i = 0; i < n; ++i) {
            bx[i] = x[row[i]].x;
            by[i] = x[row[i]].y;
        }
        for (std::size_t j = 0; j < own; j += kAtOnce)
            take_columns(l + j * size + own, size, std::min(kAtOnce, own - j), n, bx, by, p + j);
        for (std::size_t j = own; j-- > 0;)
            for (std::size_t i = j + 1; i < own; ++i) p[j] -= l[j * size + i] * p[i];
    }
}

}  // namespace tuft::atlas
