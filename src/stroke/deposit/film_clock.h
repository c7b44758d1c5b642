#pragma once

#include "core/system/progress.h"
#include "ink/film/film.h"
#include "stroke/deposit/stamp_target.h"

namespace tuft::stroke {

/// Wet ink's film and what it flows by; null film: ink stays where it is put.
struct WetFilmInUse {
    ink::WetFilm* film = nullptr;
    ink::FilmParams params;
};

/// Lets the film flow as the time of a stroke goes by, in steps of 50 ms. Does nothing without a film.
class FilmClock {
  public:
    FilmClock(StampTarget& target, const WetFilmInUse& wet, ProgressFn progress)
        : target_(target), wet_(wet), progress_(std::move(progress)) {}

    void pass(double seconds);
    /// Steps what has not been stepped yet.
    void catch_up();

  private:
    StampTarget& target_;
    WetFilmInUse wet_;
    ProgressFn progress_;
    double behind_ = 0;  // seconds
};

}  // namespace tuft::stroke
