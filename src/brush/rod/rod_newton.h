#pragma once

#include <Eigen/Eigenvalues>
#include <vector>

#include "brush/rod/rod_energy.h"

/// Inside of the rod solver: minimisation of Π for frozen friction.
namespace tuft::brush::rod {

using DenseMatrix = Eigen::MatrixXd;

/// Buffers of the minimisation.
struct Workspace {
    Evaluation at, trial;
    Shape next;
    std::vector<Vec3> ahead;  ///< nodes for which friction is frozen
    Derivatives derivatives;
    Elimination elimination;
    std::vector<double> hessian, step;
    DenseMatrix matrix;
    Eigen::SelfAdjointEigenSolver<DenseMatrix> eigen;
};

struct NewtonResult {
    bool converged = false;
    int iterations = 0;
};

/// Descends Π from `shape`, of which ws.at is the evaluation, for at most `limit` iterations; Π never
/// rises. ws.at holds the end.
NewtonResult newton(const Frozen& frozen, Shape& shape, Workspace& ws, int limit);

}  // namespace tuft::brush::rod
