#include "brush/rod/rod.h"
#include "brush/rod/rod_solver.h"

namespace tuft::brush::rod {

Result solve(const Rod& rod, Memory& memory, const Clamp& clamp, const SolveInput& input) {
    thread_local Buffers buffers;
    buffers.before = memory.node;
    const double moved = clamp_distance(memory.clamp, clamp);
    move_with_clamp(memory, clamp);
    Solver solver{rod, memory, input.obstacles, input.walls, input.law, buffers, moved};
    solver.begin(input.load, buffers.before);
    return solver.run(input.guess);
}

Probe probe_energy(const Rod& rod, const Memory& memory, const SolveInput& input, std::span<const double> x,
                   double damping) {
    Buffers buffers;
    Workspace& ws = buffers.newton;
    Memory copy = memory;
    Solver solver{rod, copy, input.obstacles, input.walls, input.law, buffers};
    solver.begin(input.load, memory.node);
    for (std::size_t i = 0; i < solver.fine.size() && i < memory.contact.size(); ++i) {
        solver.lagged.normal[i] = memory.contact[i].force;
        if (memory.contact[i].force > 0) {
            solver.lagged.anchor[i] = memory.contact[i].anchor;
            solver.lagged.anchored[i] = 1;
        }
    }
    solver.freeze_friction(copy.node, solver.shape.tangent);
    Shape moved;
    advance(solver.shape, x, 1, moved);
    Probe probe;
    evaluate(solver.frozen, moved, ws.at);
    probe.value = ws.at.value;
    differentiate(solver.frozen, moved, ws.at, ws.derivatives);
    differentiate_twice(solver.frozen, moved, ws.at, ws.derivatives);
    probe.gradient = ws.derivatives.gradient;
    const QuadraticModel model{rod, moved, ws.at, ws.derivatives};
    fill_hessian(model, probe.hessian);
    if (!descend(model, damping, ws.elimination, probe.step)) probe.step.clear();
    return probe;
}

}  // namespace tuft::brush::rod
