#include "haptic/loop.h"

#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <time.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <map>
#include <thread>

#include "core/system/clock.h"
#include "core/system/recycled.h"
#include "haptic/device/exchange.h"

namespace tuft::haptic {
namespace {

constexpr long kPeriodNs = 1'000'000, kWaitNs = 600'000;
constexpr std::size_t kRecent = 3000;  // periods of the plot

timespec timespec_of(std::int64_t ns) {
    return {.tv_sec = ns / 1'000'000'000, .tv_nsec = ns % 1'000'000'000};
}

class Semaphore {
  public:
    Semaphore() { ::sem_init(&sem_, 0, 0); }
    ~Semaphore() { ::sem_destroy(&sem_); }
    Semaphore(const Semaphore&) = delete;
    Semaphore& operator=(const Semaphore&) = delete;
    void post() { ::sem_post(&sem_); }
    void wait() {
        while (::sem_wait(&sem_) != 0) {
        }
    }
    bool wait_until(std::int64_t ns) {
        const timespec until = timespec_of(ns);
        return ::sem_clockwait(&sem_, CLOCK_MONOTONIC, &until) == 0;
    }

  private:
    sem_t sem_;
};

bool take_priority(int priority) {
    if (priority <= 0) return false;
    const sched_param param{.sched_priority = priority};
    return ::pthread_setschedparam(::pthread_self(), SCHED_FIFO, &param) == 0;
}

/// Writes to each page of the stack that a period may need. No page fault occurs later.
void prefault_stack() {
    volatile unsigned char pages[256 * 1024];
    for (std::size_t i = 0; i < sizeof pages; i += 4096) pages[i] = 0;
}

struct Ink {
    double wetness = 1, left = 1;
};

/// The newest value of each kind, from thread to thread.
struct Latest {
    TripleBuffer<RootPose> pose;
    TripleBuffer<HairAnswer> answer;
    TripleBuffer<ServoControl> control;
    TripleBuffer<LawOptions> law;
    TripleBuffer<Ink> ink;
    TripleBuffer<AddedForces> added;
    TripleBuffer<LoopStatus> status;
};

/// The force of the last periods, for a plot.
struct RecentForces {
    std::array<std::atomic<float>, kRecent> ring{};
    std::atomic<std::uint64_t> n{0};
};

/// A period whose pose was solved.
struct SolvedTick {
    std::uint64_t tick = 0;
    AddedForces added;
};

struct Record {
    BoundedQueue<RecordedPeriod, 4096> periods;
    BoundedQueue<SolvedTick, 4096> solved_ticks;
    std::vector<RecordedPeriod> recording;  // of the record's thread until it ends
    std::map<std::uint64_t, AddedForces> recorded_ticks;

    void drain();
};

struct Counts {
    std::atomic<int> with_priority{0};
    std::atomic<std::uint64_t> unconverged{0}, solver_allocations{0};
};

}  // namespace

void LatenessHistogram::add(double seconds) {
    const auto bin = static_cast<std::size_t>(std::max(0.0, seconds) * 1e4);
    ++bins[std::min(bin, kBins - 1)];
    ++count;
    late += seconds > kPeriod;
    worst = std::max(worst, seconds);
}

double LatenessHistogram::quantile(double share) const {
    const double most = share * static_cast<double>(count);
    double sum = 0;
    for (std::size_t i = 0; i < kBins; ++i) {
        sum += static_cast<double>(bins[i]);
        if (sum >= most) return i + 1 < kBins ? 1e-4 * static_cast<double>(i + 1) : worst;
    }
    return worst;
}

struct Loop::State {
    struct Signals {
        Semaphore posed, answered;
    };
    struct Threads {
        std::thread servo, solver, record;
    };

    Device& device;
    HairSolver solver;
    LoopOptions options;
    Servo servo;
    std::atomic<bool> running{false}, released{false};
    Signals signals;
    Latest latest;
    BoundedQueue<SolvedPose, 4096> solved;
    Counts counts;
    RecentForces recent;
    Record record;
    Threads threads;
    LoopStatus seen;
    bool locked = false;

