#pragma once

#include <array>
#include <memory>
#include <vector>

#include "haptic/device/device.h"
#include "haptic/hair_solver.h"
#include "haptic/recording.h"
#include "haptic/servo.h"

/// \file
/// The loop by the wall clock: a servo that reads the arm, steps the law and sends the force each millisecond, and a
/// solver that bends the hair, each in a thread of its own. The servo waits for the answer to its own pose up to
/// 0.6 ms, then goes on with the last one. It never waits for painting, drawing, disk or memory.
///
/// Servo: SCHED_FIFO 20, solver: SCHED_FIFO 10, where the system allows it (CAP_SYS_NICE or `ulimit -r`).
namespace tuft::haptic {

/// How late something was, counted in bins of 0.1 ms, the last one open.
struct LatenessHistogram {
    static constexpr std::size_t kBins = 41;
    std::array<std::uint64_t, kBins> bins{};
    std::uint64_t count = 0, late = 0;  ///< all, and those over 1 ms
    double worst = 0;                   ///< s

    void add(double seconds);
    /// Upper bound of the bin below which this share lies, s.
    double quantile(double share) const;
};

/// Options of the loop.
struct LoopOptions {
    LawOptions law;
    int servo_priority = 20, solver_priority = 10;  ///< SCHED_FIFO; 0: as other threads
    bool record = false;                            ///< keeps each period for `take_recording`
    /// Returns how much memory the calling thread has allocated so far, in calls; null: not counted.
    std::uint64_t (*count_allocations)() = nullptr;
};

/// Counts since the loop was started.
struct LoopCounts {
    std::uint64_t periods = 0, solves = 0;
    std::uint64_t late_solves = 0;  ///< answers that came after 0.6 ms
    std::uint64_t lost_poses = 0;   ///< that did not fit into the queue to the painting
    std::uint64_t unconverged = 0;  ///< solves that ended at their limits
    std::uint64_t allocations = 0;  ///< of both threads since their first period
    LatenessHistogram cycle;        ///< from the time a period is due to its force being sent
};

/// A snapshot of the loop.
struct LoopStatus {
    bool running = false;
    bool realtime = false;  ///< both threads have their priority
    bool locked = false;    ///< memory stays in RAM
    bool engaged = false;   ///< the law runs
    bool hard = false;      ///< ferrule or handle is on the surface
    Fault fault = Fault::none;
    double pass = 0;            ///< 0–1, share of the force that safety lets out
    Vec3 force{0};              ///< N, on the hand, world
    Vec3 root{0};               ///< m, of the tuft, world
    Quat rotation{1, 0, 0, 0};  ///< of the holder, world
    Vec3 arm{0};                ///< x, m, world
    Vec3 device{0};             ///< m, arm's frame: the same place
    Quat grip{1, 0, 0, 0};      ///< arm's frame
    std::uint32_t buttons = 0;  ///< of the grip, one bit each
    LoopCounts counts;
};

/// Servo and solver as threads. `device` must outlive the loop.
class Loop {
  public:
    Loop(Device& device, HairSolver solver, const LoopOptions& options);
    ~Loop();
    Loop(const Loop&) = delete;
    Loop& operator=(const Loop&) = delete;

    /// Starts both threads.
    void start();
    /// Sends no force and ends both threads. The poses solved so far stay in their queue.
    void stop();

    // One thread, the owner's:
    void set_control(const ServoControl& control);
    /// Ends an emergency; first set a control that asks for none.
    void release();
    void set_law(const LawOptions& law);
    /// What the stroke has made of the hair, see `HairSolver::set_ink`.
    void set_ink(double wetness, double ink_left);
    /// What is felt besides hair; a recording keeps it.
    void set_added(const AddedForces& added);
    LoopStatus status();
    /// The sizes of the force in the last 3 s, N, oldest first.
    std::vector<float> recent_forces() const;

    /// The poses that were solved, in order: the stroke. One thread, the painting's. Holds 4 s of them.
    bool pop(SolvedPose& pose);
    /// After `stop`: all periods, with `LoopOptions::record`.
    std::vector<RecordedPeriod> take_recording();

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace tuft::haptic
