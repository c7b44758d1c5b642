#include "writer/gesture/side_table.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "core/error.h"
#include "core/files/files.h"
#include "writer/gesture/corners.h"

namespace tuft::writer {
namespace {

constexpr std::size_t kMostBytes = std::size_t{8} << 20, kMostOutputs = 4096, kMostFeatures = 256, kMostModels = 4096;
constexpr double kScale = 0.001;  // of the file's whole numbers
constexpr double kClip = 4;       // standard deviations that a feature counts at most
constexpr std::size_t kFans = 2 * kFan;
constexpr double kMostPredicted = 130;  // units of a side

/// Key of the model of a segment of a class that has none: its code, and a dash where the stroke goes on.
std::string segment_key(char code, bool first, bool last) {
    return std::string(first ? "" : "-") + code + (last ? "" : "-");
}

std::size_t segments_of_key(const std::string& key) {
    return static_cast<std::size_t>(std::count_if(key.begin(), key.end(), [](char c) { return c != '-'; }));
}

constexpr double kPenWidest = 1.25, kPenWider = 8;  // of the median side, and units, that a side counts of a pen's line
constexpr double kRoundHalf = 24;                   // units of half width of a round stroke downwards
constexpr double kRoundTaper = 1.0 / 6;             // of its length: the tail
constexpr double kRoundTip = 0.3;                   // of the half width, that of the tip
constexpr double kRoundHead = 30;                   // units over which the head grows
constexpr double kTurnReach = 16;                   // units before and after a place, of its direction

}  // namespace

bool is_round(const StrokeLine& line) {
    for (const LineSegment& s : line.segments) {
        double turn = 0, least = 0, most = 0;
        Vec2 before(0);
        for (double at = line.along[s.first]; at <= line.along[s.last]; at += kTurnReach) {
            const Vec2 d = line.direction(at, kTurnReach);
            if (before != Vec2(0)) turn += std::atan2(before.x * d.y - before.y * d.x, glm::dot(before, d));
            least = std::min(least, turn), most = std::max(most, turn), before = d;
        }
        if (most - least > kRoundTurn) return true;
    }
    return false;
}

StrokeSides round_sides(const StrokeLine& line) {
    StrokeSides sides;
    const auto half_at = [&](double at) {
        const double head = std::clamp(0.7 + 0.3 * at / kRoundHead, 0.0, 1.0),
                     tail = std::clamp((line.length() - at) / (kRoundTaper * line.length()), 0.0, 1.0);
        return kRoundHalf * (3 - line.direction(at, kTurnReach).y) / 4 * head * std::lerp(kRoundTip, 1.0, tail);
    };
    for (const LineSegment& s : line.segments) {
        sides.left.emplace_back();
        for (std::size_t k = 0; k < kKnots; ++k)
            sides.left.back()[k] = half_at(line.along[s.first] + kKnotPlaces[k] * s.length);
    }
    sides.right = sides.left;
    sides.head.fill(half_at(0)), sides.tail.fill(half_at(line.length()));
    return sides;
}

std::vector<double> row_of(const StrokeSides& sides) {
    std::vector<double> row;
    for (std::size_t s = 0; s < sides.left.size(); ++s) {
        row.insert(row.end(), sides.left[s].begin(), sides.left[s].end());
        row.insert(row.end(), sides.right[s].begin(), sides.right[s].end());
    }
    row.insert(row.end(), sides.head.begin(), sides.head.end());
    row.insert(row.end(), sides.tail.begin(), sides.tail.end());
    return row;
}

StrokeSides sides_of(const std::vector<double>& row, std::size_t n_segments) {
    StrokeSides sides;
    auto at = row.begin();
    const auto take = [&](auto& to) {
        std::copy_n(at, to.size(), to.begin());
        at += static_cast<std::ptrdiff_t>(to.size());
    };
    sides.left.resize(n_segments), sides.right.resize(n_segments);
    for (std::size_t s = 0; s < n_segments; ++s) take(sides.left[s]), take(sides.right[s]);
    take(sides.head), take(sides.tail);
    return sides;
}

std::vector<double> SideTable::Model::evaluate(const std::vector<double>& features) const {
    std::vector<double> x(n_features), parts = bias;
    for (std::size_t f = 0; f < n_features; ++f)
        x[f] = std::clamp((features[f] - feature_mean[f]) / feature_scale[f], -kClip, kClip);
    for (std::size_t r = 0; r < rank; ++r)
        for (std::size_t f = 0; f < n_features; ++f) parts[r] += direct[r * n_features + f] * x[f];
    for (std::size_t h = 0; h < n_hidden; ++h) {
        double sum = hidden_bias[h];
        for (std::size_t f = 0; f < n_features; ++f) sum += hidden[h * n_features + f] * x[f];
        const double active = std::tanh(sum);
        for (std::size_t r = 0; r < rank; ++r) parts[r] += output[r * n_hidden + h] * active;
    }
    std::vector<double> out = mean;
    for (std::size_t r = 0; r < rank; ++r)
        for (std::size_t o = 0; o < n_outputs; ++o) out[o] += basis[r * n_outputs + o] * parts[r];
    return out;
}

SideTable SideTable::load(const std::filesystem::path& path) {
    const std::vector<char> bytes = read_file(path, kMostBytes);
    return parse({bytes.data(), bytes.size()}, path.string());
}

SideTable SideTable::parse(std::string_view text, const std::string& source) {
    SideTable table;
    std::istringstream in{std::string(text)};
    long line_number = 0;
    std::string line;
    const auto next = [&](std::string& to) {
        while (std::getline(in, to)) {
            ++line_number;
            if (!to.empty() && to[0] != '#') return true;
        }
        return false;
    };
    const auto fail = [&](const char* what) { throw Error(source, line_number, Message(what)); };
    const auto numbers = [&](std::size_t n) {
        if (!next(line)) fail("the table ends within a class");
        std::istringstream row(line);
        std::vector<double> out(n);
        for (double& v : out)
            if (!(row >> v) || !(std::abs(v) < 1e7))
                fail("a row has too few numbers, or one that is none");
            else
                v *= kScale;
        return out;
    };
    while (next(line)) {
        std::istringstream head(line);
        std::string key;
        Model m;
        if (!(head >> key >> m.n_features >> m.n_outputs >> m.n_hidden >> m.rank) || m.n_features > kMostFeatures ||
            m.n_outputs > kMostOutputs || m.n_hidden > 256 || m.rank > 64 || table.models_.size() >= kMostModels)
            fail("a class begins with its codes and the numbers of features, outputs, hidden units and components");
        const std::size_t n = segments_of_key(key);
        if (m.n_features != count_features(n) || m.n_outputs != 2 * kKnots * n + kFans)
            fail("the numbers of features and outputs do not suit the class");
        m.feature_mean = numbers(m.n_features);
        m.feature_scale = numbers(m.n_features);
        if (std::any_of(m.feature_scale.begin(), m.feature_scale.end(), [](double v) { return !(v > 0); }))
            fail("the scale of a feature is not positive");
        m.mean = numbers(m.n_outputs);
        m.basis = numbers(m.rank * m.n_outputs);
        m.hidden = numbers(m.n_hidden * m.n_features);
        m.hidden_bias = numbers(m.n_hidden);
        m.output = numbers(m.rank * m.n_hidden);
        m.bias = numbers(m.rank);
        m.direct = numbers(m.rank * m.n_features);
        table.models_[key] = std::move(m);
    }
    for (const char code : std::string("HTULPSN"))
        for (const bool first : {false, true})
            for (const bool last : {false, true})
                if (!table.models_.contains(segment_key(code, first, last)))
                    throw Error(source, Message("the table has no segment {}", segment_key(code, first, last)));
    return table;
}

StrokeSides SideTable::predict(const StrokeLine& line, const Glyph& glyph, std::size_t stroke) const {
    if (!is_han(glyph.code) && is_round(line)) return round_sides(line);
    const std::size_t n = line.segments.size();
    const std::vector<double> features = stroke_features(line, glyph, stroke);
    StrokeSides sides;
    if (const auto found = models_.find(line.stroke_class()); found != models_.end()) {
        sides = sides_of(found->second.evaluate(features), n);
    } else {
        const std::size_t per_stroke = count_features(0), per_segment = count_features(1) - per_stroke;
        for (std::size_t s = 0; s < n; ++s) {
            std::vector<double> own(features.begin(), features.begin() + static_cast<std::ptrdiff_t>(per_stroke));
            const auto at = features.begin() + static_cast<std::ptrdiff_t>(per_stroke + s * per_segment);
            own.insert(own.end(), at, at + static_cast<std::ptrdiff_t>(per_segment));
            const Model& model = models_.at(segment_key(line.segments[s].code, s == 0, s + 1 == n));
            const StrokeSides part = sides_of(model.evaluate(own), 1);
            sides.left.push_back(part.left[0]), sides.right.push_back(part.right[0]);
            if (s == 0) sides.head = part.head;
            if (s + 1 == n) sides.tail = part.tail;
        }
        for (std::size_t s = 1; s < n; ++s)  // a corner has one width
            for (auto* side : {&sides.left, &sides.right})
                (*side)[s][0] = (*side)[s - 1][kKnots - 1] = 0.5 * ((*side)[s][0] + (*side)[s - 1][kKnots - 1]);
    }
    double widest = kMostPredicted;
    if (glyph.of_pen) {
        std::vector<double> all;
        for (const auto* side : {&sides.left, &sides.right})
            for (const auto& row : *side) all.insert(all.end(), row.begin(), row.end());
        const auto middle = all.begin() + static_cast<std::ptrdiff_t>(all.size() / 2);
        std::nth_element(all.begin(), middle, all.end());
        widest = std::clamp(kPenWidest * *middle + kPenWider, 1.0, kMostPredicted);
    }
    for (auto* side : {&sides.left, &sides.right})
        for (auto& row : *side)
            for (double& v : row) v = std::clamp(v, 1.0, widest);
    for (auto* fan : {&sides.head, &sides.tail})
        for (double& v : *fan) v = std::clamp(v, 0.0, 70.0);
    if (glyph.strokes[stroke].outline.empty()) limit_corners(line, sides);
    return sides;
}

}  // namespace tuft::writer
