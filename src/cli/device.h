#pragma once

#include <memory>
#include <string>

#include "cli/arguments.h"
#include "haptic/device.h"
#include "haptic/trial.h"

/// \file
/// What the commands of `tuft device` share. Main thread.
namespace tuft::cli {

/// A model that the simulated or real arm touches.
struct ContactModel {
    std::unique_ptr<mesh::TriangleMesh> mesh;
    std::unique_ptr<mesh::SurfaceQuery> surface;
};
/// Reads a model; `file` may be the name of a shipped one, such as "bowl".
ContactModel load_contact_model(const std::filesystem::path& file);

haptic::HandMotion motion_named(const std::string& name);

/// The arm of the arguments, simulated with `path` or real. Throws `Error` where no service answers within 3 s; then
/// `state` is its first state.
std::unique_ptr<haptic::Device> open_device(const DeviceWork& arguments, const haptic::HandPath& path,
                                            haptic::DeviceState& state);

/// The workspace in which the arm at `device` holds the brush's root at `root`.
haptic::Workspace workspace_at(const haptic::DeviceState& state, const Vec3& root);

int test_device(const DeviceWork& arguments);

}  // namespace tuft::cli
