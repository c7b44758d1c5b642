#pragma once

#include <filesystem>

/// \file
/// Stopping the whole program. A signal concerns the process, so its mark is one for the process;
/// `cli` sets it, and long loops look at it, below any `Progress` callback and without one.
namespace tuft {

/// Asks all work of the process to stop. May be called from any thread.
void request_interrupt() noexcept;

/// Whether that was asked for. One relaxed load.
bool interrupted() noexcept;

/// Throws `Cancelled` once it was. Loops whose pass may take a tenth of a second call it in each.
void check_interrupt();

/// Files and folders that are half-written, to be removed where the program is ended without
/// unwinding. The path is in the list as long as the object lives.
class Unfinished {
  public:
    explicit Unfinished(std::filesystem::path path);
    ~Unfinished();
    Unfinished(const Unfinished&) = delete;
    Unfinished& operator=(const Unfinished&) = delete;

  private:
    std::filesystem::path path_;
};

/// Removes all that are listed; the program must end after that. Waits for none of the threads that
/// write them.
void remove_unfinished() noexcept;

}  // namespace tuft
