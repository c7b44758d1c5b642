#pragma once

#include <memory>

#include "haptic/trial.h"
#include "io/model/read_model.h"
#include "mesh/repair/repair.h"
#include "paths.h"

/// \file
/// Models that the tests of `haptic` touch.
namespace tuft::haptic {

struct TrialModel {
    std::unique_ptr<mesh::TriangleMesh> mesh;
    std::unique_ptr<mesh::SurfaceQuery> surface;
    TrialPlace place;
};

/// A place of a shipped model: "sheet", "bowl", "rim", "roof", "edge" of the car, "plate".
inline TrialModel load_trial_model(const std::string& name) {
    const bool edge = name == "rim" || name == "edge" || name == "plate";
    const std::string file = name == "rim" ? "bowl" : name == "roof" || name == "edge" ? "car" : name;
    TrialModel f;
    const std::string path = source_folder() + "/models/" + file + ".ply";
    mesh::RepairOptions options;
    f.mesh = std::make_unique<mesh::TriangleMesh>(mesh::build_surface(io::read_model(path), options).mesh);
    f.surface = std::make_unique<mesh::SurfaceQuery>(*f.mesh);
    f.place = edge ? place_at_edge(*f.surface, name) : place_above(*f.surface, name);
    return f;
}

inline brush::Tuft tuft_of(const std::string& name) {
    return brush::make_tuft(brush::load_preset(name), 1);
}

}  // namespace tuft::haptic
