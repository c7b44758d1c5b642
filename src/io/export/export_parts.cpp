#include <algorithm>
#include <atomic>
#include <bitset>

#include "core/system/parallel.h"
#include "io/export/export.h"
#include "io/export/export_formats.h"
#include "io/scene/scene_document.h"

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

/// Number of parts that the triangles, the scene and the groups name.
std::size_t count_parts(const mesh::TriangleMesh& mesh) {
    std::uint32_t n = 0;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) n = std::max(n, mesh::part_of(mesh, t) + 1);
    if (mesh.scene) n = std::max(n, static_cast<std::uint32_t>(mesh.scene->parts.size()));
    return std::max<std::size_t>(n, mesh.group_names.size());
}

/// Returns for each part whether `is` true for one of its texels.
template <class Is>
std::vector<std::uint8_t> parts_with(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas,
                                     const atlas::TexelMap& texels, Is is) {
    std::vector<std::uint8_t> with(count_parts(mesh), 0);
    atlas::visit_texels(mesh, atlas, texels, [&](std::uint32_t slot, int texel, std::uint32_t triangle, const Vec3&) {
        if (is(slot, static_cast<std::size_t>(texel)))
            std::atomic_ref(with[mesh::part_of(mesh, triangle)]).store(1, std::memory_order_relaxed);
    });
    return with;
}

/// Index of a texel's substrate in the stack's map.
std::uint8_t substrate_index(const ink::Stack& stack, std::uint32_t slot, std::size_t texel) {
    if (!stack.substrates) return 0;
    const auto mixed = stack.substrates->of_texel.find(slot);
    return mixed == stack.substrates->of_texel.end() ? stack.substrates->of_slot[slot] : mixed->second[texel];
}

std::string name_of_part(const mesh::ScenePart& part) {
    return !part.object.empty() ? part.object : !part.group.empty() ? part.group : part.material;
}

}  // namespace

std::vector<std::uint8_t> painted_parts(const ink::Stack& stack, const mesh::TriangleMesh& mesh,
                                        const atlas::Atlas& atlas, const atlas::TexelMap& texels) {
    std::vector<TexelSet> inked(texels.n_slots());
    const std::vector<std::uint32_t> touched = stack.touched_slots();
    parallel_for(touched.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) inked[touched[i]] = inked_texels(stack, touched[i]);
    });
    return parts_with(mesh, atlas, texels, [&](std::uint32_t slot, std::size_t texel) {
        return inked[slot].test(texel) || substrate_index(stack, slot, texel) != 0;
    });
}

std::vector<std::uint8_t> transmitting_parts(const ink::Stack& stack, const ink::Substrate& substrate,
                                             const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas,
                                             const atlas::TexelMap& texels) {
    if (!ink::has_transmission(stack, substrate)) return {};
    return parts_with(mesh, atlas, texels, [&](std::uint32_t slot, std::size_t texel) {
        const std::uint8_t index = substrate_index(stack, slot, texel);
        return (index == 0 ? substrate : stack.substrates->others[index - 1u]).transmission > 0;
    });
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
    const auto glass = std::count(scene.transmits.begin(), scene.transmits.end(), 1);
    if (glass > 0 && !scene.has_transmission)
        notes.push_back(
            Message("warning: {} of {} parts are of glass; this format has no map of it, so they are opaque", glass,
                    scene.decorated.size()));
    const nlohmann::json document = parse_document(scene.source);
    const auto materials = document.find("materials");
    if (materials == document.end() || !materials->is_array()) return notes;
    for (std::size_t i = 0; i < scene.decorated.size(); ++i) {
        const mesh::ScenePart& part = scene.source.parts[i];
        const auto own = static_cast<std::size_t>(part.own_material);
        const bool is_glass = i < scene.transmits.size() && scene.transmits[i] && scene.has_transmission;
        if (!scene.decorated[i] || is_glass || part.own_material < 0 || own >= materials->size()) continue;
        const auto mode = (*materials)[own].find("alphaMode");
        if (mode != (*materials)[own].end() && *mode != "OPAQUE")
            notes.push_back(
                Message("warning: part '{}' is transparent in its file; with ink on it, it is written opaque",
                        name_of_part(part)));
    }
    return notes;
}

}  // namespace tuft::io
