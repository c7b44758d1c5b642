#include <algorithm>
#include <atomic>
#include <bitset>

#include "core/system/parallel.h"
#include "io/export/export.h"
#include "io/export/export_formats.h"
#include "io/model/scene_document.h"

/// Which parts of a model carry ink, and what is said of the others.
namespace tuft::io {
namespace {

constexpr float kLeastInk = 1e-4f;  // film units; the least code of a colour is some 2e-3 of black ink

using TexelSet = std::bitset<atlas::kTileTexels>;

/// Texels of a slot on which something lies.
TexelSet inked_texels(const ink::Stack& stack, std::uint32_t slot) {
    TexelSet inked;
    const auto add = [&](const ink::Plane* plane) {
        for (std::size_t t = 0; plane && t < inked.size(); ++t)
            if ((*plane)[t] > kLeastInk) inked.set(t);
    };
    for (const ink::LayerView& layer : stack.layers) {
        if (layer.opacity <= 0) continue;
        for (int film = 0; film < ink::kFilms; ++film)
            for (int p = 0; p < static_cast<int>(layer.canvas->pigments().size()); ++p)
                add(layer.canvas->film_plane(slot, film, p));
        for (const ink::Liquid where : {ink::Liquid::film, ink::Liquid::pores}) add(layer.canvas->liquid(slot, where));
    }
    return inked;
}

std::string name_of_part(const mesh::ScenePart& part) {
    return !part.object.empty() ? part.object : !part.group.empty() ? part.group : part.material;
}

}  // namespace

std::vector<std::uint8_t> painted_parts(const ink::Stack& stack, const mesh::TriangleMesh& mesh,
                                        const atlas::Atlas& atlas, const atlas::TexelMap& texels) {
    std::uint32_t n = 0;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) n = std::max(n, mesh::part_of(mesh, t) + 1);
    if (mesh.scene) n = std::max(n, static_cast<std::uint32_t>(mesh.scene->parts.size()));
    std::vector<std::uint8_t> painted(std::max<std::size_t>(n, mesh.group_names.size()), 0);
    std::vector<TexelSet> inked(texels.n_slots());
    const std::vector<std::uint32_t> touched = stack.touched_slots();
    parallel_for(touched.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) inked[touched[i]] = inked_texels(stack, touched[i]);
    });
    atlas::visit_texels(mesh, atlas, texels, [&](std::uint32_t slot, int texel, std::uint32_t triangle, const Vec3&) {
        if (inked[slot].test(static_cast<std::size_t>(texel)))
            std::atomic_ref(painted[mesh::part_of(mesh, triangle)]).store(1, std::memory_order_relaxed);
    });
    return painted;
}

std::vector<std::vector<std::uint32_t>> triangles_of_parts(const ExportScene& scene) {
    std::vector<std::vector<std::uint32_t>> of_part(scene.source.parts.size());
    for (std::uint32_t t = 0; t < scene.mesh.n_triangles(); ++t) of_part[mesh::part_of(scene.mesh, t)].push_back(t);
    return of_part;
}

std::vector<Message> notes_on_parts(const ExportScene& scene) {
    std::vector<Message> notes;
    const auto kept = static_cast<std::size_t>(std::count(scene.decorated.begin(), scene.decorated.end(), 0));
    if (kept > 0)
        notes.push_back(
            Message("{} of {} parts get the material 'decorated'; the others carry no ink and keep their own",
                    scene.decorated.size() - kept, scene.decorated.size()));
    const nlohmann::json document = parse_document(scene.source);
    const auto materials = document.find("materials");
    if (materials == document.end() || !materials->is_array()) return notes;
    for (std::size_t i = 0; i < scene.decorated.size(); ++i) {
        const mesh::ScenePart& part = scene.source.parts[i];
        const auto own = static_cast<std::size_t>(part.own_material);
        if (!scene.decorated[i] || part.own_material < 0 || own >= materials->size()) continue;
        const auto mode = (*materials)[own].find("alphaMode");
        if (mode != (*materials)[own].end() && *mode != "OPAQUE")
            notes.push_back(
                Message("warning: part '{}' is transparent in its file; with ink on it, it is written opaque",
                        name_of_part(part)));
    }
    return notes;
}

}  // namespace tuft::io
