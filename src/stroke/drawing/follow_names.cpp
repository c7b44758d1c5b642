#include "stroke/drawing/follow_names.h"

#include <algorithm>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "mesh/part_groups.h"

namespace tuft::stroke {
namespace {

using IndexPair = std::pair<std::uint32_t, std::uint32_t>;
using NewNames = std::map<std::string, std::set<std::string>>;  // of today, by former name

/// The pairs of indices that triangles have, each once, ascending.
template <class PairOf>
std::vector<IndexPair> pairs_of(const mesh::TriangleMesh& mesh, PairOf pair_of) {
    std::set<IndexPair> pairs;
    IndexPair last(kNone, kNone);
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
        if (const IndexPair pair = pair_of(t); pair != last) pairs.insert(last = pair);
    return {pairs.begin(), pairs.end()};
}

/// The part of a file that is a group of its mesh, or lies in one.
struct GroupPart {
    std::uint32_t part = 0, group = 0;
    std::string object, material;  ///< with the object its group, in files that have groups
};

bool has_parts(const mesh::TriangleMesh& mesh) {
    if (!mesh.scene) return false;
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
        if (mesh::part_of(mesh, t) >= mesh.scene->parts.size()) return false;
    return true;
}

bool has_nodes(const mesh::TriangleMesh& mesh) {
    return mesh.scene && std::ranges::any_of(mesh.scene->parts, [](const auto& part) { return part.primitive >= 0; });
}

/// Without a scene the groups are taken for materials.
std::vector<GroupPart> group_parts_of(const mesh::TriangleMesh& mesh) {
    std::vector<GroupPart> out;
    if (mesh.triangle_groups.empty()) return out;
    const bool known = has_parts(mesh);
    const auto pairs = pairs_of(mesh, [&](std::size_t t) {
        return IndexPair(known ? mesh::part_of(mesh, t) : mesh.triangle_groups[t], mesh.triangle_groups[t]);
    });
    for (const auto& [part, group] : pairs) {
        out.push_back({.part = part, .group = group, .object = {}, .material = mesh.group_names[group]});
        if (!known) continue;
        const mesh::ScenePart& of = mesh.scene->parts[part];
        const bool grouped = of.primitive < 0 && !of.group.empty();  // glTF has no groups
        out.back().object = grouped ? of.object + '\n' + of.group : of.object;
        out.back().material = of.material;
    }
    return out;
}

/// Groups in which the parts of the former model are in the revised one.
class PartMatch {
  public:
    PartMatch(const mesh::TriangleMesh& former, const mesh::TriangleMesh& revised)
        : known_(has_parts(former)),
          was_(group_parts_of(former)),
          is_(group_parts_of(revised)),
          found_(was_.size()),
          taken_(revised.group_names.size(), false) {
        const auto object = [](const GroupPart& part) { return part.object; };
        const auto material = [](const GroupPart& part) { return part.material; };
        match_equal();
        match_pages();
        match_rest(object, object);
        // Groups of a file without a scene are materials, and a material may be called as another node is.
        if (!known_ && has_nodes(revised)) match_rest(material, material);
        match_rest([&](const GroupPart& part) { return former.group_names[part.group]; },
                   [&](const GroupPart& part) { return revised.group_names[part.group]; });
        match_rest(material, material);
    }

    const std::vector<GroupPart>& former() const { return was_; }
    /// Groups of the revised model that a former part is in; the first is its own. Empty: it is gone.
    const std::vector<std::uint32_t>& groups(std::size_t i) const { return found_[i]; }

  private:
    using Members = std::map<std::pair<std::string, std::string>, std::vector<std::size_t>>;

    static Members by_names(const std::vector<GroupPart>& parts) {
        Members members;
        for (std::size_t i = 0; i < parts.size(); ++i) members[{parts[i].object, parts[i].material}].push_back(i);
        return members;
    }

    static std::vector<std::uint32_t> groups_of(const std::vector<GroupPart>& parts,
                                                const std::vector<std::size_t>& members) {
        std::vector<std::uint32_t> groups;
        std::set<std::uint32_t> known;
        for (const std::size_t i : members)
            if (known.insert(parts[i].group).second) groups.push_back(parts[i].group);
        return groups;
    }