    State(Device& d, HairSolver s, const LoopOptions& o) : device(d), solver(std::move(s)), options(o), servo(o.law) {}
    std::uint64_t allocations() const { return options.count_allocations ? options.count_allocations() : 0; }
    void run_servo();
    void report(LoopStatus& now, const ServoOutput& out, const RootPose& asked, const DeviceState* state);
    void remember_force(const Vec3& force);
    void run_solver();
    void run_record();
    bool wait_for_answer(std::uint64_t tick, std::int64_t until, HairAnswer& newest, bool& any);
};

// Returns whether the answer to this period's pose has come.
bool Loop::State::wait_for_answer(std::uint64_t tick, std::int64_t until, HairAnswer& newest, bool& any) {
    for (;;) {
        any = latest.answer.read(newest) || any;
        if (any && newest.pose.tick == tick) return true;
        if (!signals.answered.wait_until(until)) return false;
    }
}

// What a period did, for those who watch the loop.
void Loop::State::report(LoopStatus& now, const ServoOutput& out, const RootPose& asked, const DeviceState* state) {
    now.engaged = out.engaged;
    now.hard = out.hard;
    now.fault = out.fault;
    now.pass = out.pass;
    now.force = out.force;
    now.root = out.root;
    now.rotation = asked.rotation;
    now.arm = out.arm;
    now.device = out.device;
    if (state) {
        now.grip = state->rotation;
        now.buttons = state->buttons;
    }
    ++now.counts.periods;
    now.realtime = counts.with_priority.load() == 2;
    now.counts.lost_poses = solved.overflow();
    now.counts.unconverged = counts.unconverged.load(std::memory_order_relaxed);
    latest.status.write(now);
}

void Loop::State::remember_force(const Vec3& force) {
    const std::uint64_t n = recent.n.load(std::memory_order_relaxed);
    recent.ring[n % kRecent].store(static_cast<float>(glm::length(force)), std::memory_order_relaxed);
    recent.n.store(n + 1, std::memory_order_release);
}

void Loop::State::run_servo() {
    counts.with_priority += take_priority(options.servo_priority);
    prefault_stack();
    LoopStatus now{.running = true, .locked = locked};
    ServoControl wanted;
    HairAnswer newest;
    bool any = false;
    LawOptions fresh_law;
    const std::int64_t begin = clock_ns();
    std::int64_t due = begin + kPeriodNs;
    std::uint64_t tick = 0;
    const std::uint64_t allocated = allocations();
    while (running.load(std::memory_order_relaxed)) {
        const timespec until = timespec_of(due);
        ::clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);
        tick = std::max<std::uint64_t>(tick + 1, static_cast<std::uint64_t>((clock_ns() - begin) / kPeriodNs));
        DeviceState state;
        const bool fresh = device.read(state);
        const bool release = released.exchange(false);  // before the control that no longer asks for the emergency
        latest.control.read(wanted);
        if (latest.law.read(fresh_law)) servo.set_options(fresh_law);
        if (release) servo.release();
        const RootPose asked = servo.begin(tick, fresh ? &state : nullptr, wanted);
        if (servo.engaged()) {
            latest.pose.write(asked);
            signals.posed.post();
            now.counts.late_solves += !wait_for_answer(tick, due + kWaitNs, newest, any);
            ++now.counts.solves;
        }
        const ServoOutput out = servo.finish(any ? &newest : nullptr);
        device.send(out.command);
        now.counts.cycle.add(1e-9 * static_cast<double>(clock_ns() - due));
        now.counts.allocations = allocations() - allocated + counts.solver_allocations.load(std::memory_order_relaxed);
        report(now, out, asked, fresh ? &state : nullptr);
        remember_force(out.force);
        if (options.record) {
            ServoControl done = wanted;
            done.clutched = servo.clutched();
            record.periods.push({.tick = tick,
                                 .fresh = fresh,
                                 .state = state,
                                 .control = done,
                                 .answer = any ? newest.pose.tick : 0,
                                 .force = out.force});
        }
        due = std::max(due + kPeriodNs, begin + (clock_ns() - begin) / kPeriodNs * kPeriodNs);
    }
    device.send({});
    now.running = now.engaged = false;
    now.force = Vec3{0};
    latest.status.write(now);
}

