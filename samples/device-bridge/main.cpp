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
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <thread>

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using Json = nlohmann::json;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

struct Vector {
    double x = 0, y = 0, z = 0;
};

// Replace the bodies of these four functions by calls of your arm's library.
class Arm {
  public:
    // Reads position (m) and velocity (m/s), the grip's orientation and buttons.
    void read() {
        const Clock::time_point now = Clock::now();
        const double dt = std::min(0.01, std::chrono::duration<double>(now - last_).count());
        last_ = now;
        const double mass = 0.2, damping = 2, spring = 50;  // kg, N s/m, N/m to where it hangs
        const auto move = [&](double& x, double& v, double f) {
            v += dt / mass * (f - damping * v - spring * x);
            x += dt * v;
        };
        move(position.x, velocity.x, force_.x);
        move(position.y, velocity.y, force_.y);
        move(position.z, velocity.z, force_.z);
    }
    // Gives the motors a force (N) on the hand, until the next one.
    void give(const Vector& force) { force_ = force; }
    // Greatest force (N) of the motors along one axis.
    static double strongest() { return 3.3; }
    // Ends all force. Called whenever tuft is gone, has been silent for 20 ms, or says something that is not
    // understood.
    void release() { give({}); }

    Vector position{0.02, 0, 0}, velocity;
    double w = 1, i = 0, j = 0, k = 0;  // orientation
    bool a = false, b = false, c = false;

  private:
    Vector force_;
    Clock::time_point last_ = Clock::now();
};

Json json_of(const Vector& v) {
    return {{"x", v.x}, {"y", v.y}, {"z", v.z}};
}

std::string state_text(const Arm& arm) {
    const Json state = {{"cursor_position", json_of(arm.position)}, {"cursor_velocity", json_of(arm.velocity)}};
    const Json turn = {{"w", arm.w}, {"x", arm.i}, {"y", arm.j}, {"z", arm.k}};
    const Json grip = {{"orientation", turn}, {"buttons", {{"a", arm.a}, {"b", arm.b}, {"c", arm.c}}}};
    return Json{{"inverse3", {{{"device_id", "bridge"}, {"state", state}}}},
                {"wireless_verse_grip", {{{"device_id", "bridge-grip"}, {"state", grip}}}}}
        .dump();
}

// Reads a force and keeps it within what the motors bear. Returns false for anything else.
bool read_force(const std::string& text, Vector& force) {
    const Json message = Json::parse(text, nullptr, false);
    if (message.is_discarded()) return false;
    const Json values = message.value("/inverse3/0/commands/set_cursor_force/values"_json_pointer, Json());
    if (!values.is_object()) return false;
    double* const parts[] = {&force.x, &force.y, &force.z};
    const char* const names[] = {"x", "y", "z"};
    for (int n = 0; n < 3; ++n) {
        if (!values.contains(names[n]) || !values[names[n]].is_number()) return false;
        const double f = values[names[n]];
        if (!std::isfinite(f)) return false;
        *parts[n] = std::clamp(f, -Arm::strongest(), Arm::strongest());
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
    bool gone = false, reading = false, writing = false;
    beast::flat_buffer buffer;
    std::string text;
    client.async_accept([&](beast::error_code error) { gone = static_cast<bool>(error); });
    Clock::time_point heard = Clock::now(), due = heard;
    bool may_send = true;
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
                Vector force;
                if (error) return static_cast<void>(gone = true);
                if (read_force(beast::buffers_to_string(buffer.data()), force))
                    arm.give(force);
                else
                    arm.release();
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

int main(int argc, char** argv) {
    const int port = argc > 1 ? std::atoi(argv[1]) : 10001;
    try {
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
}
