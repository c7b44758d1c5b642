#include "io/strokes/inkml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "core/files/files.h"
#include "core/random.h"
#include "core/text/units.h"

namespace tuft::io {
namespace {

using stroke::RecordedStroke;
using ::testing::HasSubstr;

std::string ink(const std::string& body) {
    return "<ink xmlns=\"http://www.w3.org/2003/InkML\">\n" + body + "\n</ink>\n";
}

std::vector<RecordedStroke> parse(const std::string& body, const InkmlOptions& options = {}) {
    return parse_inkml(ink(body), "test.inkml", options);
}

std::string message(const std::string& text, const InkmlOptions& options = {}) {
    try {
        parse_inkml(text, "test.inkml", options);
    } catch (const Error& e) {
        return e.what();
    }
    return "no error";
}

std::vector<std::pair<double, double>> millimetres(const RecordedStroke& trace) {
    std::vector<std::pair<double, double>> out;
    for (const auto& s : trace.samples)
        out.emplace_back(std::round(s.position.x * 1e9) / 1e6, std::round(s.position.y * 1e9) / 1e6);
    return out;
}

using Points = std::vector<std::pair<double, double>>;

TEST(Inkml, DecodesDifferencesAsTheRecommendationDoes) {
    // Example of the recommendation, section 3.2: an absolute point, velocities, accelerations
    // (the prefix stays in force), with two intermittent booleans; numbers may touch.
    const auto traces = parse(R"(
      <traceFormat>
        <channel name="X" type="decimal" units="mm"/><channel name="Y" type="decimal" units="mm"/>
        <intermittentChannels>
          <channel name="B1" type="boolean" default="F"/><channel name="B2" type="boolean" default="F"/>
        </intermittentChannels>
      </traceFormat>
      <trace>1125 18432,'23'43,"7"-8,3-5,7 -3,6 2,6 8,3 6 T,2 4*T,3 6,3-6 F F</trace>)");
    ASSERT_EQ(traces.size(), 1u);
    // velocity: 23 43, 30 35, 33 30, 40 27, 46 29, 52 37, 55 43, 57 47, 60 53, 63 47
    const Points want{{1125, 18432}, {1148, 18475}, {1178, 18510}, {1211, 18540}, {1251, 18567}, {1297, 18596},
                      {1349, 18633}, {1404, 18676}, {1461, 18723}, {1521, 18776}, {1584, 18823}};
    EXPECT_EQ(millimetres(traces[0]), want);
}

TEST(Inkml, WildcardsGoOnAsBeforeAndExplicitPrefixEndsDifferences) {
    const auto traces = parse("<trace>10 5,'2'1,* *,!0 *,* !7,\"* ?</trace>");
    // After !0 the X channel is explicit, so * holds it; Y runs on by 1 until !7.
    const Points want{{10, 5}, {12, 6}, {14, 7}, {0, 8}, {0, 7}, {2, 7}};
    EXPECT_EQ(millimetres(traces[0]), want);
}

TEST(Inkml, ReadsHexadecimalAndExponents) {
    const auto traces = parse("<trace>#FF 1.5e1,-#10 -2.5E-1 , 1 2 ,\n</trace>");
    const Points want{{255, 15}, {-16, -0.25}, {1, 2}};
    EXPECT_EQ(millimetres(traces[0]), want);
}

TEST(Inkml, UnitsAndResolutionsBringLengthsToMetres) {
    const std::pair<const char*, double> units[] = {
        {"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}, {"in", 0.0254}, {"pt", 0.0254 / 72}, {"himetric", 1e-5}, {"dev", 1e-3}};
    for (const auto& [unit, metres] : units) {
        const std::string u = unit;
        const auto t = parse("<traceFormat><channel name='X' units='" + u + "'/><channel name='Y' units='" + u +
                             "'/></traceFormat><trace>2 3</trace>");
        EXPECT_NEAR(t[0].samples[0].position.x, 2 * metres, 1e-12) << unit;
        EXPECT_NEAR(t[0].samples[0].position.y, 3 * metres, 1e-12) << unit;
    }
    // As note-taking programs write it: integers, and so many of them in a centimetre.
    const auto t = parse(R"(
      <definitions><context xml:id="ctx0"><inkSource xml:id="src0">
        <traceFormat>
          <channel name="X" type="integer" max="1024" units="cm"/><channel name="Y" type="integer" max="768" units="cm"/>
          <channel name="F" type="integer" max="32767" units="dev"/>
        </traceFormat>
        <channelProperties>
          <channelProperty channel="X" name="resolution" value="1000" units="1/cm"/>
          <channelProperty channel="Y" name="resolution" value="500" units="1/cm"/>
          <channelProperty channel="F" name="resolution" value="1" units="1/dev"/>
        </channelProperties></inkSource></context></definitions>
      <trace contextRef="#ctx0">1000 1000 16383.5</trace>)");
    EXPECT_NEAR(t[0].samples[0].position.x, 0.01, 1e-12);
    EXPECT_NEAR(t[0].samples[0].position.y, 0.02, 1e-12);
    EXPECT_NEAR(t[0].samples[0].pressure, 0.5, 1e-12);
}

TEST(Inkml, TimesAreRebasedAndNeverFall) {
    const std::string format = "<traceFormat><channel name='X'/><channel name='Y'/><channel name='T'%/></traceFormat>";
    for (const auto& [unit, scale] : {std::pair{"", 1e-3}, {" units='s'", 1.0}, {" units='us'", 1e-6}}) {
        std::string f = format;
        f.replace(f.find('%'), 1, unit);
        const auto t = parse(f + "<trace>0 0 1000,1 0 1010,2 0 1005,3 0 1030</trace>");
        EXPECT_EQ(t[0].samples[0].time, 0);
        EXPECT_NEAR(t[0].samples[1].time, 10 * scale, 1e-12);
        EXPECT_NEAR(t[0].samples[2].time, 10 * scale, 1e-12);
        EXPECT_NEAR(t[0].samples[3].time, 30 * scale, 1e-12);
    }
    const auto rated = parse("<inkSource><sampleRate value='50'/></inkSource><trace>0 0,1 0,2 0</trace>");
    EXPECT_NEAR(rated[0].samples[2].time, 0.04, 1e-12);
    const auto lasting = parse("<trace duration='300'>0 0,1 0,2 0,2 0</trace>");
    EXPECT_NEAR(lasting[0].samples[2].time, 0.2, 1e-12);
    const auto plain = parse("<trace>0 0,6 0</trace>", {.pen_speed = 0.06});
    EXPECT_NEAR(plain[0].samples[1].time, 0.1, 1e-12);
}

TEST(Inkml, PlanarHandwritingGetsPressureThatSwellsAndTapers) {
    std::string points;
    for (int i = 0; i <= 100; ++i) points += (i ? "," : "") + std::to_string(0.2 * i) + " 0";
    const auto t = parse("<trace>" + points + "</trace><trace>3 3</trace>");
    ASSERT_EQ(t.size(), 2u);
    EXPECT_TRUE(t[0].flat);
    const auto& s = t[0].samples;
    EXPECT_NEAR(s[50].pressure, 0.5, 1e-9);  // even speed in the middle
    EXPECT_LT(s[0].pressure, s[10].pressure);
    EXPECT_LT(s[100].pressure, 0.3 * s[50].pressure);
    for (const auto& x : s) EXPECT_TRUE(x.pressure > 0 && x.pressure <= 1);
    EXPECT_NEAR(t[1].samples[0].pressure, 0.5, 1e-12);
}

// 15 mm at 50 mm/s, half a second of rest, 25 mm on.
std::vector<stroke::StrokeSample> with_a_rest(int step_ms) {
    std::string points;
    for (int t = 0; t <= 1300; t += step_ms) {
        const double moving = t < 300 ? t : std::max(300, t - 500);
        points += (t ? "," : "") + std::to_string(0.05 * moving) + " 0 " + std::to_string(t);
    }
    return parse(
               "<traceFormat><channel name='X' units='mm'/><channel name='Y' units='mm'/><channel name='T' "
               "units='ms'/></traceFormat><trace>" +
               points + "</trace>")[0]
        .samples;
}

TEST(Inkml, DefaultPressureFollowsTheSpeedNotTheNumberOfSamples) {
    const auto rare = with_a_rest(10), often = with_a_rest(1);
    ASSERT_EQ(often.size(), 10 * (rare.size() - 1) + 1);
    // Speed changes only at times that both have: the same but for rounding.
    for (std::size_t i = 0; i < rare.size(); ++i) EXPECT_NEAR(rare[i].pressure, often[10 * i].pressure, 1e-9) << i;
    // p = v^(-1/4) / 2, v in mean speeds, at most 1.3 / 2, which is at v = 0.35. Over 60 ms v falls from 1.3 s * 50
    // mm/s / 40 mm to 0, so that p rises in 1 ms by at most 0.35^(-5/4) / 8 * 1.625 / 60 = 0.0126.
    for (std::size_t i = 1; i < often.size(); ++i)
        EXPECT_LT(std::abs(often[i].pressure - often[i - 1].pressure), 0.013) << i;
    EXPECT_NEAR(often[500].pressure, 0.65, 1e-9) << "a hand that rests presses 1.3 times as much";
}

TEST(Inkml, PressureWithoutARangeIsScaledByTheLargest) {
    const std::string f = "<traceFormat><channel name='X'/><channel name='Y'/><channel name='P'/></traceFormat>";
    EXPECT_NEAR(parse(f + "<trace>0 0 0.25</trace>")[0].samples[0].pressure, 0.25, 1e-12);
    const auto t = parse(f + "<trace>0 0 256</trace><trace>0 0 1024</trace>");
    EXPECT_NEAR(t[0].samples[0].pressure, 0.25, 1e-12);
    EXPECT_NEAR(t[1].samples[0].pressure, 1, 1e-12);
    const auto force = parse(
        "<traceFormat><channel name='X'/><channel name='Y'/><channel name='F' "
        "units='N'/></traceFormat>"
        "<trace>0 0 0.6,0 0 9</trace>",
        {.full_force = 2});
    EXPECT_NEAR(force[0].samples[0].pressure, 0.3, 1e-12);
    EXPECT_NEAR(force[0].samples[1].pressure, 1, 1e-12);
}

TEST(Inkml, TiltAzimuthAndQuaternionsAgree) {
    const auto tilted = parse(
        "<traceFormat><channel name='X'/><channel name='Y'/><channel name='OTx' units='deg'/>"
        "<channel name='OTy' units='deg'/></traceFormat><trace>0 0 20 -10</trace>");
    EXPECT_NEAR(tilted[0].samples[0].tilt.x, 20 * kDegree, 1e-12);
    EXPECT_NEAR(tilted[0].samples[0].tilt.y, -10 * kDegree, 1e-12);
    const auto polar = parse(
        "<traceFormat><channel name='X'/><channel name='Y'/><channel name='OA' units='deg'/>"
        "<channel name='OE' units='deg'/></traceFormat><trace>0 0 90 60</trace>");
    EXPECT_NEAR(polar[0].samples[0].tilt.x, 0, 1e-12);
    EXPECT_NEAR(polar[0].samples[0].tilt.y, 30 * kDegree, 1e-12);
    // In space the holder leans by the same angles from +z.
    const auto space = parse(
        "<traceFormat><channel name='X'/><channel name='Y'/><channel name='Z'/><channel "
        "name='OTx'/>"
        "<channel name='OTy'/></traceFormat><trace>1 2 3 20 -10</trace>");
    EXPECT_FALSE(space[0].flat);
    EXPECT_NEAR(space[0].samples[0].position.z, 0.003, 1e-12);
    const Vec3 up = space[0].samples[0].rotation * Vec3(0, 0, 1);
    EXPECT_NEAR(up.x / up.z, std::tan(20 * kDegree), 1e-12);
    EXPECT_NEAR(up.y / up.z, std::tan(-10 * kDegree), 1e-12);
    const auto turned = parse(
        "<traceFormat><channel name='X'/><channel name='Y'/><channel name='Z'/><channel name='QW'/>"
        "<channel name='QX'/><channel name='QY'/><channel name='QZ'/></traceFormat><trace>1 2 3 2 "
        "0 0 2</trace>");
    EXPECT_NEAR(glm::length(turned[0].samples[0].rotation * Vec3(1, 0, 0) - Vec3(0, 1, 0)), 0, 1e-12);
}

TEST(Inkml, TheRotationOfAPenIsTheRollOfTheHolder) {
    const std::string head = "<traceFormat><channel name='X'/><channel name='Y'/>";
    const auto degrees = parse(head + "<channel name='OR'/></traceFormat><trace>0 0 30, 1 0 350</trace>");
    EXPECT_DOUBLE_EQ(degrees[0].samples[0].roll, 30 * kDegree);
    EXPECT_DOUBLE_EQ(degrees[0].samples[1].roll, 350 * kDegree);
    const auto radians = parse(head + "<channel name='OR' units='rad'/></traceFormat><trace>0 0 -0.25</trace>");
    EXPECT_EQ(radians[0].samples[0].roll, -0.25);
    EXPECT_NE(inkml_text(radians).find("<channel name=\"OR\" type=\"double\" units=\"rad\"/>"), std::string::npos);
    EXPECT_NE(inkml_text(radians, {}, Digits::rounded).find("units=\"deg\""), std::string::npos);
    // In space the ferrule turns about its own axis, z up.
    const auto space = parse(head + "<channel name='Z'/><channel name='OR'/></traceFormat><trace>1 2 3 90</trace>");
    EXPECT_NEAR(glm::distance(space[0].samples[0].rotation * Vec3(1, 0, 0), Vec3(0, 1, 0)), 0, 1e-15);
    EXPECT_EQ(space[0].samples[0].roll, 0);
    // A file says nothing of it where the holder does not roll.
    EXPECT_EQ(inkml_text(parse(head + "</traceFormat><trace>0 0, 1 1</trace>")).find("OR"), std::string::npos);
    EXPECT_THROW(parse(head + "<channel name='OR' units='rad'/></traceFormat><trace>0 0 1e9</trace>"), Error);
}

TEST(Inkml, AnnotationsInheritThroughGroupsAndBrushes) {
    const auto t = parse(R"(
      <annotation type="tuft:ink">carbon</annotation>
      <definitions><brush xml:id="b"><annotation type="tuft:brush">wolf-small</annotation></brush>
        <context xml:id="c" brushRef="#b"/></definitions>
      <traceGroup contextRef="#c">
        <annotation type="tuft:origin">1 2.5 -3 mm</annotation>
        <annotation type="tuft:right">0 2 0</annotation><annotation type="tuft:down">0 0 -1</annotation>
        <annotation type="tuft:laying">project</annotation>
        <trace><annotation type="tuft:label">永 &lt;1&gt;</annotation><annotation type="tuft:seed">77</annotation>1 2</trace>
        <traceGroup><annotation type="tuft:ink">cobalt</annotation><trace>3 4</trace></traceGroup>
      </traceGroup>
      <trace>5 6</trace>)");
    ASSERT_EQ(t.size(), 3u);
    EXPECT_EQ(t[0].brush, "wolf-small");
    EXPECT_EQ(t[0].ink, "carbon");
    EXPECT_EQ(t[0].label, "永 <1>");
    EXPECT_EQ(t[0].seed, 77u);
    EXPECT_NEAR(glm::length(t[0].placement.origin - Vec3(0.001, 0.0025, -0.003)), 0, 1e-15);
    EXPECT_EQ(t[0].placement.right, Vec3(0, 1, 0));
    EXPECT_EQ(t[0].placement.mapping, stroke::SurfaceMapping::project);
    EXPECT_EQ(t[1].ink, "cobalt");
    EXPECT_EQ(t[1].label, "");
    EXPECT_EQ(t[2].brush, "");
    EXPECT_EQ(t[2].placement.mapping, stroke::SurfaceMapping::wrap);
}

TEST(Inkml, PenUpTracesAreSkippedAndContinuationsJoined) {
    const auto t = parse(
        "<trace type='penUp'>0 0</trace><trace xml:id='a' continuation='begin'>1 1,2 2</trace>"
        "<trace>9 9</trace><trace xml:id='b' continuation='end' priorRef='#a'>3 3</trace>");
    ASSERT_EQ(t.size(), 2u);
    EXPECT_EQ(millimetres(t[0]), (Points{{1, 1}, {2, 2}, {3, 3}}));
}

TEST(Inkml, WritesForPeopleWhatItReads) {
    std::vector<RecordedStroke> traces(5);
    for (std::size_t k = 0; k < traces.size(); ++k) {
        RecordedStroke& t = traces[k];
        auto random = [&, n = std::uint64_t{0}](double lo, double hi) mutable {
            return lo + (hi - lo) * uniform(k + 1, n++);
        };
        t.flat = k != 4;
        t.brush = "wolf-small";
        t.ink = k < 2 ? "carbon" : "cobalt & <gold>";
        t.label = "横 " + std::to_string(k);
        t.seed = k * 0x123456789abcdefULL;
        if (t.flat)
            t.placement = {{0.1, -0.02 * double(k / 2), 1e-4 / 3},
                           glm::normalize(Vec3(1, 2, 3)),
                           glm::normalize(Vec3(2, -1, 0)),
                           k == 3   ? stroke::SurfaceMapping::project
                           : k == 2 ? stroke::SurfaceMapping::drape
                                    : stroke::SurfaceMapping::wrap};
        for (int i = 0; i < 50; ++i) {
            stroke::StrokeSample s;
            s.time = 0.005 * i + (i ? 1e-3 * random(0, 1) : 0);
            s.position = {random(-0.2, 0.2), random(-0.2, 0.2), t.flat ? 0 : random(-1, 1)};
            s.pressure = random(0, 1);
            if (t.flat && k % 2) s.tilt = {random(-1, 1), random(-1, 1)};
            if (!t.flat) s.rotation = glm::normalize(Quat(random(-1, 1), random(-1, 1), random(-1, 1), 1));
            t.samples.push_back(s);
        }
    }
    const auto path = std::filesystem::temp_directory_path() / ("tuft_inkml_" + std::to_string(getpid()) + ".inkml");
    write_inkml(path, traces, "Five <strokes>", Digits::rounded);
    const auto back = read_inkml(path);
    std::filesystem::remove(path);
    ASSERT_EQ(back.size(), traces.size());
    for (std::size_t k = 0; k < traces.size(); ++k) {
        const RecordedStroke &a = traces[k], &b = back[k];
        EXPECT_EQ(a.flat, b.flat);
        EXPECT_EQ(a.brush, b.brush);
        EXPECT_EQ(a.ink, b.ink);
        EXPECT_EQ(a.label, b.label);
        EXPECT_EQ(a.seed, b.seed);
        EXPECT_EQ(a.placement.mapping, b.placement.mapping);
        EXPECT_LT(glm::length(a.placement.origin - b.placement.origin), 1e-9);
        EXPECT_LT(glm::length(a.placement.right - b.placement.right), 1e-9);
        ASSERT_EQ(a.samples.size(), b.samples.size());
        for (std::size_t i = 0; i < a.samples.size(); ++i) {  // tolerances as the header states
            const auto &s = a.samples[i], &r = b.samples[i];
            EXPECT_LT(glm::length(s.position - r.position), a.flat ? 7.2e-7 : 1e-9);
            EXPECT_NEAR(s.time, r.time, 1e-6);
            EXPECT_NEAR(s.pressure, r.pressure, 1e-5);
            EXPECT_LT(glm::length(s.tilt - r.tilt), 1e-4);
            EXPECT_NEAR(std::abs(glm::dot(s.rotation, r.rotation)), 1, 1e-9);
        }
    }
    // Written again, the text is the same: rounding is idempotent.
    const std::string text = inkml_text(back, "", Digits::rounded);
    EXPECT_EQ(text, inkml_text(parse_inkml(text, "again"), "", Digits::rounded));
}

// A finite number with random bits, of magnitude below `most`.
double any_double(std::uint64_t seed, std::uint64_t n, double most) {
    for (std::uint64_t k = 0;; ++k) {
        const double x = std::bit_cast<double>(hash_bits(seed, 1000 * n + k));
        if (std::abs(x) < most) return x;
    }
}

std::uint64_t bits(double x) {
    return std::bit_cast<std::uint64_t>(x);
}

TEST(Inkml, AnyNumberComesBackToTheBit) {
    std::vector<RecordedStroke> traces(200);
    for (std::size_t k = 0; k < traces.size(); ++k) {
        RecordedStroke& t = traces[k];
        auto number = [&, n = std::uint64_t{0}](double most) mutable { return any_double(k, n++, most); };
        t.flat = k % 3 != 0;
        t.brush = "wolf-small";
        t.settings = stroke::settings_from_json(R"({"dip":"carry","down":[0.1,0.0,-1.0],"film":"wet"})");
        if (t.flat)
            t.placement = {{number(1000), number(1000), number(1000)},
                           glm::normalize(Vec3(1, number(3), 3)),
                           glm::normalize(Vec3(2, -1, number(3))),
                           stroke::SurfaceMapping::wrap};
        // A clock that began before the stroke, at it, and at minus nothing.
        double time = k % 4 == 0 ? 0 : k % 4 == 1 ? -0.0 : k % 4 == 2 ? 1e5 + number(1) : -std::abs(number(1e6));
        for (int i = 0; i < 20; ++i) {
            stroke::StrokeSample s;
            s.time = time;
            time += std::abs(number(1));
            s.position = {number(1000), number(1000), t.flat ? 0 : number(1000)};
            s.pressure = std::abs(number(1));
            if (t.flat && k % 3 == 1) s.tilt = {number(1.4), number(1.4)};
            if (t.flat && k % 6 == 4) s.roll = number(7);
            if (!t.flat) s.rotation = glm::normalize(Quat(1, number(2), number(2), number(2)));
            t.samples.push_back(s);
        }
    }
    traces[0].samples[3].position = {-0.0, std::numeric_limits<double>::denorm_min(),
                                     std::numeric_limits<double>::min()};
    traces[0].before.push_back(stroke::Fill{
        .film = 1.0 / 3, .to_film = 1.0 / 3, .region = stroke::Region::part, .at = {1.0 / 3, -2e-9 / 7, 123.456}});
    const auto back = parse_inkml(inkml_text(traces), "exact.inkml");
    ASSERT_EQ(back.size(), traces.size());
    for (std::size_t k = 0; k < traces.size(); ++k) {
        const RecordedStroke &a = traces[k], &b = back[k];
        EXPECT_EQ(a.settings, b.settings);
        ASSERT_EQ(a.samples.size(), b.samples.size());
        for (int i = 0; i < 3; ++i) {
            EXPECT_EQ(bits(a.placement.origin[i]), bits(b.placement.origin[i])) << k;
            EXPECT_EQ(bits(a.placement.right[i]), bits(b.placement.right[i])) << k;
            EXPECT_EQ(bits(a.placement.down[i]), bits(b.placement.down[i])) << k;
        }
        for (std::size_t i = 0; i < a.samples.size(); ++i) {
            const auto &s = a.samples[i], &r = b.samples[i];
            EXPECT_EQ(bits(s.time), bits(r.time)) << k << " " << i;
            EXPECT_EQ(bits(s.pressure), bits(r.pressure)) << k << " " << i;
            for (int c = 0; c < 3; ++c) EXPECT_EQ(bits(s.position[c]), bits(r.position[c])) << k << " " << i;
            for (int c = 0; c < 2; ++c) EXPECT_EQ(bits(s.tilt[c]), bits(r.tilt[c])) << k << " " << i;
            EXPECT_EQ(bits(s.roll), bits(r.roll)) << k << " " << i;
            for (int c = 0; c < 4; ++c) EXPECT_EQ(bits(s.rotation[c]), bits(r.rotation[c])) << k << " " << i;
        }
    }
    ASSERT_EQ(back[0].before.size(), 1u);
    EXPECT_EQ(std::get<stroke::Fill>(back[0].before[0]), std::get<stroke::Fill>(traces[0].before[0]));
}

TEST(Inkml, BadFilesAreRefusedWithFileAndLine) {
    EXPECT_THAT(message("<ink>\n<trace>1 2</trace>\n<oops></ink>"), HasSubstr("test.inkml:3: not well-formed XML"));
    EXPECT_THAT(message("hello"), HasSubstr("test.inkml:1: not well-formed XML"));
    EXPECT_THAT(message(""), HasSubstr("not well-formed XML"));
    EXPECT_THAT(message("<svg/>"), HasSubstr("not InkML"));
    EXPECT_THAT(message(ink("")), HasSubstr("no pen-down traces"));
    EXPECT_THAT(message(ink("<trace></trace>")), HasSubstr("no pen-down traces"));
    EXPECT_THAT(message(ink("<trace>1 2,\n3 4,\n5 x</trace>")), HasSubstr("test.inkml:4: 'x' is not a number"));
    EXPECT_THAT(message(ink("<trace>1 2,\n3</trace>")), HasSubstr("test.inkml:3: a point has 1 values"));
    EXPECT_THAT(message(ink("<trace>1 2 3</trace>")), HasSubstr("test.inkml:2: a point has more than the 2"));
    EXPECT_THAT(message(ink("<trace>1 2,,3 4</trace>")), HasSubstr("a point has 0 values"));
    EXPECT_THAT(message(ink("<trace>1 nan</trace>")), HasSubstr("not finite"));
    EXPECT_THAT(message(ink("<trace>1 inf</trace>")), HasSubstr("not finite"));
    EXPECT_THAT(message(ink("<trace>1 1e999</trace>")), HasSubstr("out of range"));
    EXPECT_THAT(message(ink("<trace>1 --2</trace>")), HasSubstr("is not a number"));
    EXPECT_THAT(message(ink("<trace>1 9e30</trace>")), HasSubstr("declare the unit"));
    EXPECT_LT(message(ink("<trace>1 9e300</trace>")).size(), 120u) << "no number of 300 digits";
    for (const char* type : {"origin", "right", "down"})
        for (const char* bad : {"1e300 0 0", "0 nan 0", "0 0 -1e20", "1e-300 0 0"})
            if (std::string(type) != "origin" || std::string(bad) != "1e-300 0 0") {
                EXPECT_THAT(message(ink(std::string("<annotation type='tuft:") + type + "'>" + bad +
                                        "</annotation><trace>1 2</trace>")),
                            HasSubstr("test.inkml:2: "))
                    << type << " " << bad;
            }
    EXPECT_THAT(message(ink("<annotation type='tuft:tape'>0 0 1e9 0</annotation><trace>1 2</trace>")),
                HasSubstr("10 km"));
    EXPECT_THAT(message(ink("<trace>'1 2</trace>")), HasSubstr("before any explicit value"));
    EXPECT_THAT(message(ink("<trace>1 2,\"1 2</trace>")), HasSubstr("before any first difference"));
    EXPECT_THAT(message(ink("<trace contextRef='#nowhere'>1 2</trace>")),
                HasSubstr("'nowhere', which is not in the file"));
    EXPECT_THAT(message(ink("<traceFormat><channel name='Y'/></traceFormat><trace>1</trace>")),
                HasSubstr("no X and Y"));
    EXPECT_THAT(message(ink("<annotation type='tuft:origin'>1 2</annotation><trace>1 2</trace>")),
                HasSubstr("three numbers"));
    EXPECT_THAT(message(ink("<annotation type='tuft:right'>0 0 0</annotation><trace>1 2</trace>")),
                HasSubstr("direction is zero"));
    EXPECT_THAT(message(ink("<annotation type='tuft:clock'>reset</annotation><trace>1 2</trace>")),
                HasSubstr("nothing but kept"));
    EXPECT_THAT(message(ink("<annotation type='tuft:settings'>{\"film\": 3}</annotation><trace>1 2</trace>")),
                HasSubstr("test.inkml:2: "));
    EXPECT_THAT(message(ink("<annotation type='tuft:laying'>flat</annotation><trace>1 2</trace>")),
                HasSubstr("neither wrap, drape nor project"));
    EXPECT_THAT(message(ink("<context xml:id='a' contextRef='#b'/><context xml:id='b' "
                            "contextRef='#a'/><trace>1 2</trace>")),
                HasSubstr("in a circle"));
    EXPECT_THAT(message(ink("<trace>1 2,3 4,5 6</trace>"), {.max_samples = 2}), HasSubstr("more samples than 2"));
    std::string deep;
    for (int i = 0; i < 5000; ++i) deep += "<traceGroup>";
    for (int i = 0; i < 5000; ++i) deep += "</traceGroup>";
    EXPECT_THAT(message(ink(deep)), HasSubstr("nested too deeply"));
    EXPECT_THROW(read_inkml("/nonexistent/file.inkml"), Error);
}

TEST(Inkml, AnyTruncationOrGarbledByteIsAnErrorOrAFile) {
    RecordedStroke t;
    for (int i = 0; i < 20; ++i)
        t.samples.push_back({.time = 0.005 * i, .position = {0.001 * i, 0, 0}, .pressure = 0.5});
    const std::string whole = inkml_text(std::vector{t, t});
    const auto survives = [](const std::string& text) {
        try {
            for (const RecordedStroke& trace : parse_inkml(text, "garbled"))
                for (const auto& s : trace.samples)
                    ASSERT_TRUE(std::isfinite(s.position.x) && std::isfinite(s.time) && s.pressure >= 0 &&
                                s.pressure <= 1);
        } catch (const Error&) {
        }
    };
    for (std::size_t n = 0; n < whole.size(); n += 7) survives(whole.substr(0, n));
    for (std::uint64_t i = 0; i < 2000; ++i) {
        std::string garbled = whole;
        for (int k = 0; k < 3; ++k)
            garbled[hash_bits(i, 2 * k) % garbled.size()] = static_cast<char>(hash_bits(i, 2 * k + 1) % 128);
        survives(garbled);
    }
}

// A make leans where no sample has a tilt (`stroke::lean_holder`), so a holder that is held upright says so by one that
// is too small to see. Rounded to nothing it would lean again. A trace without any stays without.
TEST(Inkml, AHolderThatIsStatedUprightStaysSo) {
    RecordedStroke stated;
    for (int i = 0; i < 5; ++i)
        stated.samples.push_back({.time = 0.1 * i, .position = {1e-3 * i, 0, 0}, .pressure = 0.5});
    const RecordedStroke silent = stated;
    stated.samples.front().tilt.x = 1e-9;
    const auto leans = [](const stroke::StrokeSample& s) { return s.tilt != Vec2{0}; };
    for (const Digits digits : {Digits::exact, Digits::rounded}) {
        const std::vector<RecordedStroke> back =
            parse_inkml(inkml_text(std::vector{stated, silent}, {}, digits), "test.inkml");
        ASSERT_EQ(back.size(), 2u);
        EXPECT_TRUE(std::ranges::any_of(back[0].samples, leans));
        for (const stroke::StrokeSample& s : back[0].samples) EXPECT_LT(glm::length(s.tilt), 1e-4);  // as `Digits` says
        EXPECT_TRUE(std::ranges::none_of(back[1].samples, leans));
    }
}

TEST(Inkml, AStencilIsReadAsItIsWritten) {
    stroke::RecordedStroke trace;
    for (int i = 0; i < 3; ++i)
        trace.samples.push_back({.time = 0.1 * i, .position = {0.01 * i, 0, 0}, .pressure = 0.5});
    trace.stencil = {{{1.0 / 3, -0.1}, {2e-7, 0.5}}, {{0, 0}, {0.1, 0.2}}};
    const std::string text = inkml_text({&trace, 1}, "");
    EXPECT_EQ(parse_inkml(text, "tape").at(0).stencil, trace.stencil) << "to the bit";
    const auto with = [&](const std::string& tape) {
        std::string other = text;
        const std::size_t from = other.find('>', other.find("tuft:stencil")) + 1;
        return other.replace(from, other.find('<', from) - from, tape);
    };
    EXPECT_TRUE(parse_inkml(with(""), "tape").at(0).stencil.empty());
    for (const char* bad : {"1 2 3", "1 2 3 four", "1 2 3 nan"})
        EXPECT_THROW(parse_inkml(with(bad), "tape"), Error) << bad;
}

}  // namespace
}  // namespace tuft::io
