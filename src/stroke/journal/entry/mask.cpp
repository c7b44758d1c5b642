#include "stroke/journal/entry/mask.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/geometry/bounds.h"
#include "stroke/journal/entry/entry_json.h"
#include "stroke/journal/entry/layers.h"

namespace tuft::stroke {
namespace {

constexpr const char* kMaskKinds[] = {"group", "angle", "chart", "lasso", "clear", "invert", "intersect", "unite"};
constexpr std::size_t kMaxMasks = 1000, kMaxPoints = 10000;

void check_view(const LassoView& v) {
    const double off =
        std::abs(glm::length(v.right) - 1) + std::abs(glm::length(v.up) - 1) + std::abs(glm::dot(v.right, v.up));
    if (!within(v.origin) || !(off < 1e-6)) throw Error("the view of a lasso is no view");
}

void check_mask(const MaskTable& table, const Mask& m) {
    check_name(m.name, "mask");
    if (table.find(m.name)) throw Error(Message("there is a mask '{}' already", m.name));
    if (m.points.size() + m.polygon.size() + m.groups.size() + m.of.size() > kMaxPoints)
        throw Error("a mask has too many points");
    for (const Vec3& p : m.points)
        if (!within(p)) throw Error("a point of a mask lies out of range");
    for (const Vec2& p : m.polygon)
        if (!within(p)) throw Error("a point of a mask lies out of range");
    if (m.kind == MaskKind::group && m.groups.empty()) throw Error("a mask by group needs the name of one");
    if (m.kind == MaskKind::chart && m.points.empty()) throw Error("a mask by chart needs a point");
    if (m.kind == MaskKind::angle) {
        if (!within(m.direction) || !(glm::length(m.direction) > 1e-9))
            throw Error("a mask by angle needs a direction");
        if (!(m.within >= 0 && m.within <= 3.15 && m.soft >= 0 && m.soft <= 3.15))
            throw Error("the angle of a mask is 0 to 180 degrees");
    }
    if (m.kind == MaskKind::clear && !(m.within > 0 && m.within <= 3.15 && m.distance > 0 && m.distance <= 1))
        throw Error("a mask clear of edges needs an angle up to 180 degrees and a distance up to 1 m");
    if (m.kind == MaskKind::lasso) {
        if (m.polygon.size() < 3) throw Error("a lasso needs three points");
        check_view(m.view);
    }
    const bool of_masks = m.kind == MaskKind::invert || m.kind == MaskKind::intersect || m.kind == MaskKind::unite;
    if (of_masks && (m.of.empty() || (m.kind == MaskKind::invert && m.of.size() != 1)))
        throw Error(m.kind == MaskKind::invert ? "a mask made of a mask needs one" : "a mask made of masks needs some");
    for (const std::uint32_t id : m.of)
        if (!table.find(id)) throw Error(Message("there is no mask {}", id));
}

}  // namespace

std::string name_of(MaskKind kind) {
    return kMaskKinds[static_cast<int>(kind)];
}

MaskKind mask_kind_of(const std::string& name) {
    for (int i = 0; i <= static_cast<int>(MaskKind::unite); ++i)
        if (name == kMaskKinds[i]) return static_cast<MaskKind>(i);
    throw Error(Message(
        "'{}' is no kind of mask; there are group, angle, chart, lasso, clear, invert, intersect and unite", name));
}

const Mask* MaskTable::find(std::uint32_t id) const {
    const auto at = std::find_if(masks.begin(), masks.end(), [id](const Mask& m) { return m.id == id; });
    return at == masks.end() ? nullptr : &*at;
}

const Mask* MaskTable::find(std::string_view name) const {
    const auto at = std::find_if(masks.begin(), masks.end(), [name](const Mask& m) { return m.name == name; });
    return at == masks.end() ? nullptr : &*at;
}

void apply(MaskTable& table, const MaskEdit& edit) {
    if (edit.remove) {
        const Mask* at = table.find(edit.mask.id);
        if (!at) throw Error(Message("there is no mask {}", edit.mask.id));
        for (const Mask& m : table.masks)
            if (std::find(m.of.begin(), m.of.end(), edit.mask.id) != m.of.end())
                throw Error(Message("mask '{}' is part of mask '{}'", at->name, m.name));
        table.masks.erase(table.masks.begin() + (at - table.masks.data()));
        return;
    }
    if (table.masks.size() >= kMaxMasks) throw Error("a painting has at most 1000 masks");
    check_mask(table, edit.mask);
    Mask mask = edit.mask;
    if (mask.id == 0) mask.id = table.next_id;
    if (mask.id < table.next_id || mask.id == kNone) throw Error(Message("mask {} cannot be added again", mask.id));
    table.next_id = mask.id + 1;
    table.masks.push_back(std::move(mask));
}

nlohmann::json json_of(const MaskEdit& edit) {
    const Mask& m = edit.mask;
    nlohmann::json j{{"what", edit.remove ? "remove" : "add"}, {"id", m.id}};
    if (edit.remove) return j;
    j["name"] = m.name;
    j["kind"] = name_of(m.kind);
    if (m.kind == MaskKind::group) j["groups"] = m.groups;
    if (m.kind == MaskKind::angle)
        j.update({{"direction", json_of(m.direction)}, {"within", m.within}, {"soft", m.soft}});
    if (m.kind == MaskKind::clear) j.update({{"within", m.within}, {"distance", m.distance}});
    if (m.kind == MaskKind::chart)
        for (const Vec3& p : m.points) j["points"].push_back(json_of(p));
    if (m.kind == MaskKind::lasso) {
        j["view"] = {{"origin", json_of(m.view.origin)},
                     {"right", json_of(m.view.right)},
                     {"up", json_of(m.view.up)},
                     {"perspective", m.view.perspective},
                     {"through", m.view.through}};
        for (const Vec2& p : m.polygon) j["polygon"].push_back({p.x, p.y});
    }
    if (!m.of.empty()) j["of"] = m.of;
    return j;
}

MaskEdit mask_edit_of(const nlohmann::json& j) {
    MaskEdit edit;
    Mask& m = edit.mask;
    try {
        const std::string what = j.at("what").get<std::string>();
        if (what != "add" && what != "remove") throw Error(Message("'{}' is no change of a mask", what));
        edit.remove = what == "remove";
        m.id = number_of(j.at("id"), "the id of a mask");
        if (edit.remove) return edit;
        m.name = j.at("name").get<std::string>();
        m.kind = mask_kind_of(j.at("kind").get<std::string>());
        if (m.kind == MaskKind::group) m.groups = j.at("groups").get<std::vector<std::string>>();
        if (m.kind == MaskKind::angle) {
            m.direction = vector_of(j.at("direction"));
            m.within = j.at("within").get<double>();
            m.soft = j.at("soft").get<double>();
        }
        if (m.kind == MaskKind::clear) {
            m.within = j.at("within").get<double>();
            m.distance = j.at("distance").get<double>();
        }
        if (m.kind == MaskKind::chart)
            for (const nlohmann::json& p : j.at("points")) m.points.push_back(vector_of(p));
        if (m.kind == MaskKind::lasso) {
            const nlohmann::json& v = j.at("view");
            m.view = {vector_of(v.at("origin")), vector_of(v.at("right")), vector_of(v.at("up")),
                      v.at("perspective").get<bool>(), v.at("through").get<bool>()};
            for (const nlohmann::json& p : j.at("polygon")) {
                const auto xy = p.get<std::array<double, 2>>();
                m.polygon.push_back({xy[0], xy[1]});
            }
        }
        for (const nlohmann::json& id : j.value("of", nlohmann::json::array()))
            m.of.push_back(number_of(id, "the id of a mask"));
    } catch (const nlohmann::json::exception&) {
        throw Error(Message("a mask cannot be read: {}",
                            j.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace).substr(0, 80)));
    }
    return edit;
}

}  // namespace tuft::stroke
