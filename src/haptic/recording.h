#pragma once

#include <atomic>
#include <filesystem>
#include <iosfwd>
#include <span>
#include <string_view>
#include <vector>

#include "haptic/hair_solver.h"
#include "haptic/servo.h"

/// \file
/// A session of an arm as a table, written by `tuft device record`: what came from the arm in each period, which
/// answer was used, and the force. Played again it gives the same forces to the bit, however late the solver was.
namespace tuft::haptic {

/// One period of the servo.
struct RecordedPeriod {
    std::uint64_t tick = 0;
    bool fresh = false;        ///< a state came
    DeviceState state;         ///< arm's frame
    ServoControl control;      ///< of its flags; the workspace is that of the first period
    std::uint64_t answer = 0;  ///< tick of the answer that was the newest; 0: none
    bool solved = false;       ///< the pose of this period was solved
    Vec3 force{0};             ///< N, on the hand, world
    AddedForces added;         ///< besides the hair's
};

/// Reads numbers with commas between them. Returns false unless the line holds just so many.
bool read_row(std::string_view line, std::span<double> values);

/// Writes columns tick,fresh,x,y,z,qw,qx,qy,qz,buttons,control,answer,solved,fx,fy,fz with all digits. `control`: 1
/// paused, 2 emergency, 4 clutched. Where there are added forces, proximity,yield follow in N and Pa.
void write_recording(std::ostream& out, std::span<const RecordedPeriod> periods);
/// Reads such a table. Throws `Error` with file and line.
std::vector<RecordedPeriod> read_recording(const std::filesystem::path& file);

/// Runs the servo and the solver through a recording, with the added forces of the recording; returns the force of each
/// period, N, world.
std::vector<Vec3> replay_forces(std::span<const RecordedPeriod> periods, HairSolver solver, const LawOptions& law,
                                const Workspace& workspace = {});

/// A recording as a device: its states come by the wall clock, a millisecond a tick.
class ReplayDevice : public Device {
  public:
    ReplayDevice(const DeviceLimits& limits, std::vector<RecordedPeriod> periods);
    const DeviceLimits& limits() const override { return limits_; }
    bool read(DeviceState& state) noexcept override;
    void send(const DeviceCommand&) noexcept override {}
    bool open() const override { return next_ < periods_.size(); }

  private:
    DeviceLimits limits_;
    std::vector<RecordedPeriod> periods_;
    std::atomic<std::size_t> next_{0};
    std::int64_t begin_ = 0;  // ns
};

}  // namespace tuft::haptic
