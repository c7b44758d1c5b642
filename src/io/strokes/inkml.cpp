#include "io/strokes/inkml.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <pugixml.hpp>

#include "core/ease.h"
#include "core/error.h"
#include "core/files/files.h"
#include "core/system/interrupt.h"
#include "core/text/units.h"
#include "io/package/xml_fault.h"
#include "io/strokes/inkml_decode.h"
#include "io/strokes/inkml_marks.h"
#include "stroke/journal/journal.h"

namespace tuft::io {

namespace {

using pugi::xml_node;
using stroke::RecordedStroke;
using stroke::StrokeSample;

constexpr int kMaxNesting = 64;  // groups in groups, references to references
// Seconds to each side over which the speed is taken for the default pressure: a time, not a number of samples, else a
// hand that stops would press at once where its device reports often.
constexpr double kSpeedWindow = 0.03;

struct State {
    InkmlFormat format;
    double sample_rate = 0;  ///< Hz, 0 unknown
    InkmlMarks marks;
};

/// Path length at a time, linear between samples whose lengths are `along`.
double length_at(const std::vector<StrokeSample>& samples, const std::vector<double>& along, double time) {
    const auto next =
        std::ranges::upper_bound(samples, time, std::ranges::less{}, [](const StrokeSample& s) { return s.time; });
    if (next == samples.begin()) return along.front();
    if (next == samples.end()) return along.back();
    const auto b = static_cast<std::size_t>(next - samples.begin());
    const double part = (time - samples[b - 1].time) / (samples[b].time - samples[b - 1].time);
    return along[b - 1] + part * (along[b] - along[b - 1]);
}

/// A trace with what is settled only once the whole file is read.
struct Draft {
    RecordedStroke trace;
    bool has_time = false, has_pressure = false, pressure_ranged = true, keeps_clock = false;
    double sample_rate = 0;
    double duration = 0;  ///< seconds, 0 unknown
    long line = 0;
};

std::string id_of(const xml_node& node) {
    const auto id = node.attribute("xml:id");
    return id ? id.value() : node.attribute("id").value();
}

/// Metres per unit of length as InkML spells it; empty for device units and others.
std::optional<double> length_unit(std::string_view unit) {
    if (unit == "pt") return 0.0254 / 72;
    if (unit == "pc") return 0.0254 / 6;
    if (unit == "himetric") return 1e-5;
    return metres_per(unit);
}

class Reader : InkmlText {
  public:
    Reader(std::string_view text, const std::string& source, const InkmlOptions& options)
        : InkmlText{text, source}, options_(options) {}

    std::vector<RecordedStroke> run() {
        const auto parsed = document_.load_buffer(content.data(), content.size());
        if (!parsed) throw Error(path, line_at(parsed.offset), Message("not well-formed XML: {}", xml_fault(parsed)));
        const xml_node ink = document_.document_element();
        if (local_name(ink) != "ink") fail(ink, "not InkML: the outermost element is not <ink>");
        collect_ids(ink, 0);
        State state;
        state.format = default_format();
        walk(ink, state, 0);
        if (drafts_.empty()) throw Error(path, "no pen-down traces in the file");
        finish();
        std::vector<RecordedStroke> traces;
        for (Draft& d : drafts_) traces.push_back(std::move(d.trace));
        return traces;
    }

  private:
    void collect_ids(const xml_node& node, int depth) {
        if (depth > kMaxNesting) fail(node, "elements are nested too deeply");
        for (const xml_node& child : node.children()) {
            if (child.type() != pugi::node_element) continue;
            const std::string id = id_of(child);
            if (!id.empty()) ids_.try_emplace(id, child);
            if (local_name(child) != "trace") collect_ids(child, depth + 1);
        }
    }

    /// The element that `attribute` of `node` refers to; none when it is absent, built in,
    /// or lies in another file.
    xml_node referred(const xml_node& node, const char* attribute) const {
        const std::string_view ref = node.attribute(attribute).value();
        if (ref.empty()) return {};
        const auto hash = ref.find('#');
        if (hash != std::string_view::npos && hash > 0) return {};
        const std::string id(hash == 0 ? ref.substr(1) : ref);
        const auto it = ids_.find(id);
        if (it != ids_.end()) return it->second;
        if (id.rfind("Default", 0) == 0) return {};
        fail(node, Message("{} refers to '{}', which is not in the file", std::string(attribute), id));
    }

