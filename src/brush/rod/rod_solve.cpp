#include "brush/rod/rod.h"
#include "brush/rod/rod_solver.h"

namespace tuft::brush::rod {

Result solve(const Rod& rod, Memory& memory, const Clamp& clamp, std::span<const Obstacle> obstacles, const Law& law,
             const Load& load, std::span<const Wall> walls) {
    thread_local Buffers buffers;
    buffers.before = memory.node;
    const double moved = clamp_distance(memory.clamp, clamp);
    carry_with_clamp(memory, clamp);
    Solver solver{rod, memory, obstacles, walls, law, buffers, moved};
    solver.begin(load, buffers.before);
    return solver.run();
}

Probe probe_energy(const Rod& rod, const Memory& memory, std::span<const Obstacle> obstacles, const Law& law,
                   const Load& load, std::span<const double> x, double damping) {
    Buffers buffers;
    Workspace& ws = buffers.newton;
    Memory copy = memory;
    Solver solver{rod, copy, obstacles, {}, law, buffers};
    solver.begin(load, memory.node);
    for (std::size_t i = 0; i < solver.fine.size() && i < memory.contact.size(); ++i) {
        solver.normal[i] = memory.contact[i].force;
        if (memory.contact[i].force > 0) {
            solver.anchor[i] = memory.contact[i].anchor;
            solver.anchored[i] = 1;
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
    fill_hessian(rod, moved, ws.at, ws.derivatives, probe.hessian);
    if (!descend(rod, moved, ws.at, ws.derivatives, damping, ws.elimination, probe.step)) probe.step.clear();
    return probe;
}

}  // namespace tuft::brush::rod
