#pragma once

#include <utility>

#include "io/project/project.h"
#include "sample_model.h"

/// A model and strokes as a project keeps them.
namespace tuft::io::testing {

inline ProjectModel sample_model() {
    ProjectModel model;
    model.source = "bowl.ply";
    model.frame = {.unit = "in", .y_up = true, .unit_overrides = true};
    model.mesh = cylinder();
    model.mesh.vertex_colours.assign(model.mesh.n_vertices(), {10, 20, 30, 255});
    model.atlas = cylinder_atlas(model.mesh);
    model.substrate = ink::substrate_toml(ink::load_substrate("porcelain"));
    return model;
}

inline stroke::JournalEntry sample_stroke(std::uint64_t id, int samples = 50) {
    stroke::PaintStroke s;
    s.trace.flat = id % 2 == 0;
    s.brush = "goat-medium";
    s.ink = "carbon";
    s.seed = 0xfedcba9876543210ULL + id;
    s.trace.placement.origin = {0.1, -0.0, 1e-300};
    s.trace.placement.mapping = id % 3 == 0 ? stroke::SurfaceMapping::project : stroke::SurfaceMapping::wrap;
    s.settings.spacing = 0.1 + 1.0 / 3;
    s.settings.compensate_tip_lag = false;
    for (int i = 0; i < samples; ++i) {
        const auto r = [&](int k) { return uniform(id, 100 * i + k) - 0.5; };
        s.trace.samples.push_back({.time = 0.01 * i,
                                   .position = {r(0), r(1), r(2)},
                                   .pressure = r(3),
                                   .tilt = {r(4), r(5)},
                                   .rotation = Quat(r(6), r(7), r(8), r(9))});
    }
    stroke::JournalEntry entry(s, "七 \"1\"\n");
    entry.id = id;
    entry.hidden = id % 5 == 0;
    return entry;
}

}  // namespace tuft::io::testing