/// Blocks for the solver's thread. What trials at rims, edges and a shut line held at most at once: of 512 bytes 46 for
/// one spine, 565 for nine; of 8 kB 15 and 117; of 16 kB 3 and 31; of 32 kB 4 and 11, 24 for five; of 64 to 256 kB 4.
/// Up to 64 kB at least 1.5 times of it are there, above twice.
void fill_store(int spines) {
    fill_block_store(1024, 64 * spines);
    fill_block_store(std::size_t{8} * 1024, 32 * spines);
    fill_block_store(std::size_t{64} * 1024, 48);
    fill_block_store(std::size_t{256} * 1024, 8);
}

void Loop::State::run_solver() {
    counts.with_priority += take_priority(options.solver_priority);
    prefault_stack();
    fill_store(static_cast<int>(solver.tuft().spines.size()));
    const std::uint64_t allocated = allocations();
    while (true) {
        signals.posed.wait();
        if (!running.load(std::memory_order_relaxed)) return;
        RootPose asked;
        if (!latest.pose.read(asked)) continue;
        Ink fresh;
        if (latest.ink.read(fresh)) solver.set_ink(fresh.wetness, fresh.left);
        AddedForces added;
        if (latest.added.read(added)) solver.set_added(added);
        const HairAnswer found = solver.solve(asked);
        latest.answer.write(found);
        signals.answered.post();
        counts.solver_allocations.store(allocations() - allocated, std::memory_order_relaxed);
        if (!found.converged) counts.unconverged.fetch_add(1, std::memory_order_relaxed);
        solved.push({asked, found.touching});
        if (options.record) record.solved_ticks.push({asked.tick, solver.added()});
    }
}

void Record::drain() {
    RecordedPeriod period;
    while (periods.pop(period)) recording.push_back(period);
    SolvedTick solved;
    while (solved_ticks.pop(solved)) recorded_ticks[solved.tick] = solved.added;
}

void Loop::State::run_record() {
    while (running.load(std::memory_order_relaxed)) {
        record.drain();
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
}

Loop::Loop(Device& device, HairSolver solver, const LoopOptions& options)
    : state_(std::make_unique<State>(device, std::move(solver), options)) {}

Loop::~Loop() {
    stop();
}

void Loop::start() {
    State& s = *state_;
    if (s.running.exchange(true)) return;
    // Pages that are there stay; later ones are not counted against the limit, so that painting gets its memory.
    s.locked = ::mlockall(MCL_CURRENT | MCL_ONFAULT) == 0;
    s.threads.solver = std::thread([&s] { s.run_solver(); });
    s.threads.servo = std::thread([&s] { s.run_servo(); });
    if (s.options.record) s.threads.record = std::thread([&s] { s.run_record(); });
}

void Loop::stop() {
    State& s = *state_;
    if (!s.running.exchange(false)) return;
    s.threads.servo.join();
    s.signals.posed.post();
    s.threads.solver.join();
    if (s.threads.record.joinable()) s.threads.record.join();
    s.record.drain();
    if (s.locked) ::munlockall();
}

void Loop::set_control(const ServoControl& control) {
    state_->latest.control.write(control);
}

void Loop::release() {
    state_->released = true;
}

void Loop::set_law(const LawOptions& law) {
    state_->latest.law.write(law);
}

void Loop::set_ink(double wetness, double ink_left) {
    state_->latest.ink.write({wetness, ink_left});
}

void Loop::set_added(const AddedForces& added) {
    state_->latest.added.write(added);
}

LoopStatus Loop::status() {
    state_->latest.status.read(state_->seen);
    return state_->seen;
}

std::vector<float> Loop::recent_forces() const {
    const std::uint64_t end = state_->recent.n.load(std::memory_order_acquire);
    std::vector<float> out;
    for (std::uint64_t i = end > kRecent ? end - kRecent : 0; i < end; ++i)
        out.push_back(state_->recent.ring[i % kRecent].load(std::memory_order_relaxed));
    return out;
}

bool Loop::pop(SolvedPose& pose) {
    return state_->solved.pop(pose);
}

std::vector<RecordedPeriod> Loop::take_recording() {
    for (RecordedPeriod& period : state_->record.recording) {
        const auto solved = state_->record.recorded_ticks.find(period.tick);
        period.solved = solved != state_->record.recorded_ticks.end();
        if (period.solved) period.added = solved->second;
    }
    return std::move(state_->record.recording);
}

}  // namespace tuft::haptic
