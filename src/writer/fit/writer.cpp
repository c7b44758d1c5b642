#include "writer/fit/writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "brush/preset/preset.h"
#include "brush/tuft/ferrule.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/hash.h"
#include "core/system/parallel.h"
#include "io/strokes/area_lines.h"
#include "writer/gesture/heads.h"

namespace tuft::writer {
namespace {

constexpr double kMargin = 80;                 // units of cells around a stroke
constexpr float kUnder = 0.25f;                // weight of an error under another stroke
constexpr std::uint64_t kVersion = 24;         // of the fit
constexpr std::size_t kMostStations = 20'000;  // of a stroke
constexpr double kMiddlePressure = 0.4;        // that draws the median width
constexpr double kCoarse = 3;                  // median widths of a line at that pressure: the brush is too coarse
constexpr double kBlot = kSide / 4;            // units of a brush's finest line with which no stroke can be told apart
constexpr double kFine = 4.0 / 3;              // median widths that a brush must reach, or it is too fine

double median_width(const stroke::LineWidths& widths, double unit) {
    return std::max(kMedianStroke * unit, widths.least());
}

std::string sized(const std::string& brush, double factor) {
    const brush::SizedName name = brush::sized_name(brush);
    const double size = std::clamp(name.factor * factor, brush::kLeastSize, brush::kMostSize);
    return brush::name_of({name.base, std::round(size * 1000) / 1000});
}

Message too_coarse(const std::string& brush, const stroke::LineWidths& widths, double side) {
    const auto mm = [](double metres) { return fmt::format("{:.4g}", metres * 1e3); };
    // Two digits, upwards, so that the size that is named will do.
    const auto at_least = [](double metres) {
        const double unit = std::pow(10, std::floor(std::log10(metres * 1e3)) - 1);
        return fmt::format("{:.6g}", std::ceil(metres * 1e3 / unit - 1e-9) * unit);
    };
    return Message(
        "characters of {} mm are too small for {}, whose finest line is {} mm wide: it writes characters from {} mm on",
        mm(side), brush, mm(widths.least()), at_least(widths.least() * kSide / kBlot));
}

bool has_ink(const std::vector<Ring>& area) {
    constexpr double kCell = 8;  // units: finer than a stem
    Cells cells = cells_over(area, kCell, kCell);
    fill(cells, area);
    return cells.count() > 0;
}

std::uint64_t hash_of(const std::vector<Station>& s, std::uint64_t seed) {
    return hash_span(std::span<const Station>(s), seed);
}

CacheKey cache_key(std::uint64_t key) {
    CacheKey out("fitted stroke 1");
    out.add(key);
    return out;
}

}  // namespace

std::optional<std::string> size_that_fits(const std::string& brush, double side) {
    const double width = kMedianStroke * side / kSide;
    stroke::WidthTables tables;
    const stroke::LineWidths& widths = tables.of(brush);
    if (widths.at(kMiddlePressure) <= kCoarse * width && widths.most() >= kFine * width) return std::nullopt;
    // Widths grow with the size, but for the film about the hair.
    std::string name = sized(brush, width / widths.at(kMiddlePressure));
    if (name == brush) return std::nullopt;
    return name;
}

/// A stroke before its fit.
struct Writer::Job {
    std::vector<Station> stations, other;  // the path, and another begin of the fit
    FitTarget target;
    bool fit = true;
    bool fair = true;  // not for lines of a pen: areas predicted for their folded heads lose by it
    std::uint64_t key = 0;
};

Writer::Writer(WriterOptions options) : options_(std::move(options)) {
    const Style& style = options_.style;
    brush_ = options_.brush.empty() ? sized(style.brush, options_.side / style.brush_side) : options_.brush;
    if (style.kind == HandKind::brush) sides_ = SideTable::load(data_folder() / "models" / "writer" / "sides.txt");
    hand();
}

BrushHand Writer::hand() {
    return {tables_.preset(brush_), tables_.of(brush_), tables_.holder(brush_), unit()};
}

Pace Writer::pace() const {
    const Style& s = options_.style;
    return {.speed = s.speed * options_.side / s.brush_side,
            .radius = s.bend_radius,
            .ends = s.ends,
            .ease = s.ease,
            .lean = s.lean};
}

Writer::Job Writer::job_of(const Glyph& glyph, std::size_t stroke) const {
    const Style& style = options_.style;
    Job job;
    const GlyphStroke& own = glyph.strokes[stroke];
    if (glyph.single_line || style.kind != HandKind::brush) {
        job.fit = false;
        const std::vector<Vec2> line = glyph.single_line ? curve_through(own.median) : own.median;
        for (const Vec2& p : line) job.stations.push_back({leaned(p, glyph, style.slant), style.half_width});
        job.stations = resample_stations(job.stations, kStationsApart);
        return job;
    }
    const StrokeLine line = make_stroke_line(own.median);
    const bool outlined = options_.fit && !own.outline.empty();
    const auto rings_of = [&](std::size_t k) {
        const GlyphStroke& s = glyph.strokes[k];
        if (outlined && !s.outline.empty()) return s.outline;
        const StrokeLine other = make_stroke_line(s.median);
        return area_of(other, sides_.predict(other, glyph, k));
    };
    const StrokeSides sides = outlined ? measure_sides(line, own.outline) : sides_.predict(line, glyph, stroke);
    const auto add = [&](Cells& cells, std::size_t k) {
        const std::vector<Ring> rings = rings_of(k);
        if (outlined) return fill(cells, rings);
        for (const Ring& ring : rings) fill(cells, std::span(&ring, 1));
    };
    job.fair = outlined || !glyph.of_pen;
    job.target.wanted = cells_over(rings_of(stroke), 2, kMargin);
    Cells others = job.target.wanted;
    add(job.target.wanted, stroke);
    for (std::size_t k = 0; k < glyph.strokes.size(); ++k)
        if (k != stroke) add(others, k);
    for (const std::uint8_t under : others.inside) job.target.weights.push_back(under ? kUnder : 1.0f);
    job.stations = make_stations(line, sides, job.target.wanted);
    if (line.segments.size() > 1) job.other = make_stations(line, sides, job.target.wanted, false);
    job.key = hash_of(job.other, hash_of(job.stations, 2 * kVersion + job.fair));
    job.key = hash_span(std::span<const std::uint8_t>(job.target.wanted.inside), job.key);
    job.key = hash_span(std::span<const float>(job.target.weights), job.key);
    return job;
}

std::uint64_t Writer::seed_of(const BrushHand& with, const Pace& at) const {
    const std::string preset = brush::preset_toml(with.preset);
    const double facts[] = {with.unit, at.speed,  at.radius, at.ends,
                            at.ease,   at.across, at.touch,  static_cast<double>(options_.style.tries)};
    std::uint64_t seed = hash_bytes(facts, sizeof facts, hash_bytes(preset.data(), preset.size()));
    for (const auto& [code, lean] : at.lean) {
        const double own[] = {static_cast<double>(code), lean};
        seed = hash_bytes(own, sizeof own, seed);
    }
    return seed;
}

Writer::Fitted Writer::fit_stroke(const Glyph& glyph, std::size_t stroke, const BrushHand& with, const Pace& at,
                                  std::uint64_t seed) const {
    Job job = job_of(glyph, stroke);
    if (!job.fit) return {std::move(job.stations), 0, false};
    const std::uint64_t key = hash_bytes(&job.key, sizeof job.key, seed);
    if (const auto known = known_.find(key); known != known_.end()) return {known->second, key, false};
    if (std::optional<std::vector<Station>> stored = cached(key)) return {std::move(*stored), key, false};
    Fitted made{{}, key, true};
    const FitOptions fit{.tries = options_.style.tries, .fair = job.fair};
    made.stations = fit_stations(job.stations, job.target, with, at, fit, job.other).stations;
    store(key, made.stations);
    return made;
}

std::vector<std::vector<WrittenStroke>> Writer::write(const std::vector<Glyph>& given, const ProgressFn& progress) {
    std::vector<Glyph> glyphs = given;
    if (options_.style.kind == HandKind::brush)
        for (Glyph& glyph : glyphs) glyph = with_heads(std::move(glyph));
    const BrushHand with = hand();
    const Pace at = pace();
    const bool brushed =
        options_.style.kind == HandKind::brush &&
        std::any_of(glyphs.begin(), glyphs.end(), [](const Glyph& g) { return !g.single_line && !g.strokes.empty(); });
    if (brushed && with.widths.least() > kBlot * unit()) throw Error(too_coarse(brush_, with.widths, options_.side));
    const std::uint64_t seed = seed_of(with, at);
    struct Place {
        std::size_t glyph, stroke;
    };
    std::vector<Place> places;
    for (std::size_t g = 0; g < glyphs.size(); ++g)
        for (std::size_t s = 0; s < glyphs[g].strokes.size(); ++s) places.push_back({g, s});
    std::vector<Fitted> done(places.size());
    std::size_t made = 0;
    // In batches, so that progress is reported and a stop is heard.
    const std::size_t batch = 4 * static_cast<std::size_t>(std::max(1, thread_count()));
    for (std::size_t begin = 0; begin < places.size(); begin += batch) {
        report(progress, "writing", static_cast<double>(begin) / static_cast<double>(places.size()));
        const std::size_t n = std::min(batch, places.size() - begin);
        parallel_for(n, 1, [&](std::size_t lo, std::size_t hi) {
            for (std::size_t i = begin + lo; i < begin + hi; ++i)
                done[i] = fit_stroke(glyphs[places[i].glyph], places[i].stroke, with, at, seed);
        });
        for (std::size_t i = begin; i < begin + n; ++i) {
            if (done[i].key != 0) known_[done[i].key] = done[i].stations;
            made += done[i].made;
        }
    }
    n_fitted_ += made;
    if (made > 0) options_.cache.trim();
    std::vector<std::vector<WrittenStroke>> out;
    std::size_t next = 0;
    for (const Glyph& glyph : glyphs) {
        std::vector<std::vector<Station>> own;
        for (std::size_t s = 0; s < glyph.strokes.size(); ++s) own.push_back(std::move(done[next++].stations));
        out.push_back(strokes_of(glyph, own));
    }
    return out;
}

std::vector<WrittenStroke> Writer::strokes_of(const Glyph& glyph, const std::vector<std::vector<Station>>& fitted) {
    if (!glyph.area.empty()) return filled(glyph);
    const bool drawn = glyph.single_line || options_.style.kind != HandKind::brush;
    const std::vector<std::vector<Station>> strokes = drawn ? fitted : linked(fitted, options_.style);
    std::vector<WrittenStroke> out;
    for (std::size_t i = 0; i < strokes.size(); ++i) out.push_back(motion(strokes[i], glyph, i));
    return out;
}

WrittenStroke Writer::motion(const std::vector<Station>& stations, const Glyph& glyph, std::size_t stroke) {
    const Style& style = options_.style;
    const BrushHand with = hand();
    WrittenStroke out{.brush = brush_, .label = fmt::format("{} {}", utf8_of(glyph.code), stroke + 1)};
    std::vector<Station> own = stations;
    const bool drawn = glyph.single_line || style.kind != HandKind::brush;
    if (drawn && style.kind != HandKind::nib)  // ends as round as the line is wide
        for (Station& s : own)
            s.half =
                style.kind == HandKind::line ? style.half_width : median_width(with.widths, with.unit) / with.unit / 2;
    Pace at = pace();
    if (drawn) at.across = 0;
    const bool edged = style.kind == HandKind::nib && glyph.single_line;
    if (edged) at.roll = style.edge_angle - (glyph.sideways ? 0.5 * std::numbers::pi : 0);
    out.trace = samples_of(own, with, at);
    // Its width is the ferrule's: pressed deeper, hair that turns over drags steps into the counter.
    if (edged && brush::can_be_turned(with.preset))
        for (stroke::StrokeSample& s : out.trace.samples) s.pressure = std::min(s.pressure, style.edge_pressure);
    return out;
}

std::vector<WrittenStroke> Writer::filled(const Glyph& glyph) const {
    std::vector<io::Ring> rings;
    for (const Ring& ring : glyph.area) {
        io::Ring own;
        for (const Vec2& p : ring) own.emplace_back(unit() * p.x, -unit() * p.y);
        rings.push_back(std::move(own));
    }
    std::vector<WrittenStroke> out;
    for (io::AreaLine& area : io::area_lines(rings, io::FillRule::nonzero)) {
        WrittenStroke s{.brush = brush::sized_name(brush_).base,
                        .label = fmt::format("{} {}", utf8_of(glyph.code), out.size() + 1),
                        .made_up = true};
        s.trace.pressed = false;
        s.trace.line_width = area.width;
        s.trace.stencil = std::move(area.stencil);
        double along = 0, whole = 0;
        for (std::size_t i = 1; i < area.line.size(); ++i) whole += glm::distance(area.line[i], area.line[i - 1]);
        for (std::size_t i = 0; i < area.line.size(); ++i) {
            if (i > 0) along += glm::distance(area.line[i], area.line[i - 1]);
            double part = 1;
            if (area.taper_in > 0) part = std::min(part, along / area.taper_in);
            if (area.taper_out > 0) part = std::min(part, (whole - along) / area.taper_out);
            s.trace.samples.push_back({.time = along / options_.style.speed,
                                       .position = Vec3(area.line[i], 0),
                                       .pressure = 0.5 * std::max(part, 0.05)});
        }
        out.push_back(std::move(s));
    }
    if (out.empty() && has_ink(glyph.area))
        throw Error(
            Message("the outline of {} is too large or too intricate to be filled with a brush", utf8_of(glyph.code)));
    return out;
}

std::optional<std::vector<Station>> Writer::cached(std::uint64_t key) const {
    std::vector<Station> stations;
    const auto take = [&](CacheReader& entry) {
        const std::vector<double> values = entry.get<double>();
        if (values.size() % 3 != 0 || values.size() < 6 || values.size() > 3 * kMostStations) CacheReader::fail();
        for (std::size_t i = 0; i < values.size(); i += 3) {
            const Station s{{values[i], values[i + 1]}, values[i + 2]};
            if (!(std::abs(s.centre.x) < kFarthestUnit && std::abs(s.centre.y) < kFarthestUnit && s.half >= 0 &&
                  s.half < kSide))
                CacheReader::fail();
            stations.push_back(s);
        }
    };
    if (!options_.cache.read(cache_key(key), take)) return std::nullopt;
    return stations;
}

void Writer::store(std::uint64_t key, const std::vector<Station>& stations) const {
    std::vector<double> values;
    for (const Station& s : stations) values.insert(values.end(), {s.centre.x, s.centre.y, s.half});
    options_.cache.write(cache_key(key), [&](CacheWriter& entry) { entry.put(values); });
}

}  // namespace tuft::writer
