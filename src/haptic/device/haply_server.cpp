#include <pthread.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <optional>

#include "core/error.h"
#include "haptic/device/haply.h"
#include "haptic/device/haply_messages.h"

namespace tuft::haptic {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kLook = 100ms;

/// What it simulates is a device of its own, which no program on this machine makes late.
void take_priority() {
    const sched_param param{.sched_priority = 22};  // above the client's
    ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &param);
}

/// The arm, moved on by the wall clock from its first client on, with or without one.
struct RunningArm {
    SimulatedArm arm;
    bool began = false;
    Clock::time_point begin{};

    double now() const { return std::chrono::duration<double>(Clock::now() - begin).count(); }
    void start() {
        if (!std::exchange(began, true)) begin = Clock::now();
    }
    void advance() {
        if (!began) return;
        constexpr double kCatchUp = 0.1;  // s
        const double behind = now() - arm.time();
        if (behind > kCatchUp)
            begin += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(behind - kCatchUp));
        arm.advance(now());
    }
};

/// One client. A timer sends a state each period after a command has come; commands are read as they come.
class Client {
  public:
    Client(asio::io_context& io, tcp::socket socket, RunningArm& arm, const ServerOptions& options)
        : ws_(std::move(socket)), timer_(io), arm_(arm), options_(options) {
        ws_.read_message_max(kLongestMessage);
        beast::error_code error;
        beast::get_lowest_layer(ws_).socket().set_option(tcp::no_delay(true), error);
    }

    void accept() {
        ws_.async_accept([this](beast::error_code error) {
            if (error) return end();
            begin_ = due_ = Clock::now();
            read();
            tick();
        });
    }
    void close() {
        beast::error_code error;
        beast::get_lowest_layer(ws_).socket().close(error);
        timer_.cancel();
    }
    bool ended() const { return ended_; }

  private:
    void end() {
        ended_ = true;
        timer_.cancel();
    }
    bool faulty(ServerFault fault) const {
        const bool is = options_.fault == fault &&
                        std::chrono::duration<double>(Clock::now() - begin_).count() > options_.fault_after;
        if (is && options_.faulty) *options_.faulty = true;
        return is;
    }

    void read() {
        ws_.async_read(buffer_, [this](beast::error_code error, std::size_t) {
            if (error) return end();
            DeviceCommand command;
            if (read_haply_command(beast::buffers_to_string(buffer_.data()), command)) {
                arm_.arm.command(command, arm_.now());
                answered_ = true;
            }
            buffer_.consume(buffer_.size());
            read();
        });
    }

    std::string next_text() {
        HaplyState state{"SIMULATED", arm_.arm.measure()};
        if (faulty(ServerFault::jumps)) state.state.position.x += (++jumps_ & 1) ? 0.05 : 0;
        std::string text = haply_state_text(state);
        if (faulty(ServerFault::not_a_number))
            text = R"({"inverse3":[{"device_id":"SIMULATED","state":{"cursor_position":{"x":NaN,"y":0,"z":0}}}]})";
        return text;
    }

    void tick() {
        arm_.advance();
        if (faulty(ServerFault::dies)) return end();
        if (faulty(ServerFault::silent) && silent_from_ == Clock::time_point{}) silent_from_ = Clock::now();
        const bool silent = silent_from_ != Clock::time_point{} && Clock::now() - silent_from_ < 30ms;
        const bool flood = faulty(ServerFault::floods);
        if (!writing_ && !silent && (answered_ || flood)) {
            answered_ = false;
            writing_ = true;
            text_ = next_text();
            ws_.text(true);
            ws_.async_write(asio::buffer(text_), [this](beast::error_code error, std::size_t) {
                writing_ = false;
                if (error) end();
            });
        }
        const auto period = std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(flood ? 1e-6 : 1 / options_.rate));
        due_ = std::max(due_ + period, Clock::now() - 10 * period);
        timer_.expires_at(due_);
        timer_.async_wait([this](beast::error_code error) {
            if (!error && !ended_) tick();
        });
    }

    websocket::stream<beast::tcp_stream> ws_;
    asio::steady_timer timer_;
    RunningArm& arm_;
    const ServerOptions& options_;
    beast::flat_buffer buffer_;
    std::string text_;
    Clock::time_point begin_{}, due_{}, silent_from_{};
    bool ended_ = false, writing_ = false, answered_ = true;
    unsigned jumps_ = 0;
};

}  // namespace

void serve_simulated(SimulatedArm arm, const ServerOptions& options, const std::function<bool()>& go_on,
                     const std::function<void(int port)>& ready, std::atomic<double>* force) {
    asio::io_context io;
    tcp::acceptor acceptor(io);
    const tcp::endpoint endpoint(asio::ip::address_v4::loopback(), static_cast<unsigned short>(options.port));
    beast::error_code error;
    acceptor.open(endpoint.protocol(), error);
    acceptor.set_option(asio::socket_base::reuse_address(true), error);
    acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(1, error);
    if (error) throw Error(Message("port {} is taken: end what listens there, or choose another", options.port));
    if (ready) ready(acceptor.local_endpoint().port());
    if (options.fault != ServerFault::floods) take_priority();
    RunningArm running{std::move(arm)};
    std::optional<tcp::socket> next;
    const std::function<void()> wait = [&] {
        acceptor.async_accept([&](beast::error_code failed, tcp::socket socket) {
            if (!failed) next.emplace(std::move(socket));
        });
    };
    std::optional<Client> client;
    wait();
    bool served = true;
    while (served && go_on()) {
        const Clock::time_point until = Clock::now() + kLook;
        while (Clock::now() < until) {
            io.restart();
            io.run_for(1ms);
            if (!client) running.advance();
            if (force) *force = glm::length(running.arm.force());
            if (client && client->ended()) {
                client->close();
                io.restart();
                io.poll();
                client.reset();
                wait();
                if (options.fault == ServerFault::dies) served = false;
            }
            if (next && !client) {
                running.start();
                client.emplace(io, std::move(*next), running, options);
                next.reset();
                client->accept();
            }
        }
    }
    acceptor.close(error);
    if (client) client->close();
    for (const Clock::time_point until = Clock::now() + kLook; Clock::now() < until;) {  // the motors' watchdog
        io.restart();
        io.poll();
        running.advance();
        if (force) *force = glm::length(running.arm.force());
        io.run_for(5ms);
    }
}

}  // namespace tuft::haptic
