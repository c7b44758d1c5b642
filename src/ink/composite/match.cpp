#include "ink/composite/match.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numeric>
#include <set>

#include "core/error.h"
#include "ink/canvas/canvas.h"
#include "ink/spectra/kubelka_munk.h"
#include "ink/spectra/srgb.h"

namespace tuft::ink {
namespace {

constexpr std::size_t kStarts = 60;      // samples that are refined
constexpr std::size_t kStartsOfSet = 3;  // of them of one set of pigments, at most where there are many sets
constexpr std::size_t kPolished = 8;     // of the refined ones that are not the colour yet
constexpr std::size_t kExtended = 10;    // of the refined ones, that get a fourth pigment
constexpr int kSteps = 60;               // of Levenberg–Marquardt, at most
constexpr double kExact = 1e-3;          // ΔE2000 at which a mix is the colour
constexpr double kPolishFrom = 0.05;     // ΔE2000 from which that is worth while
constexpr double kLeastAmount = 1e-4;    // fraction of the least part that an ink file takes

/// The interface of a dry film on a substrate, without the reflection at its outside.
Interface interface_of(const Substrate& substrate) {
    return {.k1 = 0, .k2 = Interface{}.k2 * static_cast<double>(substrate.interface)};
}

/// Reflectance of the bare substrate below its interface.
std::array<double, kBands> bare_bands(const Substrate& substrate) {
    const Bands bare = bands_of_rgb(substrate.reflectance);
    std::array<double, kBands> r;
    for (int b = 0; b < kBands; ++b)
        r[b] = saunderson_inverse(static_cast<double>(bare[b]), interface_of(substrate), false);
    return r;
}

using Colour = std::array<double, 3>;  // linear sRGB

/// Into the gamut as `into_gamut` (spectrum.h) does, in double: differences of colours need its
/// digits.
Colour cut_to_gamut(const Colour& c) {
    const double y = 0.212639 * c[0] + 0.715169 * c[1] + 0.072192 * c[2], grey = std::clamp(y, 0.0, 1.0);
    const auto [low, high] = std::minmax_element(c.begin(), c.end());
    const double part = std::min(*low < 0 ? grey / (grey - *low) : 1.0, *high > 1 ? (1 - grey) / (*high - grey) : 1.0);
    return {grey + (c[0] - grey) * part, grey + (c[1] - grey) * part, grey + (c[2] - grey) * part};
}

/// Colour of a film with K X and S X per band over `bare`.
Colour colour_of(const std::array<double, kBands>& k, const std::array<double, kBands>& s,
                 const std::array<double, kBands>& bare, const Interface& interface) {
    Colour sum{};
    for (int b = 0; b < kBands; ++b) {
        const double seen = saunderson(over(layer(k[b], s[b], 1), bare[b]), interface, false);
        for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(band_weights()[c][b]) * seen;
    }
    return cut_to_gamut(sum);
}

Rgb rgb_of(const Colour& c) {
    return {static_cast<float>(c[0]), static_cast<float>(c[1]), static_cast<float>(c[2])};
}

Lab lab_of(const Rgb& c) {
    return lab_of_rgb({static_cast<double>(c[0]), static_cast<double>(c[1]), static_cast<double>(c[2])});
}

/// Three numbers whose squares sum to ΔE²: l, c + r h / 2, h √(1 − r²/4).
Eigen::Vector3d residual(const Lab& lab, const Lab& wanted) {
    const ColourDifference d = colour_difference(wanted, lab);
    return {d.l, d.c + 0.5 * d.r * d.h, d.h * std::sqrt(std::max(0.0, 1 - 0.25 * d.r * d.r))};
}

/// Levels of an amount from a hundredth of `most` up to it, evenly in the logarithm.
std::vector<double> levels(double most, int n) {
    std::vector<double> out;
    out.reserve(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) out.push_back(most * std::pow(0.01, static_cast<double>(n - 1 - i) / (n - 1)));
    return out;
}

}  // namespace

Rgb colour_on(const Ink& ink, const Substrate& substrate, double film) {
    const double x = film > 0 ? film : ink.film;
    std::array<double, kBands> k{}, s{};
    for (const InkPart& part : ink.parts)
        for (int b = 0; b < kBands; ++b) {
            k[b] += x * part.fraction * static_cast<double>(part.pigment.k[b]);
            s[b] += x * part.fraction * static_cast<double>(part.pigment.s[b]);
        }
    return rgb_of(colour_of(k, s, bare_bands(substrate), interface_of(substrate)));
}

MixSearch::MixSearch(std::vector<Pigment> pigments, const Substrate& substrate, double film)
    : pigments_(std::move(pigments)), substrate_(substrate), bare_(bare_bands(substrate)), film_(film) {
    if (pigments_.empty()) throw Error("a mix needs at least one pigment to choose from");
    if (pigments_.size() > kMostCandidates)
        throw Error(Message("a mix is chosen from at most {} pigments", kMostCandidates));
    if (!(film > 0 && film <= kThickestMix))
        throw Error(
            Message("the film of a mix is more than 0 and at most {} film units", static_cast<int>(kThickestMix)));
    for (const Pigment& p : pigments_) {
        double sum = 0;
        for (int b = 0; b < kBands; ++b) sum += static_cast<double>(p.k[b] + p.s[b]) / kBands;
        strength_.push_back(std::max(sum, 1e-6));
    }
    sample_mixes();
}

void MixSearch::sample_mixes() {
    const std::size_t n = pigments_.size();
    const auto add = [&](std::vector<std::size_t> pigment, const std::vector<double>& share, double optical) {
        Mix mix{std::move(pigment), {}, 0};
        double sum = 0;
        for (std::size_t i = 0; i < mix.pigment.size(); ++i) {
            mix.amount.push_back(share[i] * optical / strength_[mix.pigment[i]]);
            sum += mix.amount.back();
        }
        // A mix without water where more is wanted than there is room for.
        if (sum > film_)
            for (double& a : mix.amount) a *= film_ / sum;
        const Lab seen = lab(mix);
        Sample sample{.parts = static_cast<std::uint8_t>(mix.pigment.size())};
        for (std::size_t i = 0; i < 3; ++i) {
            const std::size_t j = std::min(i, mix.pigment.size() - 1);
            sample.pigment[i] = static_cast<std::uint8_t>(mix.pigment[j]);
            sample.amount[i] = static_cast<float>(mix.amount[j]);
            sample.lab[i] = static_cast<float>(seen[i]);
        }
        samples_.push_back(sample);
    };
    double most = 0;  // optical thickness of the strongest film
    for (const double s : strength_) most = std::max(most, s * film_);
    for (std::size_t a = 0; a < n; ++a) {
        for (const double x : levels(strength_[a] * film_, 16)) add({a}, {1}, x);
        for (std::size_t b = a + 1; b < n; ++b) {
            for (const double x : levels(most, 7))
                for (const double share : {0.04, 0.2, 0.5, 0.8, 0.96}) add({a, b}, {share, 1 - share}, x);
            for (std::size_t c = b + 1; c < n; ++c)
                for (const double x : levels(most, 6))
                    for (int i = 0; i <= 3; ++i)
                        for (int j = 0; i + j <= 3; ++j)
                            add({a, b, c}, {(i + 0.33) / 4, (j + 0.33) / 4, (3 - i - j + 0.33) / 4}, x);
        }
    }
}

Lab MixSearch::lab(const Mix& mix) const {
    std::array<double, kBands> k{}, s{};
    for (std::size_t i = 0; i < mix.pigment.size(); ++i) {
        const Pigment& p = pigments_[mix.pigment[i]];
        for (int b = 0; b < kBands; ++b) {
            k[b] += mix.amount[i] * static_cast<double>(p.k[b]);
            s[b] += mix.amount[i] * static_cast<double>(p.s[b]);
        }
    }
    return lab_of_rgb(colour_of(k, s, bare_, interface_of(substrate_)));
}

MixSearch::Mix MixSearch::refine(Mix mix, const Lab& wanted) const {
    Eigen::Vector3d r = residual(lab(mix), wanted);
    double lambda = 1e-3;
    for (int step = 0; step < kSteps && r.norm() > kExact && !mix.amount.empty(); ++step) {
        const auto n = static_cast<Eigen::Index>(mix.amount.size());
        Eigen::Matrix<double, 3, Eigen::Dynamic> jacobian(3, n);
        for (Eigen::Index i = 0; i < n; ++i) {
            Mix other = mix;
            const auto at = static_cast<std::size_t>(i);
            const double h = std::max(1e-5 * mix.amount[at], 1e-7 / strength_[mix.pigment[at]]);
            other.amount[at] += h;
            jacobian.col(i) = (residual(lab(other), wanted) - r) / h;
        }
        const Eigen::VectorXd gradient = jacobian.transpose() * r;
        Eigen::MatrixXd normal = jacobian.transpose() * jacobian;
        const Eigen::VectorXd scale = normal.diagonal().array().max(1e-9 * normal.diagonal().maxCoeff() + 1e-12);
        normal.diagonal() += lambda * scale;
        double sum = 0;
        for (const double a : mix.amount) sum += a;
        Eigen::VectorXd move = -normal.ldlt().solve(gradient);
        if (sum >= film_ * (1 - 1e-9) && move.sum() > 0) {  // along Σ w = X: no water is left to replace
            const Eigen::VectorXd even = normal.ldlt().solve(Eigen::VectorXd::Ones(n));
            move -= move.sum() / even.sum() * even;
        }
        double length = 1;
        Eigen::Index ends = -1;  // the amount that comes to 0 first
        for (Eigen::Index i = 0; i < n; ++i)
            if (const double a = mix.amount[static_cast<std::size_t>(i)]; a + length * move[i] <= 0)
                length = -a / move[i], ends = i;
        if (const double more = move.sum(); more > 0 && sum + length * more > film_)
            length = std::max(0.0, film_ - sum) / more, ends = -1;
        Mix next = mix;
        for (Eigen::Index i = 0; i < n; ++i)
            next.amount[static_cast<std::size_t>(i)] =
                std::max(0.0, mix.amount[static_cast<std::size_t>(i)] + length * move[i]);
        if (ends >= 0) {
            next.amount.erase(next.amount.begin() + ends);
            next.pigment.erase(next.pigment.begin() + ends);
        }
        const Eigen::Vector3d there = residual(lab(next), wanted);
        if (there.squaredNorm() < r.squaredNorm() && !next.amount.empty()) {
            const bool still = r.norm() - there.norm() < 1e-6;
            mix = std::move(next);
            r = there;
            lambda = std::max(1e-9, 0.3 * lambda);
            if (still) break;
        } else if ((lambda *= 5) > 1e9) {
            break;
        }
    }
    return tidied(std::move(mix), wanted);
}

// Without what an ink file cannot hold.
MixSearch::Mix MixSearch::tidied(Mix mix, const Lab& wanted) const {
    for (std::size_t i = mix.amount.size(); i-- > 0;)
        if (mix.amount[i] < kLeastAmount * film_ && mix.amount.size() > 1) {
            mix.amount.erase(mix.amount.begin() + static_cast<std::ptrdiff_t>(i));
            mix.pigment.erase(mix.pigment.begin() + static_cast<std::ptrdiff_t>(i));
        }
    double sum = 0;
    for (double& a : mix.amount) sum += a = std::max(a, kLeastAmount * film_);
    if (sum > film_)
        for (double& a : mix.amount) a *= film_ / sum;
    mix.error = delta_e_2000(lab(mix), wanted);
    return mix;
}

// Compass search in the logarithms of the amounts: far from a colour out of reach the three terms
// are no straight functions of the amounts, and Levenberg–Marquardt stops short of the optimum.
MixSearch::Mix MixSearch::refine_mixture(Mix mix, const Lab& wanted) const {
    for (double step = 0.4; step > 1e-3; step *= 0.5)
        for (bool better = true; better;) {
            better = false;
            for (std::size_t i = 0; i < mix.amount.size(); ++i)
                for (const double factor : {std::exp(step), std::exp(-step)}) {
                    Mix other = mix;
                    if (i >= other.amount.size()) break;
                    other.amount[i] *= factor;
                    other = tidied(std::move(other), wanted);
                    if (other.error < mix.error - 1e-5) mix = std::move(other), better = true;
                }
        }
    return mix;
}

// The nearest sample of each set of pigments, the nearest sets first.
std::vector<MixSearch::Mix> MixSearch::starts(const Lab& wanted, std::size_t most_parts) const {
    std::vector<std::pair<double, const Sample*>> order;
    for (const Sample& s : samples_) {
        if (s.parts > most_parts) continue;
        const Lab seen{static_cast<double>(s.lab[0]), static_cast<double>(s.lab[1]), static_cast<double>(s.lab[2])};
        order.emplace_back(delta_e_2000(seen, wanted), &s);
    }
    std::sort(order.begin(), order.end());
    std::map<std::array<std::uint8_t, 3>, std::size_t> taken;  // starts of each set
    std::vector<Mix> out;
    const auto take = [&](double error, const Sample& s, std::size_t most) {
        if (taken[s.pigment]++ >= most) return;
        Mix mix;
        for (std::size_t i = 0; i < s.parts; ++i) {
            mix.pigment.push_back(s.pigment[i]);
            mix.amount.push_back(static_cast<double>(s.amount[i]));
        }
        mix.error = error;
        out.push_back(std::move(mix));
    };
    std::set<std::array<std::uint8_t, 3>> sets;
    for (const auto& [error, s] : order) sets.insert(s->pigment);
    const std::size_t of_set = std::max(kStartsOfSet, kStarts / sets.size());
    for (const auto& [error, s] : order)
        if (out.size() < kStarts) take(error, *s, of_set);
    // Single pigments always: whatever is found is no worse than the best of them.
    for (const auto& [error, s] : order)
        if (s->parts == 1) take(error, *s, 1);
    return out;
}

ColourMatch MixSearch::nearest(const Rgb& wanted, std::size_t most_parts) const {
    most_parts = std::clamp<std::size_t>(most_parts, 1, 4);
    const Lab goal = lab_of(wanted);
    const auto nearer = [](const Mix& a, const Mix& b) { return a.error < b.error; };
    std::vector<Mix> mixes;
    for (const Mix& start : starts(goal, std::min<std::size_t>(most_parts, 3))) mixes.push_back(refine(start, goal));
    std::stable_sort(mixes.begin(), mixes.end(), nearer);
    if (most_parts > 3 && mixes.front().error > kExact) {
        std::vector<Mix> extended;
        for (std::size_t m = 0; m < std::min(kExtended, mixes.size()); ++m)
            for (std::size_t p = 0; p < pigments_.size(); ++p) {
                Mix mix = mixes[m];
                if (mix.pigment.size() >= most_parts ||
                    std::find(mix.pigment.begin(), mix.pigment.end(), p) != mix.pigment.end())
                    continue;
                double sum = 0;
                for (const double a : mix.amount) sum += a;
                const double more = std::min(0.05 / strength_[p], 0.1 * film_);
                const double room = std::max(film_ - more, 0.0);
                if (sum > room)
                    for (double& a : mix.amount) a *= room / sum;
                mix.pigment.push_back(p);
                mix.amount.push_back(more);
                extended.push_back(refine(std::move(mix), goal));
            }
        mixes.insert(mixes.end(), extended.begin(), extended.end());
        std::stable_sort(mixes.begin(), mixes.end(), nearer);
    }
    if (mixes.front().error > kPolishFrom) {
        for (std::size_t m = 0; m < std::min(kPolished, mixes.size()); ++m) mixes[m] = refine_mixture(mixes[m], goal);
        std::stable_sort(mixes.begin(), mixes.end(), nearer);
    }
    const Mix* best = &mixes.front();
    for (const Mix& mix : mixes)
        if (mix.error <= mixes.front().error + kSameColour && mix.pigment.size() < best->pigment.size()) best = &mix;
    ColourMatch match{.ink = {}, .wanted = wanted};
    match.ink.name = to_hex(wanted);
    match.ink.title = match.ink.name;
    match.ink.film = film_;
    for (std::size_t i = 0; i < best->pigment.size(); ++i)
        match.ink.parts.push_back({pigments_[best->pigment[i]], best->amount[i] / film_});
    std::stable_sort(match.ink.parts.begin(), match.ink.parts.end(),
                     [](const InkPart& a, const InkPart& b) { return a.fraction > b.fraction; });
    match.reached = colour_on(match.ink, substrate_);
    match.delta_e = delta_e_2000(lab_of(match.reached), goal);
    return match;
}

ColourMatch match_colour(const Rgb& wanted, const std::vector<Pigment>& pigments, const Substrate& substrate,
                         const MatchOptions& options) {
    if (options.film > 0) return MixSearch(pigments, substrate, options.film).nearest(wanted, options.most_parts);
    return MixSearches(pigments, substrate).nearest(wanted, options.most_parts);
}

ColourMatch MixSearches::nearest(const Rgb& wanted, std::size_t most_parts) {
    const double most = std::min(kThickestMix, std::max(0.5, static_cast<double>(substrate_.capacity)));
    std::vector<ColourMatch> all;
    for (const double film : {2.0, 4.0, 8.0}) {
        if (all.size() == searches_.size()) searches_.emplace_back(pigments_, substrate_, std::min(film, most));
        all.push_back(searches_[all.size()].nearest(wanted, most_parts));
        if (film >= most) break;
        // None that is thicker can be better by more than it is worth, and none that is thinner does.
        const ColourMatch& match = all.back();
        if (match.delta_e <= kWorthThickness &&
            std::all_of(all.begin(), all.end() - 1,
                        [&](const ColourMatch& thinner) { return thinner.delta_e > match.delta_e + kWorthThickness; }))
            break;
    }
    double best = all.front().delta_e;
    for (const ColourMatch& match : all) best = std::min(best, match.delta_e);
    for (ColourMatch& match : all)
        if (match.delta_e <= best + kWorthThickness) return std::move(match);
    return all.back();
}

std::vector<Pigment> shipped_pigments() {
    std::vector<Pigment> all;
    for (const std::string& name : list_pigments()) all.push_back(load_pigment(name));
    return all;
}

std::optional<Rgb> colour_of_hex(std::string_view text) {
    if (text.empty() || text[0] != '#') return std::nullopt;
    std::string digits(text.substr(1));
    if (digits.size() == 3) digits = {digits[0], digits[0], digits[1], digits[1], digits[2], digits[2]};
    if (digits.size() != 6 ||
        !std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isxdigit(c); }))
        return std::nullopt;
    Rgb colour;
    for (std::size_t c = 0; c < 3; ++c) colour[c] = linear_of_code()[std::stoul(digits.substr(2 * c, 2), nullptr, 16)];
    return colour;
}