    // --- formats -------------------------------------------------------------

    InkmlFormat default_format() const {
        InkmlFormat f;
        for (const char* name : {"X", "Y"}) f.channels.push_back({.name = name, .scale = options_.metres_per_unit});
        f.n_regular = 2;
        return f;
    }

    InkmlFormat format_of(const xml_node& node) const {
        std::vector<InkmlChannel> regular, intermittent;
        for (const xml_node& child : node.children()) {
            const auto name = local_name(child);
            if (name == "channel") regular.push_back(channel_of(child));
            if (name == "regularChannels" || name == "intermittentChannels")
                for (const xml_node& channel : child.children())
                    if (local_name(channel) == "channel")
                        (name[0] == 'r' ? regular : intermittent).push_back(channel_of(channel));
        }
        if (regular.size() + intermittent.size() > 1000) fail(node, "a trace format has over 1000 channels");
        InkmlFormat f{std::move(regular), 0};
        f.n_regular = f.channels.size();
        f.channels.insert(f.channels.end(), intermittent.begin(), intermittent.end());
        if (f.find("X") < 0 || f.find("Y") < 0) fail(node, "a trace format has no X and Y channels");
        return f;
    }

    InkmlChannel channel_of(const xml_node& node) const {
        InkmlChannel c;
        c.name = node.attribute("name").value();
        if (c.name.empty()) fail(node, "a channel has no name");
        const std::string_view unit = node.attribute("units").value();
        const bool has_range = node.attribute("max");
        const double lo = node.attribute("min") ? number_of(node, "min") : 0;
        const double hi = has_range ? number_of(node, "max") : 1;
        if (c.name == "X" || c.name == "Y" || c.name == "Z") {
            c.scale = length_unit(unit).value_or(options_.metres_per_unit);
            if (std::string_view(node.attribute("orientation").value()) == "-ve") c.scale = -c.scale;
        } else if (c.name == "T") {
            c.scale = unit == "s" ? 1 : unit == "us" ? 1e-6 : 1e-3;
        } else if (c.name == "P" || (c.name == "F" && (has_range || unit == "dev"))) {
            c.ranged = has_range || unit == "%";
            if (unit == "%")
                c.scale = 0.01;
            else if (has_range && hi > lo)
                c.offset = lo, c.scale = 1 / (hi - lo);
        } else if (c.name == "F") {
            c.scale = (unit == "mN" ? 1e-3 : 1.0) / options_.full_force;
        } else if (c.name == "OTx" || c.name == "OTy" || c.name == "OA" || c.name == "OE" || c.name == "OR") {
            c.scale = unit == "rad" ? 1 : kDegree;
            if (c.name == "OE") c.fallback = 90 * kDegree;
        } else if (c.name == "QW") {
            c.fallback = 1;
        }
        if (node.attribute("default"))
            if (const auto x = to_number(node.attribute("default").value())) c.fallback = (*x - c.offset) * c.scale;
        return c;
    }

    void apply_source(State& state, const xml_node& node) const {
        for (const xml_node& child : node.children()) {
            const auto name = local_name(child);
            if (name == "traceFormat") state.format = format_of(child);
            if (name == "sampleRate") state.sample_rate = number_of(child, "value");
        }
        if (const xml_node format = referred(node, "traceFormatRef")) state.format = format_of(format);
        for (const xml_node& child : node.children())
            if (local_name(child) == "channelProperties")
                for (const xml_node& property : child.children()) apply_property(state, property, node);
    }

    /// `resolution` in 1/length counts the channel's integers per length.
    void apply_property(State& state, const xml_node& property, const xml_node& source) const {
        if (std::string_view(property.attribute("name").value()) != "resolution") return;
        const int k = state.format.find(property.attribute("channel").value());
        const std::string_view unit = property.attribute("units").value();
        if (k < 0 || unit.rfind("1/", 0) != 0) return;
        const auto metres = length_unit(unit.substr(2));
        if (!metres) return;
        InkmlChannel& channel = state.format.channels[static_cast<std::size_t>(k)];
        if (channel.name != "X" && channel.name != "Y" && channel.name != "Z") return;
        const double per = number_of(property, "value");
        if (!(per > 0)) fail(property, "a resolution is not positive");
        bool counts = true;  // decimal values with a unit of their own are not counts
        for (const xml_node& format : source.children("traceFormat"))
            for (const xml_node& c : format.children("channel"))
                if (channel.name == c.attribute("name").value())
                    counts = std::string_view(c.attribute("type").value()) == "integer" ||
                             !length_unit(c.attribute("units").value());
        if (counts) channel.scale = std::copysign(*metres / per, channel.scale);
    }

