#include "haptic/device/haply.h"

#include <pthread.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <mutex>
#include <thread>

#include "core/error.h"
#include "core/text/text.h"
#include "haptic/device/exchange.h"
#include "haptic/device/haply_messages.h"

namespace tuft::haptic {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace websocket = beast::websocket;
using tcp = asio::ip::tcp;
using Clock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kRetry = 1000ms, kLook = 20ms;
constexpr auto kSilence = 2s;
constexpr auto kFastest = 50us;         // between two messages that are read: 20 kHz
constexpr int kMostDropped = 1000;      // in a row
constexpr auto kOldCommand = 20ms;      // after which the servo has fallen silent: no force
constexpr int kTransportPriority = 21;  // SCHED_FIFO, above the servo's: its work is short

struct TimedCommand {
    DeviceCommand command;
    std::int64_t at = 0;  // ns of the clock
};

websocket::stream_base::timeout timeouts() {
    return {.handshake_timeout = kSilence, .idle_timeout = kSilence, .keep_alive_pings = false};
}

asio::ip::address address_of(const HaplyAddress& address) {
    beast::error_code error;
    const auto found = asio::ip::make_address(address.host == "localhost" ? "127.0.0.1" : address.host, error);
    if (error) throw Error(Message("'{}' is not an address such as 127.0.0.1", excerpt(address.host)));
    return found;
}

}  // namespace

struct HaplyDevice::State {
    DeviceLimits limits;
    tcp::endpoint endpoint;
    std::atomic<bool> stop{false}, connected{false};
    std::atomic<std::uint64_t> dropped{0};
    TripleBuffer<DeviceState> states;
    TripleBuffer<TimedCommand> commands;
    mutable std::mutex texts;  // of transport and window; the servo takes it never
    Message trouble;
    std::string id;
    std::thread thread;

    void run();
    void set_trouble(Message what) {
        const std::lock_guard lock(texts);
        trouble = std::move(what);
    }
};

namespace {

/// One connection, from the first packet to the last. All handlers run in the transport's thread.
class Connection {
  public:
    Connection(asio::io_context& io, TripleBuffer<DeviceState>& states, TripleBuffer<TimedCommand>& commands,
               std::atomic<std::uint64_t>& dropped)
        : ws_(io), states_(states), commands_(commands), dropped_(dropped) {
        ws_.read_message_max(kLongestMessage);
        ws_.set_option(timeouts());
    }

    void connect(const tcp::endpoint& endpoint) {
        beast::get_lowest_layer(ws_).expires_after(kSilence);
        beast::get_lowest_layer(ws_).async_connect(endpoint, [this, endpoint](beast::error_code error) {
            if (error) return end("no service answers there");
            beast::get_lowest_layer(ws_).expires_never();
            beast::get_lowest_layer(ws_).socket().set_option(tcp::no_delay(true), error);
            ws_.async_handshake(endpoint.address().to_string() + ":" + std::to_string(endpoint.port()), "/",
                                [this](beast::error_code failed) {
                                    if (failed) return end("what answers there speaks no WebSocket");
                                    read();
                                });
        });
    }
    /// Ends it at once.
    void close() {
        beast::error_code error;
        beast::get_lowest_layer(ws_).socket().close(error);
    }

    bool ended() const { return ended_; }
    bool heard() const { return heard_; }
    const Message& why() const { return why_; }
    const std::string& id() const { return state_.device; }

  private:
    void end(Message why) {
        ended_ = true;
        why_ = std::move(why);
    }

    void read() {
        ws_.async_read(buffer_, [this](beast::error_code error, std::size_t) {
            if (error == beast::error_code(websocket::error::message_too_big))
                return end("the service sent a message that is too long");
            if (error) return end("the connection to the arm's service has ended");
            take();
        });
    }

    void take() {
        const Clock::time_point now = Clock::now();
        const bool too_fast = now - last_ < kFastest;
        const std::string text = too_fast ? std::string() : beast::buffers_to_string(buffer_.data());
        buffer_.consume(buffer_.size());
        if (too_fast || !read_haply_state(text, state_)) {
            ++dropped_;
            if (++dropped_in_row_ > kMostDropped) return end("the arm's service sends what is not understood");
            return read();
        }
        last_ = now;
        dropped_in_row_ = 0;
        heard_ = true;
        state_.state.time = std::chrono::duration<double>(now.time_since_epoch()).count();
        states_.write(state_.state);
        answer(now);
    }

    void answer(Clock::time_point now) {
        commands_.read(command_);
        const bool old = now.time_since_epoch() - std::chrono::nanoseconds(command_.at) > kOldCommand;
        text_ = haply_command_text(state_.device, old ? DeviceCommand{} : command_.command);
        ws_.text(true);
        ws_.async_write(asio::buffer(text_), [this](beast::error_code error, std::size_t) {
            if (error) return end("the connection to the arm's service has ended");
            read();
        });
    }

    websocket::stream<beast::tcp_stream> ws_;
    TripleBuffer<DeviceState>& states_;
    TripleBuffer<TimedCommand>& commands_;
    std::atomic<std::uint64_t>& dropped_;
    beast::flat_buffer buffer_{kLongestMessage};
    HaplyState state_;
    TimedCommand command_;
    std::string text_;
    Message why_;
    Clock::time_point last_{};
    int dropped_in_row_ = 0;
    bool ended_ = false, heard_ = false;
};

}  // namespace

void HaplyDevice::State::run() {
    const sched_param param{.sched_priority = kTransportPriority};
    ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &param);
    while (!stop) {
        asio::io_context io;
        Connection connection(io, states, commands, dropped);
        connection.connect(endpoint);
        while (!stop && !connection.ended()) {
            io.restart();
            io.run_for(kLook);
            if (connection.heard() && !connected) {
                set_trouble({});
                const std::lock_guard lock(texts);
                id = connection.id();
                connected = true;
            }
        }
        connected = false;
        if (connection.ended()) set_trouble(connection.why());
        connection.close();
        io.restart();
        io.run_for(kLook);  // handlers of what was closed
        for (auto waited = 0ms; waited < kRetry && !stop; waited += kLook) std::this_thread::sleep_for(kLook);
    }
}

HaplyDevice::HaplyDevice(const DeviceLimits& limits, const HaplyAddress& address) : state_(std::make_unique<State>()) {
    state_->limits = limits;
    state_->endpoint = {address_of(address), static_cast<unsigned short>(address.port)};
    state_->thread = std::thread([s = state_.get()] { s->run(); });
}

HaplyDevice::~HaplyDevice() {
    state_->stop = true;
    state_->thread.join();
}

const DeviceLimits& HaplyDevice::limits() const {
    return state_->limits;
}

bool HaplyDevice::read(DeviceState& state) noexcept {
    return state_->states.read(state);
}

void HaplyDevice::send(const DeviceCommand& command) noexcept {
    state_->commands.write({command, Clock::now().time_since_epoch().count()});
}

Message HaplyDevice::trouble() const {
    const std::lock_guard lock(state_->texts);
    return state_->trouble;
}

bool HaplyDevice::connected() const {
    return state_->connected;
}

std::uint64_t HaplyDevice::dropped() const {
    return state_->dropped;
}

std::string HaplyDevice::device_id() const {
    const std::lock_guard lock(state_->texts);
    return state_->id;
}

}  // namespace tuft::haptic
