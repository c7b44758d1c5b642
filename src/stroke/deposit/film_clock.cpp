#include "stroke/deposit/film_clock.h"

namespace tuft::stroke {
namespace {

constexpr double kFilmStep = 0.05;  // seconds: the film moves by less than a texel meanwhile

}  // namespace

void FilmClock::pass(double seconds) {
    if (!wet_.film) return;
    behind_ += seconds;
    if (behind_ >= kFilmStep) catch_up();
}

void FilmClock::catch_up() {
    if (!wet_.film) return;
    wet_.film->advance(
        target_.canvas(), behind_, wet_.params, [this](std::uint32_t slot) { target_.snapshot(slot); }, progress_);
    behind_ = 0;
}

}  // namespace tuft::stroke
