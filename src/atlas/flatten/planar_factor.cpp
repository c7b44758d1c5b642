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
        const std::size_t own = block.end - block.begin, size = own + block.n_rows;
        std::fill_n(bx, block.n_rows, 0.0);
        std::fill_n(by, block.n_rows, 0.0);
        for (std::size_t j = 0; j < own; ++j) {
            const Vec2 p = x[block.begin + j];
            const double* l = values_.data() + block.values + j * size;
            for (std::size_t i = j + 1; i < own; ++i) x[block.begin + i] -= l[i] * p;
            l += own;
            for (std::size_t i = 0; i < block.n_rows; ++i) {
                bx[i] += l[i] * p.x;
                by[i] += l[i] * p.y;
            }
        }
        for (std::size_t i = 0; i < block.n_rows; ++i)
            x[rows_[block.first_row + i]] -= Vec2(bx[i], by[i]);
    }
    for (std::size_t i = 0; i < x.size(); ++i) x[i] /= diagonal_[i];
    for (auto block = blocks_.rbegin(); block != blocks_.rend(); ++block) {
        const std::size_t own = block->end - block->begin, size = own + block->n_rows;
        for (std::size_t i = 0; i < block->n_rows; ++i) {
            const Vec2 p = x[rows_[block->first_row + i]];
            bx[i] = p.x;
            by[i] = p.y;
        }
        for (std::size_t j = own; j-- > 0;) {
            const double* l = values_.data() + block->values + j * size;
            Vec2 sum = x[block->begin + j];
            for (std::size_t i = j + 1; i < own; ++i) sum -= l[i] * x[block->begin + i];
            l += own;
            // Four sums, which a compiler may keep in vectors.
            double sx[4] = {}, sy[4] = {};
            std::size_t i = 0;
            for (; i + 4 <= block->n_rows; i += 4)
                for (std::size_t k = 0; k < 4; ++k) {
                    sx[k] += l[i + k] * bx[i + k];
                    sy[k] += l[i + k] * by[i + k];
                }
            for (; i < block->n_rows; ++i) {
                sx[0] += l[i] * bx[i];
                sy[0] += l[i] * by[i];
            }
            x[block->begin + j] =
                sum - Vec2((sx[0] + sx[1]) + (sx[2] + sx[3]), (sy[0] + sy[1]) + (sy[2] + sy[3]));
        }
    }
}

}  // namespace tuft::atlas
