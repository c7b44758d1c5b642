#include "car_design.h"

#include <algorithm>
#include <cmath>

#include "turned.h"

namespace tuft::models {

namespace {

using Key = Curve::Key;

constexpr double kLength = 4650;

/// Stations on the flank, mm from the nose. The panels around the wheels take six
/// stations each; doubled stations stand beside the pillars.
constexpr std::array<double, kStations + 1> kStationS = {
    215,  285,  350,  410,  557,  703,  850,  997,  1143, 1290, 1430, 1560, 1700, 1800, 1940, 2100, 2300,
    2460, 2620, 2790, 2840, 2980, 3120, 3195, 3270, 3417, 3563, 3710, 3857, 4003, 4150, 4245, 4340, 4430};

/// Half widths of the columns at nose and tail, mm; column 0 is the corner itself.
constexpr std::array<double, kMiddle + 1> kNoseY = {0, 735, 700, 665, 620, 565, 470, 330, 170, 0};
constexpr std::array<double, kMiddle + 1> kTailY = {0, 740, 715, 690, 655, 610, 550, 390, 200, 0};

/// The car seen from above: nose, front wheel, waist, rear wheel, tail.
PlaneLine plan_line() {
    Outline o{{0, 0}};
    const Vec2 keys[] = {{24, 280},   {80, 520},   {165, 690},  {290, 808},  {470, 882},  {850, 922},
                         {1500, 914}, {2300, 905}, {3000, 918}, {3710, 938}, {4100, 914}, {4350, 848},
                         {4490, 745}, {4572, 600}, {4632, 320}, {kLength, 0}};
    add_spline(o, keys, {0, 1}, {0, -1}, 2000);
    return PlaneLine(o);
}

/// One section of the body side: for each row how far it lies inside the plan line,
/// and its height, mm.
struct Section {
    double s;  ///< where on the plan line; 0 and kLength are nose and tail
    std::array<double, kTop + 1> inset;
    std::array<double, kTop + 1> height;
};

constexpr Section kSections[] = {
    {0, {150, 60, 44, 22, 4, 2, 26, 62, 118}, {180, 190, 268, 345, 470, 575, 640, 690, 730}},
    {215, {130, 48, 34, 22, 10, 6, 16, 46, 86}, {178, 188, 292, 385, 500, 600, 666, 724, 760}},
    {850, {75, 30, 10, 18, 16, 10, 0, 34, 68}, {165, 176, 310, 455, 605, 745, 802, 848, 884}},
    {2200, {95, 36, 6, 46, 44, 25, 0, 34, 56}, {150, 162, 275, 352, 545, 712, 826, 876, 918}},
    {3710, {80, 32, 10, 18, 16, 10, 0, 36, 82}, {165, 178, 312, 460, 612, 755, 848, 898, 940}},
    {4430, {140, 58, 34, 18, 4, 14, 10, 44, 90}, {240, 255, 350, 475, 608, 700, 808, 872, 926}},
    {kLength, {190, 84, 58, 22, 0, 38, 44, 92, 62}, {245, 258, 345, 475, 612, 664, 798, 880, 972}},
};

/// The front's columns lean: how wide each row stands compared to `kNoseY`.
constexpr std::array<double, kTop + 1> kNoseSpread = {1, 1.02, 1.05, 1.05, 0.98, 0.88, 0.94, 0.98, 1};

/// A line of the upper body. At nose and tail it starts and ends on the ring.
Curve with_ends(double first_at, double first, std::vector<Key> keys, double last_at, double last) {
    keys.insert(keys.begin(), {first_at, first});
    keys.push_back({last_at, last});
    return Curve(std::move(keys));
}

}  // namespace

CarDesign::CarDesign() : plan_(plan_line()) {
    wheels[0] = {850, 348, 915, 376, 3, 9, 5};
    wheels[1] = {3710, 348, 932, 376, 24, 30, 5};
    for (int r = 0; r <= kTop; ++r) {
        std::vector<Key> inset, height;
        const auto row = static_cast<std::size_t>(r);
        for (const Section& section : kSections) {
            const double u = plan_.find(0, section.s);
            inset.push_back({u, section.inset[row]});
            height.push_back({u, section.height[row]});
        }
        row_inset_.emplace_back(inset, true);
        row_height_.emplace_back(height, true);
    }
    const double s0 = kStationS.front(), s1 = kStationS.back();
    const auto line = [&](int j, std::vector<Key> s, std::vector<Key> y, std::vector<Key> z) {
        const Vec3 a = ring(ring_u(0, j, kTop), kTop), b = ring(ring_u(kStations, j, kTop), kTop);
        return std::vector<Curve>{with_ends(s0, a.x, std::move(s), s1, b.x),
                                  with_ends(a.x, a.y, std::move(y), b.x, b.y),
                                  with_ends(a.x, a.z, std::move(z), b.x, b.z)};
    };
    rail_ = line(5, {{500, 450}, {1560, 1545}, {1800, 1800}, {3300, 3300}, {4130, 4170}},
                 {{400, 655},
                  {850, 740},
                  {1560, 788},
                  {1760, 794},
                  {2300, 664},
                  {2650, 660},
                  {3000, 645},
                  {3400, 622},
                  {3880, 640},
                  {4180, 645}},
                 {{400, 792},
                  {850, 888},
                  {1560, 952},
                  {1750, 970, true},
                  {2020, 1118},
                  {2300, 1226},
                  {2650, 1262},
                  {2950, 1248},
                  {3250, 1192},
                  {3550, 1107},
                  {3880, 1010},
                  {4180, 974}});
    screen_ = line(6,
                   {{300, 215},
                    {500, 430},
                    {1420, 1380},
                    {1560, 1515},
                    {1700, 1680},
                    {1800, 1795},
                    {2300, 2280},
                    {3130, 3160},
                    {3850, 3900},
                    {4130, 4200}},
                   {{400, 590},
                    {850, 668},
                    {1400, 718},
                    {1680, 742},
                    {2280, 616},
                    {2650, 612},
                    {3160, 588},
                    {3500, 574},
                    {3900, 582},
                    {4200, 585}},
                   {{400, 802},
                    {850, 900},
                    {1515, 962},
                    {1680, 972, true},
                    {1980, 1124},
                    {2280, 1240},
                    {2650, 1278},
                    {2950, 1263},
                    {3160, 1228},
                    {3500, 1137},
                    {3900, 1012, true},
                    {4200, 980}});
    middle_ = line(9,
                   {{300, 190},
                    {500, 410},
                    {1420, 1310},
                    {1560, 1425},
                    {1700, 1500},
                    {1800, 1595},
                    {2300, 2200},
                    {2790, 2780},
                    {3130, 3200},
                    {3850, 4000},
                    {4130, 4270}},
                   {{2000, 0}},
                   {{300, 788},
                    {700, 884},
                    {1100, 948},
                    {1500, 984, true},
                    {1700, 1078},
                    {1950, 1186},
                    {2210, 1278},
                    {2400, 1308},
                    {2620, 1320},
                    {2850, 1313},
                    {3050, 1293},
                    {3200, 1264},
                    {3450, 1198},
                    {3750, 1096},
                    {4000, 1006, true},
                    {4150, 988},
                    {4330, 978}});
    const auto free_line = [](std::vector<Key> y, std::vector<Key> z) {
        return std::vector<Curve>{Curve(std::move(y)), Curve(std::move(z))};
    };
    waist_ = free_line({{1700, 815}, {1800, 824}, {2300, 838}, {2840, 836}, {3210, 812}, {3430, 772}, {3570, 745}},
                       {{1700, 962}, {2300, 976}, {2840, 988}, {3210, 1004}, {3430, 1042}, {3570, 1066}});
    window_top_ = free_line({{1700, 802}, {1800, 808}, {2300, 700}, {2700, 696}, {3130, 690}, {3430, 734}, {3570, 738}},
                            {{1700, 968},
                             {1800, 988},
                             {1940, 1058},
                             {2100, 1128},
                             {2300, 1194},
                             {2620, 1226},
                             {2900, 1214},
                             {3130, 1170},
                             {3210, 1148},
                             {3430, 1080},
                             {3570, 1068}});
}

double CarDesign::length() const {
    return kLength;
}

double CarDesign::ring_u(int i, int j, int r) const {
    const auto k = static_cast<std::size_t>(j);
    if (j == kMiddle) return i == 0 ? 0 : plan_.length();
    if (i == 0 && j > 0) return plan_.find(1, kNoseY[k] * (j < 3 ? 1 : kNoseSpread[static_cast<std::size_t>(r)]));
    if (i == kStations && j > 0) return plan_.find(1, kTailY[k], true);
    return plan_.find(0, kStationS[static_cast<std::size_t>(i)]);
}

Vec3 CarDesign::ring(double u, int r) const {
    const auto row = static_cast<std::size_t>(r);
    const Vec2 p = plan_.point(u) - row_inset_[row](u) * plan_.left_normal(u);
    const double z = row_height_[row](u);
    return {p.x, p.y + flare(p.x, z), z};
}

Vec3 CarDesign::nose(double y, int r) const {
    Vec3 p = ring(y == 0 ? 0 : plan_.find(1, std::abs(y)), r);
    p.y = y;
    return p;
}

double CarDesign::flare(double s, double z) const {
    double out = 0;
    for (const WheelDesign& w : wheels) {
        const double beyond = std::hypot(s - w.s, z - w.z) - w.arch_radius;
        out += 20 * std::exp(-std::pow(std::max(0.0, beyond) / 120, 2)) * smooth_step(180, 420, z);
    }
    return out;
}

double CarDesign::flank_y(double s, double z) const {
    const double u = plan_.find(0, s);
    std::vector<Key> profile;
    for (std::size_t r = 0; r <= kTop; ++r) profile.push_back({row_height_[r](u), row_inset_[r](u)});
    return plan_.point(u).y - Curve(profile)(z) * plan_.left_normal(u).y + flare(s, z);
}

Vec3 CarDesign::top(int i, int j) const {
    const double station = kStationS[static_cast<std::size_t>(i)];
    const auto on = [&](const std::vector<Curve>& line) {
        const double s = line[0](station);
        return Vec3{s, line[1](s), line[2](s)};
    };
    if (j >= 6) {
        const Vec3 edge = on(screen_);
        Vec3 mid = on(middle_);
        mid.y = 0;
        if (j == 6) return edge;
        // The power dome: the bonnet's middle stands out over its sides.
        const double hood = smooth_step(230, 700, station) * (1 - smooth_step(1290, 1580, station));
        const double dome = 18 * hood;
        mid.z += 0.8 * dome;
        if (j == kMiddle) return mid;
        const double t = j == 7 ? 0.68 + 0.1 * hood : 0.35;
        const double bow = std::pow(t, 2.2);
        return {glm::mix(mid.x, edge.x, bow), edge.y * t,
                glm::mix(mid.z, edge.z, bow) + (j == 7 ? 0.7 * dome : 0.1 * dome)};
    }
    const Vec3 rail = on(rail_);
    if (j == 5) return rail;
    const Vec3 side = ring(ring_u(i, 0, kTop), kTop);
    const double f = 0.2 * j;
    Vec3 open = glm::mix(side, rail, f);  // bonnet, boot: a crowned fender
    open.z += 4 * f * (1 - f) * 9;
    const double cabin = smooth_step(1540, 1800, station) * (1 - smooth_step(3420, 3840, station));
    if (cabin == 0) return open;
    const Vec3 low{station, waist_[0](station), waist_[1](station)};
    const Vec3 high{station, window_top_[0](station), window_top_[1](station)};
    Vec3 closed;
    if (j == 1) closed = glm::mix(side, low, 0.55) + Vec3{0, 6, 6};
    if (j == 2) closed = low;
    if (j == 3) closed = glm::mix(low, high, 0.5) + Vec3{0, 0.05, 0.04} * glm::length(high - low);
    if (j == 4) closed = high;
    return glm::mix(open, closed, cabin);
}

Vec3 CarDesign::point(int i, int j, int r) const {
    Vec3 p = i == 0 || i == kStations || j == 0 ? ring(ring_u(i, j, r), r) : top(i, j);
    if (j == kMiddle) p.y = 0;
    return p;
}

}  // namespace tuft::models
