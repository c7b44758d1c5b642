#include "atlas/flatten/ldlt.h"

#include <array>
#include <cmath>

namespace tuft::atlas {
namespace {

constexpr int kColumnsAtOnce = 16;  // of a chain applied together
constexpr int kRowsAtOnce = 8;      // of them at a time

/// Columns of L with the same rows from some row on, and their numbers in the row being solved.
struct Columns {
    std::array<const double*, kColumnsAtOnce> values;
    std::array<double, kColumnsAtOnce> factors;
    int n = 0;
};

/// y[row[p]] −= Σ values[c][p] factors[c], column after column for each row.
void subtract_columns(const Columns& columns, const int* row, int n_rows, double* y) {
    int p = 0;
    for (; p + kRowsAtOnce <= n_rows; p += kRowsAtOnce) {
        std::array<double, kRowsAtOnce> sum;
        for (int r = 0; r < kRowsAtOnce; ++r) sum[r] = y[row[p + r]];
        for (int c = 0; c < columns.n; ++c) {
            const double* value = columns.values[c] + p;
            const double factor = columns.factors[c];
            for (int r = 0; r < kRowsAtOnce; ++r) sum[r] -= value[r] * factor;
        }
        for (int r = 0; r < kRowsAtOnce; ++r) y[row[p + r]] = sum[r];
    }
    for (; p < n_rows; ++p) {
        double sum = y[row[p]];
        for (int c = 0; c < columns.n; ++c) sum -= columns.values[c][p] * columns.factors[c];
        y[row[p]] = sum;
    }
}

}  // namespace

bool LdltFactor::compute(const Matrix& lower) {
    Matrix buffer(lower.rows(), lower.cols());
    const Matrix* upper = nullptr;
    ordering(lower, upper, buffer);
    analyzePattern_preordered(*upper, true);
    return factorise(*upper);
}

// Columns of row k of L in topological order, at the end of `pattern_` from the index returned on; puts the row of the
// matrix into `row_`.
int LdltFactor::find_pattern(const Matrix& upper, int k) {
    const int n = static_cast<int>(upper.rows());
    int top = n;
    row_[k] = 0;
    met_[k] = k;
    for (Matrix::InnerIterator entry(upper, k); entry; ++entry) {
        int i = static_cast<int>(entry.index());
        if (i > k) continue;
        row_[i] += entry.value();
        int length = 0;
        for (; met_[i] != k; i = m_parent[i]) {
            pattern_[length++] = i;
            met_[i] = k;
        }
        while (length > 0) pattern_[--top] = pattern_[--length];
    }
    return top;
}

// Number of columns from pattern_[top] on that are each other's parents and have the same rows below.
int LdltFactor::chain_length(int top) const {
    const int* start = m_matrix.outerIndexPtr();
    const int most = std::min(kColumnsAtOnce, static_cast<int>(pattern_.size()) - top);
    int length = 1;
    for (int i = pattern_[top]; length < most; ++length) {
        const int next = pattern_[top + length];
        if (m_parent[i] != next || start[i + 1] - start[i] != start[next + 1] - start[next] + 1) break;
        i = next;
    }
    return length;
}

// Solves for the entries of row k in some columns with the same rows, and takes them out of the rest of the row and of
// its pivot d.
double LdltFactor::apply_chain(int k, int top, int length, double d) {
    const int* start = m_matrix.outerIndexPtr();
    int* rows = m_matrix.innerIndexPtr();
    double* values = m_matrix.valuePtr();
    double* const y = row_.data();
    const int* const chain = pattern_.data() + top;
    Columns columns{.values = {}, .factors = {}, .n = length};
    for (int c = 0; c < length; ++c) {
        const int i = chain[c];
        const double value = columns.factors[c] = y[i];
        y[i] = 0;
        // Its first rows are those of the chain's columns after it.
        for (int next = c + 1; next < length; ++next) y[chain[next]] -= values[start[i] + next - c - 1] * value;
        columns.values[c] = values + start[i] + (length - 1 - c);
    }
    const int last = chain[length - 1];
    subtract_columns(columns, rows + start[last], m_nonZerosPerCol[last], y);
    for (int c = 0; c < length; ++c) {
        const int i = chain[c];
        const double value = columns.factors[c], entry = value / m_diag[i];
        d -= entry * value;
        const int end = start[i] + m_nonZerosPerCol[i]++;
        rows[end] = k;
        values[end] = entry;
    }
    return d;
}

// Row by row (up-looking; Davis 2005), as Eigen does.
bool LdltFactor::factorise(const Matrix& upper) {
    const int n = static_cast<int>(upper.rows());
    m_diag.resize(n);
    row_.assign(static_cast<std::size_t>(n), 0);
    pattern_.assign(static_cast<std::size_t>(n), 0);
    met_.assign(static_cast<std::size_t>(n), 0);
    for (int k = 0; k < n; ++k) {
        m_nonZerosPerCol[k] = 0;
        int top = find_pattern(upper, k);
        double d = row_[k];
        row_[k] = 0;
        while (top < n) {
            const int length = chain_length(top);
            d = apply_chain(k, top, length, d);
            top += length;
        }
        m_diag[k] = d;
        if (d == 0 || !std::isfinite(d)) return false;
    }
    return true;
}

void LdltFactor::solve(std::span<Vec2> x) {
    const int n = static_cast<int>(x.size());
    const int *start = m_matrix.outerIndexPtr(), *row = m_matrix.innerIndexPtr();
    const double* value = m_matrix.valuePtr();
    const int* place = m_P.indices().data();
    permuted_.resize(x.size());
    Vec2* const y = permuted_.data();
    for (int i = 0; i < n; ++i) y[place[i]] = x[i];
    for (int j = 0; j < n; ++j) {
        const Vec2 known = y[j];
        for (int k = start[j]; k < start[j + 1]; ++k) y[row[k]] -= known * value[k];
    }
    for (int i = 0; i < n; ++i) y[i] *= 1 / m_diag[i];
    for (int j = n - 1; j >= 0; --j) {
        Vec2 sum = y[j];
        for (int k = start[j]; k < start[j + 1]; ++k) sum -= value[k] * y[row[k]];
        y[j] = sum;
    }
    for (int i = 0; i < n; ++i) x[i] = y[place[i]];
}

}  // namespace tuft::atlas
