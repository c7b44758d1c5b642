#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>

#include "haptic/device/device.h"
#include "haptic/device/simulated.h"

/// \file
/// The arm behind the Haply Inverse service or any bridge that speaks its protocol (haply_messages.h), and a server
/// that speaks it for the simulated arm.
namespace tuft::haptic {

inline constexpr int kHaplyPort = 10001;  ///< of the service

/// Address of the service.
struct HaplyAddress {
    std::string host = "127.0.0.1";
    int port = kHaplyPort;
};

/// Client. A thread of its own connects, reads, parses and answers each state with the newest force; while there is no
/// service it tries again every second. States come as fast as the service sends them: the newest counts. A message
/// that is broken, too long, or comes faster than 20 kHz is dropped; after 1,000 such in a row the connection is closed
/// and made anew. Its thread has SCHED_FIFO 21 where the system allows it.
class HaplyDevice : public Device {
  public:
    HaplyDevice(const DeviceLimits& limits, const HaplyAddress& address);
    ~HaplyDevice() override;
    const DeviceLimits& limits() const override;
    bool read(DeviceState& state) noexcept override;
    void send(const DeviceCommand& command) noexcept override;
    Message trouble() const override;
    bool open() const override { return true; }
    /// Whether a state has come over the present connection.
    bool connected() const;
    /// Messages that were dropped so far.
    std::uint64_t dropped() const;
    /// Id of the arm that speaks, once connected.
    std::string device_id() const;

  private:
    struct State;
    std::unique_ptr<State> state_;
};

/// What a server of the simulated arm does wrong on purpose, for tests.
enum class ServerFault { none, dies, not_a_number, jumps, silent, floods };

/// Options of the simulated service.
struct ServerOptions {
    int port = kHaplyPort;                  ///< 0: any free one
    double rate = 1000;                     ///< states per second
    ServerFault fault = ServerFault::none;  ///< begins `fault_after` seconds after a client has come
    double fault_after = 1;                 ///< s
    std::atomic<bool>* faulty = nullptr;    ///< true from when the fault has begun
};

/// Serves a simulated arm on 127.0.0.1, whose time begins with the first client, one client at a time, until `go_on`
/// returns false; it is asked ten times a second. `ready` is called with the port. Without a command for 20 ms the
/// arm's motors are off. The calling thread has SCHED_FIFO 22 from then on where the system allows it, but for a flood.
/// Throws `Error` where the port is taken. `force`, if given, always holds the size of the arm's force, N.
void serve_simulated(SimulatedArm arm, const ServerOptions& options, const std::function<bool()>& go_on,
                     const std::function<void(int port)>& ready, std::atomic<double>* force = nullptr);

}  // namespace tuft::haptic
