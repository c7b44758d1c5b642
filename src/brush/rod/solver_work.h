#pragma once

/// \file
/// Work of the rod solver in counts, which are the same on every machine. `step` sums them over all parts of a motion.
namespace tuft::brush {

struct SolverWork {
    int solves = 0;       ///< poses at which a rod, or a row of rods, was solved
    int passes = 0;       ///< of the fixed point over the forces of friction
    int iterations = 0;   ///< of Newton's method; a step by eigenvectors counts for twelve
    int evaluations = 0;  ///< of the potential Π with its derivatives
    int values = 0;       ///< of Π alone

    SolverWork& operator+=(const SolverWork& other) {
        solves += other.solves;
        passes += other.passes;
        iterations += other.iterations;
        evaluations += other.evaluations;
        values += other.values;
        return *this;
    }
};

}  // namespace tuft::brush
