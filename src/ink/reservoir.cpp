#include "ink/reservoir.h"

#include <algorithm>
#include <cmath>

namespace tuft::ink {
namespace {

/// Part of the supply that comes without any bending: hair wets what it touches.
constexpr double kCapillarySupply = 0.25;

}  // namespace

double Reservoir::remaining() const {
    double sum = water;
    for (const double p : pigment) sum += p;
    return sum;
}

double Reservoir::fullness() const {
    return capacity > 0 ? remaining() / capacity : 0;
}

Mix Reservoir::mix() const {
    Mix parts{};
    const double left = remaining();
    if (left > 0)
        for (int p = 0; p < kMaxPigments; ++p) parts[p] = static_cast<float>(pigment[p] / left);
    return parts;
}

Reservoir make_reservoir(double millilitres) {
    Reservoir tuft;
    tuft.capacity = film_of_millilitres(millilitres);
    return tuft;
}

double dip(Reservoir& tuft, const Mix& mix) {
    const double room = std::max(0.0, tuft.capacity - tuft.remaining());
    double pigments = 0;
    for (int p = 0; p < kMaxPigments; ++p) {
        const double amount = room * static_cast<double>(mix[p]);
        tuft.pigment[p] += amount;
        pigments += amount;
    }
    tuft.water += std::max(0.0, room - pigments);
    return room;
}

double rinse(Reservoir& tuft) {
    const double left = tuft.remaining();
    tuft.pigment.fill(0);
    tuft.water = 0;
    return left;
}

void take(Reservoir& tuft, double amount) {
    const double left = tuft.remaining();
    if (!(left > 0)) return;
    const double keep = std::clamp(1 - amount / left, 0.0, 1.0);
    for (double& p : tuft.pigment) p *= keep;
    tuft.water *= keep;
}

double paper_quantity(double eta, double moment_factor, double remaining) {
    return eta * moment_factor * remaining;
}

double supply_quantity(double eta, double moment_factor, double remaining, double ds,
                       double supply_length) {
    return -remaining * std::expm1(-eta * moment_factor * ds / supply_length);
}

DepositParams stamp_deposit(const Reservoir& tuft, const Ink& ink, const StampContact& contact,
                            const Substrate& substrate) {
    DepositParams out;
    out.transfer_length = static_cast<float>(ink.transfer_length);
    out.capacity = substrate.capacity;
    out.extinction = extinction_of(ink);
    out.mix = tuft.mix();
    const double left = tuft.remaining();
    if (!(left > 0)) {
        out.target = 0;
        return out;
    }
    const double k = std::clamp(contact.moment_factor, 0.0, 1.0);
    const double squeezed = kCapillarySupply + (1 - kCapillarySupply) * k;
    const double offered = ink.supply * squeezed * left / ink.supply_length;  // film·m² per metre
    const double asked = ink.film * contact.width;
    double target = ink.film * std::min(1.0, 0.85 + 0.3 * k);
    if (asked > 0) target *= -std::expm1(-offered / asked);
    if (contact.area > 0) target = std::min(target, left / contact.area);
    out.target = static_cast<float>(target);
    return out;
}

}  // namespace tuft::ink
