#pragma once

#include <Eigen/Eigenvalues>
#include <vector>

#include "brush/rod/rod_energy.h"

/// \file
/// Newton minimisation of Π for frozen friction. Internal to the rod solver.
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

/// Minimises Π from `shape` in at most `limit` iterations; ws.at holds the evaluation of `shape`. Π never
/// increases. On return ws.at holds the evaluation of the result.
NewtonResult newton(const Frozen& frozen, Shape& shape, Workspace& ws, int limit);

}  // namespace tuft::brush::rod
