#include "mesh/part_groups.h"

#include <charconv>
#include <map>
#include <set>
#include <string_view>
#include <system_error>
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
            materials_of_[part.node].insert(part.own_material);
            if (part.own_material >= 0) nodes_of_[part.own_material].insert(part.node);
        }
    }

    /// The name of a part's group, and the one node whose parts are in it.
    std::pair<std::string, std::int32_t> of(const ScenePart& part) const {
        if (!part.group.empty()) return {part.group, part.object.empty() ? kAnyNode : part.node};
        const bool names_it = part.own_material >= 0 && !part.material.empty() && !is_decorated(part.material);
        if (part.object.empty()) return {part.material, kAnyNode};
        if (!names_it || materials_of_.at(part.node).size() == 1) return {part.object, part.node};
        if (nodes_of_.at(part.own_material).size() == 1) return {part.material, kAnyNode};
        return {part.object + " / " + part.material, part.node};
    }

  private:
    std::map<std::int32_t, std::set<std::int32_t>> nodes_of_, materials_of_;
};

/// Which group a part is in: one for each material, but one for the decorated materials of all pages.
class GroupIndex {
  public:
    /// `n_groups`: the number of a new group.
    std::uint32_t get(const ScenePart& part, const std::string& name, std::int32_t node, std::uint32_t n_groups) {
        const auto [known, is_new] = of_material_.try_emplace({name, node, part.own_material}, n_groups);
        const std::uint32_t page = decorated_page(part.material);
        if (!is_new || page == 0) return known->second;
        const bool glass = part.material.find(kGlassSuffix) != std::string::npos;
        std::vector<std::uint32_t>& alike = paged_[{name, node, glass}];
        const std::size_t n = n_on_page_[{name, node, glass, page}]++;  // a group has one picture on a page
        if (n == alike.size()) alike.push_back(n_groups);
        return known->second = alike[n];
    }

  private:
    std::map<std::tuple<std::string, std::int32_t, std::int32_t>, std::uint32_t> of_material_;
    std::map<std::tuple<std::string, std::int32_t, bool>, std::vector<std::uint32_t>> paged_;
    std::map<std::tuple<std::string, std::int32_t, bool, std::uint32_t>, std::size_t> n_on_page_;
};

/// UTF-8 without what is beyond this many bytes.
std::string cut(std::string name, std::size_t most) {
    if (name.size() <= most) return name;
    while (most > 0 && (static_cast<unsigned char>(name[most]) & 0xc0) == 0x80) --most;
    name.resize(most);
    return name;
}

}  // namespace

std::uint32_t decorated_page(std::string_view material) {
    const std::string_view name = kDecoratedMaterial;
    if (!material.starts_with(name) || material.size() < name.size() + 5 || material[name.size()] != '.') return 0;
    const std::string_view number = material.substr(name.size() + 1, 4), rest = material.substr(name.size() + 5);
    std::uint32_t page = 0;
    const auto [end, fault] = std::from_chars(number.data(), number.data() + number.size(), page);
    const bool is_number = fault == std::errc{} && end == number.data() + number.size();
    return is_number && page >= 1001 && page <= 2000 && (rest.empty() || rest[0] == '.') ? page : 0;
}

PartGroups group_parts(std::span<const ScenePart> parts) {
    PartGroups groups;
    const SceneNames names(parts);
    GroupIndex index;
    std::set<std::string> taken;
    std::map<std::string, int> same_name;
    for (const ScenePart& part : parts) {
        const auto [name, node] = names.of(part);
        const auto n_groups = static_cast<std::uint32_t>(groups.names.size());
        groups.of_part.push_back(index.get(part, name, node, n_groups));
        if (groups.of_part.back() != n_groups) continue;
        std::string unlike = cut(name, kMaxPartNameBytes);
        for (int& n = same_name[unlike]; !taken.insert(unlike).second;) {
            const std::string number = " " + std::to_string(n++ + 2);
            unlike = cut(name, kMaxPartNameBytes - number.size()) + number;
        }
        groups.names.push_back(std::move(unlike));
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
