#include "stroke/deposit/film_clock.h"

namespace tuft::stroke {
namespace {

constexpr double kFilmStep = 0.05;    // seconds: the film moves by less than a texel meanwhile
constexpr double kLevelEvery = 0.25;  // seconds: ripples that take less are gone at the next step

}  // namespace

void FilmClock::pass(double seconds) {
    if (!wet_.film) return;
    behind_ += seconds;
    if (behind_ >= kFilmStep) step(false);
}

void FilmClock::step(bool ends) {
    if (!wet_.film) return;
    ink::FilmParams params = wet_.params;
    params.ripples.unlevelled = unlevelled_;
    params.drying.goes_on = goes_on_;
    params.ripples.level = ends || unlevelled_ + behind_ >= kLevelEvery;
    wet_.film->advance(
        target_.canvas(), behind_, params, [this](std::uint32_t slot) { target_.snapshot(slot); }, progress_);
    unlevelled_ = params.ripples.level ? 0 : unlevelled_ + behind_;
    behind_ = 0;
    goes_on_ = true;
}

}  // namespace tuft::stroke
