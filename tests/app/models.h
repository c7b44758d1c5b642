#pragma once

#include "io/model/read_model.h"
#include "paths.h"
#include "stroke/document/document.h"

namespace tuft::test {

/// A shipped model, unwrapped into `size` texels per side; from the cache that the programs use where it is there.
/// The file of a shipped model, or the path itself.
inline std::filesystem::path model_path(const std::string& name) {
    return std::filesystem::path(source_folder()) / "models" / name;
}

inline stroke::Model shipped_model(const std::string& name, std::uint32_t size) {
    stroke::ModelOptions options;
    options.cache = stroke::shared_model_cache();
    options.unwrap.size = size;
    return stroke::prepare_model(io::read_model(model_path(name)), options);
}

/// A stroke of poses over the top of the model's middle, `length` metres along x.
inline std::vector<brush::Pose> poses_above(const stroke::Model& model, const brush::Preset& preset, double length,
                                            double y = 0) {
    std::vector<brush::Pose> poses;
    const Box& b = model.mesh->bounds;
    for (int i = 0; i <= 60; ++i) {
        const double s = i / 60.0, press = 0.3 * std::sin(3.141592653589793 * s);
        const Vec3 above{b.centre().x + (s - 0.5) * length, b.centre().y + y, b.hi.z + 0.1};
        const auto hit = model.query->ray(above, {0, 0, -1});
        if (!hit) continue;
        poses.push_back({.position = hit->position + Vec3(0, 0, preset.length * (1 - press) + (press > 0 ? 0 : 1e-3)),
                         .time = 0.01 * i});
    }
    return poses;
}

}  // namespace tuft::test