    void match_equal() {
        const Members was = by_names(was_), is = by_names(is_);
        for (const auto& [names, members] : was) {
            const auto same = is.find(names);
            if (same == is.end()) continue;
            const std::vector<std::uint32_t> before = groups_of(was_, members), now = groups_of(is_, same->second);
            std::map<std::uint32_t, std::size_t> place;  // in `before`
            for (std::size_t i = 0; i < before.size(); ++i) place[before[i]] = i;
            for (std::size_t k = 0; k < members.size(); ++k) {
                std::vector<std::uint32_t>& found = found_[members[k]];
                if (before.size() > 1) {
                    const std::size_t at = place.at(was_[members[k]].group);
                    if (at < now.size()) found = {now[at]};
                    continue;
                }
                found = now;
                if (members.size() != same->second.size()) continue;
                const std::uint32_t own = is_[same->second[k]].group;
                std::rotate(found.begin(), std::ranges::find(found, own), found.end());
            }
        }
        take();
    }

    /// Former pages of an exported object whose decorated part is one today, on pages of other numbers or on one.
    void match_pages() {
        const std::string decorated = mesh::kDecoratedMaterial;
        const auto is_glass = [](const std::string& material) {
            return material.find(mesh::kGlassSuffix) != std::string::npos;
        };
        std::map<std::pair<std::string, bool>, std::set<std::uint32_t>> now;  // by object and glass
        for (const GroupPart& part : is_)
            if (part.material == decorated || part.material.starts_with(decorated + "."))
                now[{part.object, is_glass(part.material)}].insert(part.group);
        // Two former objects of one name: which of them is left nobody can tell.
        std::map<std::pair<std::string, std::string>, std::set<std::uint32_t>> before;  // by object and material
        for (const GroupPart& part : was_) before[{part.object, part.material}].insert(part.group);
        for (std::size_t i = 0; i < was_.size(); ++i) {
            const GroupPart& part = was_[i];
            if (!found_[i].empty() || part.object.empty() || mesh::decorated_page(part.material) == 0) continue;
            if (before.at({part.object, part.material}).size() > 1) continue;
            const auto at = now.find({part.object, is_glass(part.material)});
            if (at != now.end() && at->second.size() == 1) found_[i] = {*at->second.begin()};
        }
        take();
    }

    /// Parts of one name that are left.
    struct Left {
        std::vector<std::uint32_t> groups;  ///< of its parts, each once
        std::set<std::uint32_t> known;
        std::size_t n_parts = 0;
        bool has_objects = false;

        void add(std::uint32_t group) {
            ++n_parts;
            if (known.insert(group).second) groups.push_back(group);
        }
        bool is_one() const { return groups.size() == 1; }
    };

    /// What is left of both by one name. Of files with parts, only where one group is left on either side (a deleted
    /// screw is not every new part of steel), or where as many parts lost their objects' names.
    template <class Was, class Is>
    void match_rest(Was name_before, Is name_now) {
        std::map<std::string, Left> before, now;
        for (std::size_t i = 0; i < was_.size(); ++i)
            if (found_[i].empty()) before[name_before(was_[i])].add(was_[i].group);
        for (const GroupPart& part : is_) {
            if (taken_[part.group]) continue;
            Left& left = now[name_now(part)];
            left.add(part.group);
            left.has_objects = left.has_objects || !part.object.empty();
        }
        std::set<std::string> same;
        for (const auto& [name, left] : before) {
            const auto found = now.find(name);
            if (name.empty() || found == now.end()) continue;
            const bool lost_names = !found->second.has_objects && found->second.n_parts == left.n_parts;
            if (!known_ || (found->second.is_one() && (left.is_one() || lost_names))) same.insert(name);
        }
        for (std::size_t i = 0; i < was_.size(); ++i)
            if (const std::string name = name_before(was_[i]); found_[i].empty() && same.contains(name))
                found_[i] = now.at(name).groups;
        take();
    }

    void take() {
        for (const auto& groups : found_)
            for (const std::uint32_t group : groups) taken_[group] = true;
    }