    void apply_context(State& state, const xml_node& node, int depth) const {
        if (depth > kMaxNesting) fail(node, "contexts refer to each other in a circle");
        if (const xml_node base = referred(node, "contextRef")) apply_context(state, base, depth + 1);
        if (const xml_node source = referred(node, "inkSourceRef")) apply_source(state, source);
        if (const xml_node format = referred(node, "traceFormatRef")) state.format = format_of(format);
        if (const xml_node brush = referred(node, "brushRef")) apply_brush(state, brush, depth + 1);
        for (const xml_node& child : node.children()) {
            const auto name = local_name(child);
            if (name == "inkSource") apply_source(state, child);
            if (name == "traceFormat") state.format = format_of(child);
            if (name == "brush") apply_brush(state, child, depth + 1);
        }
        apply_marks(*this, state.marks, node);
    }

    void apply_brush(State& state, const xml_node& node, int depth) const {
        if (depth > kMaxNesting) fail(node, "brushes refer to each other in a circle");
        if (const xml_node base = referred(node, "brushRef")) apply_brush(state, base, depth + 1);
        apply_marks(*this, state.marks, node);
    }

    // --- own annotations -----------------------------------------------------

    // --- traces --------------------------------------------------------------

    /// Contexts, formats, sources and brushes that stand among the traces hold from there on.
    void walk(const xml_node& parent, State& state, int depth) {
        if (depth > kMaxNesting) fail(parent, "trace groups are nested too deeply");
        apply_marks(*this, state.marks, parent);
        for (const xml_node& node : parent.children()) {
            const auto name = local_name(node);
            if (name == "trace") {
                add_trace(node, state);
            } else if (name == "traceGroup") {
                State inner = state;
                if (const xml_node context = referred(node, "contextRef")) apply_context(inner, context, 0);
                if (const xml_node brush = referred(node, "brushRef")) apply_brush(inner, brush, 0);
                walk(node, inner, depth + 1);
            } else if (name == "context") {
                apply_context(state, node, 0);
            } else if (name == "traceFormat") {
                state.format = format_of(node);
            } else if (name == "inkSource") {
                apply_source(state, node);
            } else if (name == "brush") {
                apply_brush(state, node, 0);
            }
        }
    }

    void add_trace(const xml_node& node, const State& outer) {
        check_interrupt();
        const std::string_view type = node.attribute("type").value();
        if (type == "penUp") return;
        State state = outer;
        if (const xml_node context = referred(node, "contextRef")) apply_context(state, context, 0);
        if (const xml_node brush = referred(node, "brushRef")) apply_brush(state, brush, 0);
        apply_marks(*this, state.marks, node);

        const xml_node first = node.first_child();
        const long line = line_at((first ? first : node).offset_debug());
        const InkmlRows rows = decode_inkml(text_of(node), state.format, options_.max_samples - n_samples_, path, line);
        std::vector<stroke::Preparation> before = preparations_of(*this, node);
        if (rows.n_rows() == 0 && (before.empty() || !options_.actions)) return;
        n_samples_ += rows.n_rows();

        Draft draft = draft_of(rows, state, line);
        draft.trace.before = std::move(before);
        if (const auto x = to_number(node.attribute("duration").value())) draft.duration = 1e-3 * *x;
        const std::string_view continuation = node.attribute("continuation").value();
        const std::string_view prior = node.attribute("priorRef").value();
        if (continuation == "middle" || continuation == "end") {
            const auto it = by_id_.find(std::string(prior.substr(prior.rfind('#') + 1)));
            if (it == by_id_.end()) fail(node, "a continued trace does not say which one it continues");
            Draft& start = drafts_[it->second];
            start.trace.samples.insert(start.trace.samples.end(), draft.trace.samples.begin(),
                                       draft.trace.samples.end());
            start.has_time = start.has_time && draft.has_time;
            start.has_pressure = start.trace.pressed = start.has_pressure && draft.has_pressure;
            by_id_[id_of(node)] = it->second;
            return;
        }
        by_id_[id_of(node)] = drafts_.size();
        drafts_.push_back(std::move(draft));
    }

