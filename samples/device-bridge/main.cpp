// A bridge between a force-feedback arm and tuft: a starting point for owners of an arm that tuft does not know.
//
//     tuft-device-bridge [PORT]        and then, in another shell:   tuft device list
//
// It serves the protocol of the Haply Inverse service on 127.0.0.1: WebSocket with JSON text. After each state the
// client sends a force in newtons, and only then gets the next state:
//
//     to tuft:   {"inverse3":[{"device_id":"…","state":{"cursor_position":{"x":…,"y":…,"z":…},"cursor_velocity":{…}}}],
//                 "wireless_verse_grip":[{"device_id":"…","state":{"orientation":{"w":…,"x":…,"y":…,"z":…},
//                                                                  "buttons":{"a":false,"b":false,"c":false}}}]}
//     from tuft: {"inverse3":[{"device_id":"…","commands":{"set_cursor_force":{"values":{"x":…,"y":…,"z":…}}}}]}
//
// Metres and newtons; x to the right, y away from you, z up. The orientation turns the holder: the brush points along
// its -z. What is yours to write is the class Arm. As it stands, it is an arm of 0.2 kg that swings in the air.
#include <algorithm>
#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

using Vector = std::array<double, 3>;  // x, y, z

// Replace the bodies of these four functions by calls of your arm's library.
class Arm {
  public:
    // Reads position (m) and velocity (m/s), the grip's orientation and buttons.
    void read() {
        const Clock::time_point before = std::exchange(last_, Clock::now());
        const double dt = std::min(0.01, std::chrono::duration<double>(last_ - before).count());
        const double mass = 0.2, damping = 2, spring = 50;  // kg, N s/m, N/m to where it hangs
        for (int n = 0; n < 3; ++n) {
            velocity[n] += dt / mass * (force_[n] - damping * velocity[n] - spring * position[n]);
            position[n] += dt * velocity[n];
        }
    }
    // Gives the motors a force (N) on the hand, until the next one.
    void give(const Vector& force) { force_ = force; }
    // Greatest force (N) of the motors along one axis.
    static double strongest() { return 3.3; }
    // Ends all force: tuft is gone, has been silent for 20 ms, or says what is not understood.
    void release() { give({}); }

    Vector position{0.02, 0, 0}, velocity{};
    double w = 1, i = 0, j = 0, k = 0;  // orientation
    bool a = false, b = false, c = false;

  private:
    Vector force_{};
    Clock::time_point last_ = Clock::now();
};

Json json_of(const Vector& v) {
    return {{"x", v[0]}, {"y", v[1]}, {"z", v[2]}};
}

std::string state_text(const Arm& arm) {
    const Json state = {{"cursor_position", json_of(arm.position)}, {"cursor_velocity", json_of(arm.velocity)}};
    const Json turn = {{"w", arm.w}, {"x", arm.i}, {"y", arm.j}, {"z", arm.k}};
    const Json grip = {{"orientation", turn}, {"buttons", {{"a", arm.a}, {"b", arm.b}, {"c", arm.c}}}};
    return Json{{"inverse3", {{{"device_id", "bridge"}, {"state", state}}}},
                {"wireless_verse_grip", {{{"device_id", "bridge-grip"}, {"state", grip}}}}}
        .dump();
}

// Reads a force and keeps it within what the motors bear. Returns false for anything else; JSON has finite numbers
// only.
bool read_force(const std::string& text, Vector& force) {
    const Json message = Json::parse(text, nullptr, false);
    if (!message.is_object()) return false;
    const Json values = message.value("/inverse3/0/commands/set_cursor_force/values"_json_pointer, Json());
    const char* const names[] = {"x", "y", "z"};
    for (int n = 0; n < 3; ++n) {
        if (!values.contains(names[n]) || !values[names[n]].is_number()) return false;
        force[n] = std::clamp(values[names[n]].get<double>(), -Arm::strongest(), Arm::strongest());
    }
    return true;
}

// Serves one client until it goes.
void serve(asio::ip::tcp::socket socket, Arm& arm) {
    socket.set_option(asio::ip::tcp::no_delay(true));  // or states wait for each other
    websocket::stream<beast::tcp_stream> client(std::move(socket));
    client.read_message_max(65536);
    client.set_option(websocket::stream_base::timeout::suggested(beast::role_type::server));
    asio::io_context& io = static_cast<asio::io_context&>(client.get_executor().context());
    bool gone = false, reading = false, writing = false, may_send = true;
    beast::flat_buffer buffer;
    std::string text;
    client.async_accept([&](beast::error_code error) { gone = static_cast<bool>(error); });
    Clock::time_point heard = Clock::now(), due = heard;
    while (!gone) {
        due += 1ms;
        io.restart();
        io.run_until(due);
        arm.read();
        if (Clock::now() - heard > 20ms) arm.release();
        if (!client.is_open()) continue;
        if (!reading) {
            reading = true;
            client.async_read(buffer, [&](beast::error_code error, std::size_t) {
                reading = false;
                if (error) return static_cast<void>(gone = true);
                Vector force;
                const bool understood = read_force(beast::buffers_to_string(buffer.data()), force);
                understood ? arm.give(force) : arm.release();
                buffer.consume(buffer.size());
                heard = Clock::now();
                may_send = true;
            });
        }
        if (may_send && !writing) {
            may_send = false;
            writing = true;
            text = state_text(arm);
            client.async_write(asio::buffer(text), [&](beast::error_code error, std::size_t) {
                writing = false;
                gone = gone || error;
            });
        }
    }
    arm.release();
    beast::get_lowest_layer(client).close();
    io.restart();
    io.poll();
}

int main(int argc, char** argv) try {
    const int port = argc > 1 ? std::atoi(argv[1]) : 10001;
    asio::io_context io;
    const asio::ip::tcp::endpoint here(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port));
    asio::ip::tcp::acceptor acceptor(io, here);
    std::printf("port %d\n", acceptor.local_endpoint().port());
    std::fflush(stdout);
    Arm arm;
    for (;;) serve(acceptor.accept(), arm);
} catch (const std::exception& error) {
    return std::fprintf(stderr, "tuft-device-bridge: %s\n", error.what()), 1;
}
