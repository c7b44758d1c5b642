#include "haptic/device/haply_messages.h"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/text/nesting.h"

namespace tuft::haptic {
namespace {

using Json = nlohmann::json;

constexpr double kFarthestPlace = 1000;  // m, m/s, N
constexpr std::array kButtons{"a", "b", "c"};

/// The member of an object, or null.
const Json* member(const Json* object, const char* key) {
    if (!object || !object->is_object()) return nullptr;
    const auto found = object->find(key);
    return found == object->end() ? nullptr : &*found;
}

/// The first element of a list that is a member, or null.
const Json* first(const Json& message, const char* key) {
    const Json* list = member(&message, key);
    return list && list->is_array() && !list->empty() ? &list->front() : nullptr;
}

bool read_number(const Json* object, const char* key, double& value) {
    const Json* number = member(object, key);
    if (!number || !number->is_number()) return false;
    const double v = number->get<double>();
    if (!(std::abs(v) < kFarthestPlace)) return false;
    value = v;
    return true;
}

bool read_vector(const Json* object, Vec3& v) {
    return read_number(object, "x", v.x) && read_number(object, "y", v.y) && read_number(object, "z", v.z);
}

Json vector_json(const Vec3& v) {
    return {{"x", v.x}, {"y", v.y}, {"z", v.z}};
}

/// Empty (discarded) for what is no JSON, too long, or nested too deep.
Json parse(std::string_view text) {
    if (text.size() > kLongestMessage) return Json(Json::value_t::discarded);
    try {
        check_json_nesting(text, "");
    } catch (const Error&) {
        return Json(Json::value_t::discarded);
    }
    return Json::parse(text, nullptr, false);
}

bool read_grip(const Json* grip, DeviceState& state) {
    const Json* now = member(grip, "state");
    if (!now) return true;
    Quat q{1, 0, 0, 0};
    const Json* turn = member(now, "orientation");
    if (turn) {
        if (!read_number(turn, "w", q.w) || !read_number(turn, "x", q.x) || !read_number(turn, "y", q.y) ||
            !read_number(turn, "z", q.z))
            return false;
        const double length = glm::length(q);
        if (!(length > 0.5 && length < 2)) return false;
        state.rotation = q / length;
    }
    if (const Json* buttons = member(now, "buttons")) {
        state.buttons = 0;
        for (std::size_t i = 0; i < kButtons.size(); ++i) {
            const Json* down = member(buttons, kButtons[i]);
            if (down && down->is_boolean() && down->get<bool>()) state.buttons |= 1u << i;
        }
    }
    return true;
}

}  // namespace

bool read_haply_state(std::string_view text, HaplyState& state) {
    const Json message = parse(text);
    if (message.is_discarded()) return false;
    const Json* arm = first(message, "inverse3");
    const Json* now = member(arm, "state");
    HaplyState read = state;
    if (!now || !read_vector(member(now, "cursor_position"), read.state.position)) return false;
    if (const Json* velocity = member(now, "cursor_velocity"); velocity && !read_vector(velocity, read.state.velocity))
        return false;
    if (const Json* id = member(arm, "device_id"); id && id->is_string()) read.device = id->get<std::string>();
    const Json* grip = first(message, "wireless_verse_grip");
    if (!grip) grip = first(message, "verse_grip");
    if (!read_grip(grip, read.state)) return false;
    state = std::move(read);
    return true;
}

std::string haply_state_text(const HaplyState& state) {
    const DeviceState& s = state.state;
    Json buttons;
    for (std::size_t i = 0; i < kButtons.size(); ++i) buttons[kButtons[i]] = (s.buttons >> i & 1) != 0;
    const Json arm = {
        {"device_id", state.device},
        {"state", {{"cursor_position", vector_json(s.position)}, {"cursor_velocity", vector_json(s.velocity)}}}};
    const Json turn = {{"w", s.rotation.w}, {"x", s.rotation.x}, {"y", s.rotation.y}, {"z", s.rotation.z}};
    const Json grip = {{"device_id", state.device + "-grip"}, {"state", {{"orientation", turn}, {"buttons", buttons}}}};
    return Json{{"inverse3", Json::array({arm})}, {"wireless_verse_grip", Json::array({grip})}}.dump();
}

bool read_haply_command(std::string_view text, DeviceCommand& command) {
    const Json message = parse(text);
    if (message.is_discarded()) return false;
    const Json* arm = first(message, "inverse3");
    const Json* force = member(member(member(arm, "commands"), "set_cursor_force"), "values");
    DeviceCommand read;
    if (!read_vector(force, read.force)) return false;
    command = read;
    return true;
}

std::string haply_command_text(const std::string& device, const DeviceCommand& command) {
    const Json values = {{"values", vector_json(command.force)}};
    const Json arm = {{"device_id", device}, {"commands", {{"set_cursor_force", values}}}};
    return Json{{"inverse3", Json::array({arm})}}.dump();
}

}  // namespace tuft::haptic