    /// Columns of the channels that a sample is made of; −1: not there.
    struct Columns {
        explicit Columns(const InkmlFormat& f)
            : x(f.find("X")),
              y(f.find("Y")),
              z(f.find("Z")),
              time(f.find("T")),
              pressure(f.find("P") >= 0 ? f.find("P") : f.find("F")),
              tilt{f.find("OTx"), f.find("OTy")},
              azimuth(f.find("OA")),
              elevation(f.find("OE")),
              roll(f.find("OR")),
              rotation{f.find("QW"), f.find("QX"), f.find("QY"), f.find("QZ")} {}

        bool turned() const { return *std::min_element(std::begin(rotation), std::end(rotation)) >= 0; }
        bool flat() const { return z < 0 && !turned(); }

        int x, y, z, time, pressure, tilt[2], azimuth, elevation, roll, rotation[4];
    };

    /// The sample of one row. A trace in space has a rotation: its own, or that of tilt and roll.
    StrokeSample sample_of(const InkmlRows& rows, std::size_t row, const Columns& c, long line) const {
        const auto get = [&](int k) { return k >= 0 ? rows.at(row, k) : 0.0; };
        StrokeSample s;
        s.position = {get(c.x), get(c.y), get(c.z)};
        for (int k = 0; k < 3; ++k)
            if (std::abs(s.position[k]) > options_.max_extent)
                throw Error(path, line,
                            Message("a coordinate lies more than {} m away; declare the unit of X and Y",
                                    static_cast<long>(options_.max_extent)));
        s.time = get(c.time);
        s.pressure = get(c.pressure);
        s.tilt = {get(c.tilt[0]), get(c.tilt[1])};
        if (c.tilt[0] < 0 && c.tilt[1] < 0 && c.elevation >= 0) {
            const double lean = std::clamp(90 * kDegree - get(c.elevation), 0.0, 85 * kDegree);
            s.tilt = {std::atan(std::tan(lean) * std::cos(get(c.azimuth))),
                      std::atan(std::tan(lean) * std::sin(get(c.azimuth)))};
        }
        s.roll = get(c.roll);
        for (int k = 0; k < 2; ++k) s.tilt[k] = std::clamp(s.tilt[k], -85 * kDegree, 85 * kDegree);
        if (c.turned()) {
            s.rotation = Quat(get(c.rotation[0]), get(c.rotation[1]), get(c.rotation[2]), get(c.rotation[3]));
            const double size = glm::length(s.rotation);
            if (!(size > 1e-6 && size < 1e6)) throw Error(path, line, "a rotation is zero, or out of range");
            if (!is_unit(glm::dot(s.rotation, s.rotation))) s.rotation = glm::normalize(s.rotation);
        } else if (!c.flat()) {
            const Vec3 up = glm::normalize(Vec3(std::tan(s.tilt.x), std::tan(s.tilt.y), 1));
            s.rotation = Quat(Vec3(0, 0, 1), up);
            if (s.roll != 0) s.rotation = glm::normalize(s.rotation * glm::angleAxis(s.roll, Vec3(0, 0, 1)));
            s.roll = 0;  // the rotation has it
        }
        return s;
    }

    Draft draft_of(const InkmlRows& rows, const State& state, long line) const {
        const InkmlFormat& f = state.format;
        const Columns columns(f);
        const int p = columns.pressure;
        Draft d;
        d.line = line;
        d.has_time = columns.time >= 0;
        d.has_pressure = p >= 0;
        d.pressure_ranged = p < 0 || f.channels[static_cast<std::size_t>(p)].ranged;
        d.sample_rate = state.sample_rate;
        d.trace.flat = columns.flat();
        d.trace.placement = state.marks.placement;
        d.trace.placed = state.marks.placed;
        d.trace.brush = state.marks.brush;
        d.trace.ink = state.marks.ink;
        d.trace.names = {state.marks.layer, state.marks.mask};
        d.trace.stencil = state.marks.stencil;
        d.trace.erases = state.marks.erases;
        d.trace.on_palette = state.marks.on_palette;
        d.trace.seed = state.marks.seed;
        d.trace.label = state.marks.label;
        d.trace.settings = state.marks.settings;
        d.keeps_clock = state.marks.keeps_clock;
        d.trace.pressed = d.has_pressure;
        d.trace.samples.reserve(rows.n_rows());
        for (std::size_t i = 0; i < rows.n_rows(); ++i) d.trace.samples.push_back(sample_of(rows, i, columns, line));
        return d;
    }

