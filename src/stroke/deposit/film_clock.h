#pragma once

#include "core/system/progress.h"
#include "ink/film/film.h"
#include "stroke/deposit/stamp_target.h"

/// \file
/// Time of the wet film during a stroke. Called by deposit models for wet ink.

namespace tuft::stroke {

/// The film of wet ink in use, with its parameters. Null: ink stays where it is deposited.
struct WetFilmInUse {
    ink::WetFilm* film = nullptr;
    ink::FilmParams params;
};

/// Advances the film with the time of a stroke, in steps of at least 50 ms; its ripples level every 250 ms and when the
/// stroke ends, since a solve for all of them costs as much as several steps. Without a film it does nothing.
class FilmClock {
  public:
    FilmClock(StampTarget& target, const WetFilmInUse& wet, ProgressFn progress)
        : target_(target), wet_(wet), progress_(std::move(progress)) {}

    /// Adds time; advances the film once 50 ms have gathered. Throws `Cancelled` when `progress` stops it.
    void pass(double seconds);
    /// Advances the film by the time that is left.
    void catch_up() { step(true); }

  private:
    void step(bool ends);

    StampTarget& target_;
    WetFilmInUse wet_;
    ProgressFn progress_;
    double behind_ = 0;      // seconds
    double unlevelled_ = 0;  // seconds in which ripples have not levelled yet
    bool goes_on_ = false;   // the film was advanced before
};

}  // namespace tuft::stroke