    bool known_;  ///< the former file has parts
    std::vector<GroupPart> was_, is_;
    std::vector<std::vector<std::uint32_t>> found_;  ///< by former part
    std::vector<bool> taken_;                        ///< by revised group
};

std::string gone_name(std::string name, const std::set<std::string>& today) {
    while (today.contains(name)) name += " (former)";
    return name;
}

bool changes(const NewNames& names) {
    return std::ranges::any_of(names,
                               [](const auto& n) { return n.second.size() != 1 || *n.second.begin() != n.first; });
}

/// Groups of the former model as its parts are called in the revised one, in that one's order, then those that are
/// gone.
void regroup(mesh::TriangleMesh& former, const mesh::TriangleMesh& revised, const PartMatch& match,
             const std::set<std::string>& today) {
    std::map<std::pair<std::uint32_t, std::string>, std::vector<std::size_t>> members;
    const std::vector<GroupPart>& parts = match.former();
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const std::vector<std::uint32_t>& groups = match.groups(i);
        if (groups.empty())
            members[{kNone, gone_name(former.group_names[parts[i].group], today)}].push_back(i);
        else
            members[{groups.front(), revised.group_names[groups.front()]}].push_back(i);
    }
    std::map<IndexPair, std::uint32_t> group_of;
    std::vector<std::string> names;
    std::vector<mesh::Material> materials;
    for (const auto& [name, all] : members) {
        for (const std::size_t i : all)
            group_of[{parts[i].part, parts[i].group}] = static_cast<std::uint32_t>(names.size());
        names.push_back(name.second);
        if (former.materials.size() == former.group_names.size())
            materials.push_back(former.materials[parts[all.front()].group]);
    }
    const bool known = has_parts(former);
    for (std::size_t t = 0; t < former.n_triangles(); ++t) {
        std::uint32_t& group = former.triangle_groups[t];
        group = group_of.at({known ? mesh::part_of(former, t) : group, group});
    }
    former.group_names = std::move(names);
    former.materials = std::move(materials);
}

NewNames match_names(mesh::TriangleMesh& former, const mesh::TriangleMesh& revised,
                     const std::set<std::string>& today) {
    const PartMatch match(former, revised);
    NewNames names;
    for (std::size_t i = 0; i < match.former().size(); ++i) {
        std::set<std::string>& now = names[former.group_names[match.former()[i].group]];
        for (const std::uint32_t group : match.groups(i)) now.insert(revised.group_names[group]);
    }
    for (auto& [name, now] : names)
        if (now.empty()) now.insert(gone_name(name, today));
    if (changes(names)) regroup(former, revised, match, today);
    return names;
}

/// Groups of the former model by the names of the pairs of its groups and `parts`, in their order.
void rename_groups(mesh::TriangleMesh& former, const std::vector<std::uint32_t>& parts,
                   const std::map<IndexPair, std::string>& name_of) {
    std::map<std::string, std::uint32_t> group_of;
    std::vector<std::string> names;
    std::vector<mesh::Material> materials;
    for (const auto& [pair, name] : name_of) {
        if (!group_of.try_emplace(name, static_cast<std::uint32_t>(names.size())).second) continue;
        names.push_back(name);
        if (former.materials.size() == former.group_names.size()) materials.push_back(former.materials[pair.first]);
    }
    for (std::size_t t = 0; t < former.n_triangles(); ++t) {
        std::uint32_t& group = former.triangle_groups[t];
        group = group_of.at(name_of.at({group, parts[t]}));
    }
    former.group_names = std::move(names);
    former.materials = std::move(materials);
}

/// For a revised file without a scene: a former group that is not there any more has the names of its parts.
NewNames names_of_file(mesh::TriangleMesh& former, const std::set<std::string>& today) {
    const bool all_there =
        std::ranges::all_of(former.group_names, [&](const std::string& name) { return today.contains(name); });
    if (all_there || former.triangle_groups.empty()) return {};
    const mesh::TriangleMesh parts = mesh::with_part_groups(former);
    const auto pair_of = [&](std::size_t t) { return IndexPair(former.triangle_groups[t], parts.triangle_groups[t]); };
    const std::set<std::string> were(former.group_names.begin(), former.group_names.end());
    NewNames names;
    std::map<IndexPair, std::string> name_of;
    for (const IndexPair& pair : pairs_of(former, pair_of)) {
        const std::string &was = former.group_names[pair.first], &own = parts.group_names[pair.second];
        const std::string& name = today.contains(was) || were.contains(own) ? was : own;
        names[was].insert(name);
        name_of.emplace(pair, name);
    }
    if (changes(names)) rename_groups(former, parts.triangle_groups, name_of);
    return names;
}

/// Parts that entries name.
std::set<std::string> named_in(const std::vector<JournalEntry>& entries) {
    std::set<std::string> names;
    for (const JournalEntry& entry : entries) {
        if (const PartEdit* edit = entry.as<PartEdit>())
            for (const Part& part : edit->parts) names.insert(part.name);
        if (const MaskEdit* edit = entry.as<MaskEdit>(); edit && edit->mask.kind == MaskKind::group)
            names.insert(edit->mask.groups.begin(), edit->mask.groups.end());
    }
    return names;
}

/// Says which named parts of the former model are one part today.
void note_joined(const NewNames& names, const std::set<std::string>& named, std::vector<Message>& notes) {
    constexpr std::size_t kMostNames = 3;
    std::map<std::string, std::vector<std::string>> former;
    for (const auto& [was, now] : names)
        for (const std::string& name : now) former[name].push_back(was);
    for (const auto& [name, were] : former) {
        if (were.size() < 2 || std::ranges::none_of(were, [&](const auto& was) { return named.contains(was); }))
            continue;
        std::string list;
        for (std::size_t i = 0; i < std::min(were.size(), kMostNames); ++i)
            list += (i > 0 ? ", '" : "'") + were[i] + "'";
        if (were.size() > kMostNames) list += " …";
        notes.push_back(
            Message("the parts {} are one part now, '{}': a mask of one of them holds all of it, and it "
                    "is hidden or locked where all of them were",
                    list, name));
    }
}

/// States of parts under the names of today. A part that was several is hidden or locked where all of them were, so
/// that no ink on another of them is lost.
class RenamedStates {
  public:
    explicit RenamedStates(const NewNames& names) : names_(names) {
        for (const auto& [was, now] : names)
            for (const std::string& name : now) former_[name].push_back(was);
    }