    // --- what needs the whole file ---------------------------------------------

    void finish() {
        double largest = 1;  // of pressures without a range
        for (const Draft& d : drafts_)
            if (!d.pressure_ranged)
                for (const StrokeSample& s : d.trace.samples) largest = std::max(largest, s.pressure);
        for (Draft& d : drafts_) {
            auto& samples = d.trace.samples;
            for (StrokeSample& s : samples)
                s.pressure = std::clamp(s.pressure / (d.pressure_ranged ? 1 : largest), 0.0, 1.0);
            if (samples.empty()) continue;
            set_times(d);
            if (d.trace.flat && !d.has_pressure) default_pressure(d.trace);
            try {
                stroke::check_samples(d.trace);
            } catch (const Error& error) {
                throw Error(path, d.line, error.message());
            }
        }
    }

    void set_times(Draft& d) const {
        auto& samples = d.trace.samples;
        const bool kept = d.has_time && d.keeps_clock;
        const double start = samples.front().time;
        double length = 0, last = kept ? start : 0;
        for (std::size_t i = 0; i < samples.size(); ++i) {
            if (i > 0) length += glm::length(samples[i].position - samples[i - 1].position);
            double t = length / options_.pen_speed;
            if (kept)
                t = samples[i].time;
            else if (d.has_time)
                t = samples[i].time - start;
            else if (d.sample_rate > 0)
                t = static_cast<double>(i) / d.sample_rate;
            else if (d.duration > 0 && samples.size() > 1)
                t = d.duration * static_cast<double>(i) / static_cast<double>(samples.size() - 1);
            samples[i].time = last = std::max(t, last);
        }
    }

    /// Swells in, tapers out, and is lighter where the pen is fast.
    void default_pressure(RecordedStroke& trace) const {
        auto& s = trace.samples;
        const std::size_t n = s.size();
        std::vector<double> along(n, 0);
        for (std::size_t i = 1; i < n; ++i) along[i] = along[i - 1] + glm::length(s[i].position - s[i - 1].position);
        const double first = s.front().time, last = s.back().time;
        const double length = along.back(), duration = last - first;
        const double swell = std::min(0.25 * length, 4e-3), taper = std::min(0.25 * length, 3e-3);
        for (std::size_t i = 0; i < n; ++i) {
            double p = options_.flat_pressure;
            if (length > 0) {
                p *= 0.25 + 0.75 * smooth_step(along[i] / swell);
                p *= 0.25 + 0.75 * smooth_step((length - along[i]) / taper);
                const double from = std::max(s[i].time - kSpeedWindow, first),
                             to = std::min(s[i].time + kSpeedWindow, last);
                if (to > from && duration > 0) {
                    const double travelled = length_at(s, along, to) - length_at(s, along, from);
                    const double speed = travelled / (to - from) / (length / duration);
                    p *= std::clamp(std::pow(std::max(speed, 1e-3), -0.25), 0.7, 1.3);
                }
            }
            s[i].pressure = std::clamp(p, 0.0, 1.0);
        }
    }

    const InkmlOptions& options_;
    pugi::xml_document document_;
    std::map<std::string, xml_node> ids_;
    std::map<std::string, std::size_t> by_id_;
    std::vector<Draft> drafts_;
    std::size_t n_samples_ = 0;
};

}  // namespace

std::vector<RecordedStroke> parse_inkml(std::string_view text, const std::string& source, const InkmlOptions& options) {
    return Reader(text, source, options).run();
}

std::vector<RecordedStroke> read_inkml(const std::filesystem::path& path, const InkmlOptions& options) {
    const std::vector<char> bytes = read_file(path, options.max_bytes);
    return parse_inkml({bytes.data(), bytes.size()}, path.string(), options);
}

}  // namespace tuft::io
