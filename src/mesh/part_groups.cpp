#include "mesh/part_groups.h"

#include <map>
#include <set>
#include <tuple>

namespace tuft::mesh {
namespace {

constexpr std::int32_t kAnyNode = -1;

bool is_decorated(const std::string& material) {
    const std::string name = kDecoratedMaterial;
    return material == name || material.starts_with(name + ".");
}

/// Which nodes have a material, and which materials a node has.
class SceneNames {
  public:
    explicit SceneNames(std::span<const ScenePart> parts) {
        for (const ScenePart& part : parts) {
            if (part.own_material < 0) continue;
            nodes_of_[part.own_material].insert(part.node);
            materials_of_[part.node].insert(part.own_material);
        }
    }

    /// The name of a part's group, and the one node whose parts are in it.
    std::pair<std::string, std::int32_t> of(const ScenePart& part) const {
        if (!part.group.empty()) return {part.group, part.object.empty() ? kAnyNode : part.node};
        const bool painted = is_decorated(part.material);
        const bool names_it = part.own_material >= 0 && !part.material.empty();
        if (names_it && !painted && nodes_of_.at(part.own_material).size() == 1) return {part.material, kAnyNode};
        if (part.object.empty()) return {part.material, kAnyNode};
        if (names_it && !painted && materials_of_.at(part.node).size() > 1)
            return {part.object + " / " + part.material, part.node};
        return {part.object, part.node};
    }

  private:
    std::map<std::int32_t, std::set<std::int32_t>> nodes_of_, materials_of_;
};

/// UTF-8 without what is beyond this many bytes.
std::string cut(std::string name, std::size_t most) {
    if (name.size() <= most) return name;
    while (most > 0 && (static_cast<unsigned char>(name[most]) & 0xc0) == 0x80) --most;
    name.resize(most);
    return name;
}

}  // namespace

PartGroups group_parts(std::span<const ScenePart> parts) {
    PartGroups groups;
    const SceneNames names(parts);
    std::map<std::tuple<std::string, std::int32_t, std::int32_t>, std::uint32_t> group_of;
    std::set<std::string> taken;
    std::map<std::string, int> same_name;
    for (const ScenePart& part : parts) {
        const auto [name, node] = names.of(part);
        const auto [it, is_new] =
            group_of.try_emplace({name, part.own_material, node}, static_cast<std::uint32_t>(groups.names.size()));
        if (is_new) {
            std::string unlike = cut(name, kMaxPartNameBytes);
            for (int& n = same_name[name]; !taken.insert(unlike).second;) {
                const std::string number = " " + std::to_string(n++ + 2);
                unlike = cut(name, kMaxPartNameBytes - number.size()) + number;
            }
            groups.names.push_back(std::move(unlike));
        }
        groups.of_part.push_back(it->second);
    }
    return groups;
}

TriangleMesh with_part_groups(TriangleMesh mesh) {
    if (!mesh.scene || mesh.triangle_parts.empty() || mesh.triangle_groups.empty()) return mesh;
    for (const std::uint32_t part : mesh.triangle_parts)
        if (part >= mesh.scene->parts.size()) return mesh;
    PartGroups groups = group_parts(mesh.scene->parts);
    std::vector<Material> materials(mesh.materials.empty() ? 0 : groups.names.size());
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const std::uint32_t group = groups.of_part[mesh.triangle_parts[t]];
        if (!materials.empty()) materials[group] = mesh.materials[mesh.triangle_groups[t]];
        mesh.triangle_groups[t] = group;
    }
    mesh.group_names = std::move(groups.names);
    mesh.materials = std::move(materials);
    return mesh;
}

}  // namespace tuft::mesh
