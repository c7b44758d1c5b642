#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <vector>

#include "brush/rod_energy.h"

/// Inside of the rod solver: minimisation of Π for frozen friction.
namespace tuft::brush::rod {

using DenseMatrix = Eigen::MatrixXd;

/// Buffers of one thread, kept so that a warm solve allocates little.
struct Workspace {
    Evaluation at, trial;
    Shape next;
    std::vector<double> gradient, hessian, step;
    DenseMatrix matrix;
    Eigen::LLT<DenseMatrix> factor;
    Eigen::SelfAdjointEigenSolver<DenseMatrix> eigen;
};

struct NewtonResult {
    bool converged = false;
    int iterations = 0;
};

/// Descends Π from `shape` for at most `limit` iterations; Π never rises. ws.at holds the end.
NewtonResult newton(const Frozen& frozen, Shape& shape, Workspace& ws, int limit);

}  // namespace tuft::brush::rod