std::string to_hex(const Rgb& linear) {
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", code_of_linear(linear[0]), code_of_linear(linear[1]),
                  code_of_linear(linear[2]));
    return text;
}

ColourMatch match_on_canvas(const Rgb& wanted, const Substrate& substrate, std::span<const Pigment> present,
                            const MatchOptions& options, MixSearches* searches) {
    static const std::vector<Pigment> shipped = shipped_pigments();
    ColourMatch match = searches && options.film == 0 ? searches->nearest(wanted, options.most_parts)
                                                      : match_colour(wanted, shipped, substrate, options);
    const auto is_new = [&](const InkPart& part) {
        return std::none_of(present.begin(), present.end(),
                            [&](const Pigment& p) { return p.name == part.pigment.name; });
    };
    const auto more = static_cast<std::size_t>(std::count_if(match.ink.parts.begin(), match.ink.parts.end(), is_new));
    if (!present.empty() && present.size() + more > static_cast<std::size_t>(kMaxPigments))
        match = match_colour(wanted, {present.begin(), present.end()}, substrate, options);
    return match;
}

std::vector<Pigment> choose_pigments(std::span<const WeightedColour> colours, const std::vector<Pigment>& candidates,
                                     std::span<const Pigment> present, const Substrate& substrate) {
    constexpr std::size_t kMostColours = 48;
    std::vector<WeightedColour> heaviest(colours.begin(), colours.end());
    std::stable_sort(heaviest.begin(), heaviest.end(),
                     [](const WeightedColour& a, const WeightedColour& b) { return a.weight > b.weight; });
    if (heaviest.size() > kMostColours) heaviest.resize(kMostColours);

    const auto index_of = [&](const Pigment& pigment) {
        const auto at = std::find_if(candidates.begin(), candidates.end(),
                                     [&](const Pigment& p) { return p.name == pigment.name; });
        return static_cast<std::size_t>(at - candidates.begin());
    };
    std::vector<double> cost(candidates.size(), 0);
    std::vector<std::vector<std::pair<std::size_t, double>>> users(candidates.size());  // colour and its best ΔE
    MixSearches all(candidates, substrate);
    for (std::size_t c = 0; c < heaviest.size(); ++c) {
        const ColourMatch best = all.nearest(heaviest[c].colour);
        for (const InkPart& part : best.ink.parts) users[index_of(part.pigment)].emplace_back(c, best.delta_e);
    }
    for (std::size_t p = 0; p < candidates.size(); ++p) {
        if (users[p].empty()) continue;
        cost[p] = 1e-9;  // one that is used goes before one that is not
        std::vector<Pigment> others = candidates;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(p));
        if (others.empty()) continue;
        MixSearches without(std::move(others), substrate);
        for (const auto& [c, best] : users[p])
            cost[p] += heaviest[c].weight * std::max(0.0, without.nearest(heaviest[c].colour).delta_e - best);
    }
    std::vector<Pigment> chosen(present.begin(), present.end());
    std::vector<std::size_t> order(candidates.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return cost[a] > cost[b]; });
    for (const std::size_t p : order) {
        const bool known = std::any_of(chosen.begin(), chosen.end(),
                                       [&](const Pigment& own) { return own.name == candidates[p].name; });
        if (cost[p] > 0 && !known && chosen.size() < static_cast<std::size_t>(kMaxPigments))
            chosen.push_back(candidates[p]);
    }
    return chosen;
}

Ink ink_named(std::string_view name, const Substrate& substrate, std::span<const Pigment> present,
              MixSearches* searches) {
    if (name.empty() || name[0] != '#') return load_ink(name);
    const std::optional<Rgb> wanted = colour_of_hex(name);
    if (!wanted) throw Error(Message("'{}' is no colour; write #rrggbb, such as #c03020", std::string(name)));
    Ink ink = match_on_canvas(*wanted, substrate, present, {.film = 0}, searches).ink;
    ink.name = name;
    return ink;
}

const char* difference_in_words(double delta_e) {
    if (delta_e < 1) return "the same to the eye";
    if (delta_e < 2.5) return "close: seen only side by side";
    if (delta_e < 6) return "a visible difference";
    return "a plainly different colour: these pigments do not reach it";
}

}  // namespace tuft::ink
