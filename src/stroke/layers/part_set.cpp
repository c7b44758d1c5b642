#include "stroke/layers/part_set.h"

#include <algorithm>
#include <set>
#include <utility>

#include "core/error.h"
#include "core/text/text.h"

namespace tuft::stroke {
namespace {

constexpr int kN = atlas::kTileTexels;

std::vector<std::uint8_t> groups_in_use(const mesh::TriangleMesh& mesh) {
    std::vector<std::uint8_t> used(mesh.group_names.size(), 0);
    for (const std::uint32_t group : mesh.triangle_groups) used[group] = 1;
    return used;
}

}  // namespace

std::vector<std::string> part_names(const mesh::TriangleMesh& mesh) {
    const std::vector<std::uint8_t> used = groups_in_use(mesh);
    std::vector<std::string> names;
    std::set<std::string> known;
    for (std::size_t i = 0; i < used.size(); ++i)
        if (used[i] && !mesh.group_names[i].empty() && known.insert(mesh.group_names[i]).second)
            names.push_back(mesh.group_names[i]);
    return names;
}

void check_part_names(const mesh::TriangleMesh& mesh, const std::vector<std::string>& names) {
    const std::vector<std::string> all = part_names(mesh);
    const std::set<std::string> known(all.begin(), all.end());
    for (const std::string& name : names) {
        if (known.contains(name)) continue;
        if (all.empty()) throw Error(Message("the model has no part '{}': its file names no parts", name));
        throw Error(Message("the model has no part '{}'{}", name, did_you_mean(nearest_name(name, all))));
    }
}

PartTable PartSet::edit(const PartEdit& edit) {
    PartTable before = table_, table = table_;
    apply(table, edit);
    set_table(std::move(table));
    return before;
}

void PartSet::set_table(PartTable table) {
    const auto hidden = [](const PartTable& t) {
        std::vector<std::string> names;
        for (const Part& part : t.parts)
            if (part.hidden) names.push_back(part.name);
        return names;
    };
    if (hidden(table) != hidden(table_)) surface_.reset();
    open_.clear();
    if (!have_same_substrates(table, table_)) substrates_.reset();
    table_ = std::move(table);
}

const Part* PartSet::part_of(std::uint32_t triangle) const {
    const mesh::TriangleMesh& mesh = *model_->mesh;
    if (table_.parts.empty() || triangle >= mesh.triangle_groups.size()) return nullptr;
    return table_.find(mesh.group_names[mesh.triangle_groups[triangle]]);
}

const ink::Substrate* PartSet::substrate_at(std::uint32_t triangle) const {
    const Part* part = part_of(triangle);
    return part && part->substrate ? &*part->substrate : nullptr;
}

// Names of the mesh's parts whose state `is` true for.
std::vector<std::string> PartSet::names_where(auto&& is) const {
    std::vector<std::string> names;
    if (table_.parts.empty()) return names;
    if (names_.empty()) names_ = part_names(*model_->mesh);
    for (const std::string& name : names_)
        if (const Part* part = table_.find(name); part && is(*part)) names.push_back(name);
    return names;
}

std::vector<std::uint8_t> PartSet::hidden_triangles() const {
    const mesh::TriangleMesh& mesh = *model_->mesh;
    std::vector<std::uint8_t> of_group(mesh.group_names.size(), 0);
    for (std::size_t i = 0; i < of_group.size(); ++i) {
        const Part* part = table_.find(mesh.group_names[i]);
        of_group[i] = part && part->hidden;
    }
    if (mesh.triangle_groups.empty() || std::ranges::find(of_group, 1) == of_group.end()) return {};
    std::vector<std::uint8_t> hidden(mesh.n_triangles());
    for (std::size_t i = 0; i < hidden.size(); ++i) hidden[i] = of_group[mesh.triangle_groups[i]];
    if (std::ranges::find(hidden, 1) == hidden.end()) hidden.clear();
    return hidden;
}

std::vector<float> PartSet::transmission(const ink::Substrate& document) const {
    const mesh::TriangleMesh& mesh = *model_->mesh;
    std::vector<float> of_group(std::max<std::size_t>(mesh.group_names.size(), 1), document.transmission);
    for (std::size_t i = 0; i < mesh.group_names.size(); ++i)
        if (const Part* part = table_.find(mesh.group_names[i]); part && part->substrate)
            of_group[i] = part->substrate->transmission;
    if (std::ranges::none_of(of_group, [](float t) { return t > 0; })) return {};
    std::vector<float> of_triangle(mesh.n_triangles(), of_group[0]);
    for (std::size_t i = 0; i < mesh.triangle_groups.size(); ++i) of_triangle[i] = of_group[mesh.triangle_groups[i]];
    return of_triangle;
}

std::shared_ptr<const mesh::SurfaceQuery> PartSet::surface() const {
    if (surface_) return surface_;
    const std::vector<std::uint8_t> hidden = hidden_triangles();
    if (hidden.empty()) {
        // The model owns it.
        surface_ = std::shared_ptr<const mesh::SurfaceQuery>(std::shared_ptr<void>(), model_->query.get());
        return surface_;
    }
    std::vector<std::uint32_t> visible;
    for (std::uint32_t i = 0; i < hidden.size(); ++i)
        if (!hidden[i]) visible.push_back(i);
    surface_ = std::make_shared<const mesh::SurfaceQuery>(*model_->mesh, std::move(visible));
    return surface_;
}

MaskTexels PartSet::texels_of(const std::vector<std::string>& parts) const {
    Mask mask;
    mask.kind = MaskKind::group;
    mask.groups = parts;
    return evaluate(mask, {}, *model_);
}

const MaskTexels* PartSet::open_texels(std::uint32_t id, const MaskSet& masks) const {
    const MaskTexels* within = id ? &masks.texels(id) : nullptr;
    const std::vector<std::string> closed = names_where([](const Part& part) { return part.hidden || part.locked; });
    if (closed.empty()) return within;
    if (const auto known = open_.find(id); known != open_.end()) return &known->second;
    const MaskTexels shut = texels_of(closed);
    const std::size_t n = model_->texels.n_slots();
    MaskTexels open(n);
    for (std::uint32_t slot = 0; slot < n; ++slot) {
        std::array<std::uint8_t, kN> coverage;
        for (int t = 0; t < kN; ++t)
            coverage[static_cast<std::size_t>(t)] = shut.coverage(slot, t) ? std::uint8_t{0}
                                                    : within               ? within->coverage(slot, t)
                                                                           : std::uint8_t{255};
        open.set(slot, coverage);
    }
    return &open_.emplace(id, std::move(open)).first->second;
}

ink::SubstrateMap PartSet::make_substrates() const {
    ink::SubstrateMap map;
    const std::size_t n = model_->texels.n_slots();
    map.of_slot.assign(n, 0);
    std::map<std::string, std::vector<std::string>> parts_of;  // by the substrate's text
    for (const std::string& name : names_where([](const Part& part) { return part.substrate.has_value(); }))
        parts_of[ink::substrate_toml(*table_.find(name)->substrate)].push_back(name);
    if (parts_of.size() > kMaxPartSubstrates)
        throw Error(Message("the parts of a model have at most {} different substrates", kMaxPartSubstrates));
    std::vector<ink::SubstrateMap::Indices> indices(parts_of.empty() ? 0 : n, ink::SubstrateMap::Indices{});
    for (const auto& [text, parts] : parts_of) {
        map.others.push_back(*table_.find(parts.front())->substrate);
        const MaskTexels texels = texels_of(parts);
        for (std::uint32_t slot = 0; slot < n; ++slot)
            for (int t = 0; t < kN && !texels.none(slot); ++t)
                if (texels.coverage(slot, t))
                    indices[slot][static_cast<std::size_t>(t)] = static_cast<std::uint8_t>(map.others.size());
    }
    for (std::uint32_t slot = 0; slot < indices.size(); ++slot) {
        std::array<int, 256> count{};
        for (int t = 0; t < kN; ++t)
            if (model_->texels.tiles[slot].cluster[t] != atlas::kNoCluster)
                ++count[indices[slot][static_cast<std::size_t>(t)]];
        const auto most = std::ranges::max_element(count);
        map.of_slot[slot] = static_cast<std::uint8_t>(most - count.begin());
        if (std::ranges::count_if(count, [](int c) { return c > 0; }) > 1) map.of_texel[slot] = indices[slot];
    }
    return map;
}

const ink::SubstrateMap* PartSet::substrates() const {
    if (!substrates_) substrates_ = make_substrates();
    return substrates_->others.empty() ? nullptr : &*substrates_;
}

}  // namespace tuft::stroke
