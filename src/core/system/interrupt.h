#pragma once

#include <filesystem>

/// \file
/// Interrupting the whole process. A signal concerns the process, so one flag serves all threads. `cli` sets it.
/// Long loops check it, with or without a `Progress` callback.
namespace tuft {

/// Sets the flag: all work of the process shall stop. Safe from any thread.
void request_interrupt() noexcept;

/// Returns the flag. Cost: one relaxed load.
bool interrupted() noexcept;

/// Throws `Cancelled` when the flag is set. Loops whose iteration may take a tenth of a second call it once per
/// iteration.
void check_interrupt();

/// Registers a half-written file or folder for removal when the program ends without unwinding. The path is
/// registered while the object lives.
class Unfinished {
  public:
    explicit Unfinished(std::filesystem::path path);
    ~Unfinished();
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;

  private:
    std::filesystem::path path_;
};

/// Removes all registered paths. The program must end afterwards. Does not wait for threads that still write to
/// them.
void remove_unfinished() noexcept;

}  // namespace tuft