    void rename(PartEdit& edit) {
        std::map<std::string, Part> parts;  // the last word on a part counts
        for (const Part& part : edit.parts) {
            const auto known = names_.find(part.name);
            if (known == names_.end()) {
                parts[part.name] = part;
                continue;
            }
            states_[part.name] = part;
            for (const std::string& name : known->second) parts[name] = joined(name, part);
        }
        edit.parts.clear();
        for (auto& [name, part] : parts) edit.parts.push_back(std::move(part));
    }

  private:
    Part joined(const std::string& name, Part part) const {
        part.name = name;
        for (const std::string& was : former_.at(name)) {
            const auto state = states_.find(was);
            part.hidden = part.hidden && state != states_.end() && state->second.hidden;
            part.locked = part.locked && state != states_.end() && state->second.locked;
        }
        return part;
    }

    const NewNames& names_;
    std::map<std::string, std::vector<std::string>> former_;  ///< by the name of today
    std::map<std::string, Part> states_;                      ///< by former name
};

/// Returns whether the mask has a group of today.
bool rename(std::vector<std::string>& groups, const NewNames& names, const std::set<std::string>& today) {
    std::vector<std::string> all, there;
    std::set<std::string> listed;
    for (const std::string& name : groups) {
        const auto known = names.find(name);
        const std::set<std::string> now = known == names.end() ? std::set{name} : known->second;
        for (const std::string& to : now) {
            if (!listed.insert(to).second) continue;
            all.push_back(to);
            if (today.contains(to)) there.push_back(to);
        }
    }
    const bool found = !there.empty();
    groups = std::move(found ? there : all);
    return found;
}

}  // namespace

NamedEntries follow_names(std::vector<JournalEntry> entries, mesh::TriangleMesh& former,
                          const mesh::TriangleMesh& revised) {
    const std::set<std::string> today(revised.group_names.begin(), revised.group_names.end());
    const NewNames names = has_parts(revised) ? match_names(former, revised, today) : names_of_file(former, today);
    const bool renames = changes(names);
    NamedEntries out{.entries = std::move(entries), .notes = {}};
    if (renames) note_joined(names, named_in(out.entries), out.notes);
    RenamedStates states(names);
    for (JournalEntry& entry : out.entries) {
        if (PartEdit* edit = entry.as<PartEdit>(); edit && renames) states.rename(*edit);
        MaskEdit* edit = entry.as<MaskEdit>();
        if (!edit || edit->remove || edit->mask.kind != MaskKind::group) continue;
        if (!rename(edit->mask.groups, names, today))
            out.notes.push_back(Message("the mask '{}' covers nothing: its parts are gone", edit->mask.name));
    }
    return out;
}

}  // namespace tuft::stroke
