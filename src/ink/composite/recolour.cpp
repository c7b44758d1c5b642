#include "ink/composite/recolour.h"

#include <algorithm>
#include <cassert>

namespace tuft::ink {
namespace {

const InkPart* part_named(const Ink& ink, const std::string& name) {
    for (const InkPart& part : ink.parts)
        if (part.pigment.name == name) return &part;
    return nullptr;
}

/// Sums of optical properties, each times how much of the pigment there is.
struct Sum {
    std::array<double, kBands> k{}, s{};
    double height = 0, roughness = 0, amount = 0;

    void add(const Pigment& p, double factor) {
        for (int b = 0; b < kBands; ++b) {
            k[b] += factor * static_cast<double>(p.k[b]);
            s[b] += factor * static_cast<double>(p.s[b]);
        }
        height += factor * static_cast<double>(p.height);
        roughness += factor * static_cast<double>(p.roughness);
        amount += factor;
    }
};

}  // namespace

void recolour(Canvas& canvas, const Ink& painted, const Ink& wanted) {
    const double strength = painted.strength();
    assert(strength > 0);
    Sum added;  // per unit of all the ink's old pigments
    for (const InkPart& part : wanted.parts)
        if (!part_named(painted, part.pigment.name)) added.add(part.pigment, part.fraction / strength);
    for (const InkPart& old : painted.parts) {
        const auto& all = canvas.pigments();
        const auto at =
            std::find_if(all.begin(), all.end(), [&](const Pigment& p) { return p.name == old.pigment.name; });
        if (at == all.end()) continue;
        Sum sum = added;
        if (const InkPart* same = part_named(wanted, old.pigment.name))
            sum.add(same->pigment, same->fraction / old.fraction);
        Pigment displayed = old.pigment;
        for (int b = 0; b < kBands; ++b) {
            displayed.k[b] = static_cast<float>(sum.k[b]);
            displayed.s[b] = static_cast<float>(sum.s[b]);
        }
        displayed.height = static_cast<float>(sum.height);
        if (sum.amount > 0) displayed.roughness = static_cast<float>(sum.roughness / sum.amount);
        displayed.curve = {};
        displayed.source = "ink " + painted.name + " shown as " + wanted.name;
        canvas.set_pigment(static_cast<int>(at - all.begin()), displayed);
    }
    for (const std::uint32_t slot : canvas.touched_slots()) canvas.mark_dirty(slot);
}

std::vector<std::string> shared_pigments(const Ink& a, const Ink& b) {
    std::vector<std::string> names;
    for (const InkPart& part : a.parts)
        if (part_named(b, part.pigment.name)) names.push_back(part.pigment.name);
    return names;
}

}  // namespace tuft::ink
