#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "core/error.h"
#include "core/text/nesting.h"
#include "core/text/text.h"
#include "core/text/units.h"
#include "io/motion/motion_files.h"
#include "io/motion/stroke_description.h"

/// A trajectory as a table (CSV, RFC 4180), written and read.
namespace tuft::io {
namespace {

constexpr std::array kNumbers{"t_s", "x_mm", "y_mm", "z_mm", "qw", "qx", "qy", "qz"};
constexpr const char *kKind = "kind", *kStroke = "stroke", *kHand = "hand_s", *kPaint = "stroke_json";
constexpr const char* kNeeded = "t_s, x_mm, y_mm, z_mm, qw, qx, qy, qz";
constexpr double kMostStrokes = 1e6;

std::string quoted(const std::string& text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"') out += '"';
        out += c;
    }
    return out + '"';
}

std::optional<double> finite_number(std::string_view text) {
    while (text.starts_with(' ')) text.remove_prefix(1);
    while (text.ends_with(' ')) text.remove_suffix(1);
    double value = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (fault != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
    return value;
}

/// Cells of a table, row by row.
class CsvReader {
  public:
    explicit CsvReader(std::string_view text) : text_(text) {
        if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;
    }

    /// Reads the next row; false at the end. Throws `Error` for a quote that is not closed.
    bool next(std::vector<std::string>& cells) {
        cells.clear();
        if (at_ >= text_.size()) return false;
        ++row_;
        cells.emplace_back();
        bool in_quotes = false;
        for (; at_ < text_.size(); ++at_) {
            const char c = text_[at_];
            if (in_quotes) {
                if (c != '"')
                    cells.back() += c;
                else if (at_ + 1 < text_.size() && text_[at_ + 1] == '"')
                    cells.back() += text_[++at_];
                else
                    in_quotes = false;
            } else if (c == '"') {
                in_quotes = true;
            } else if (c == ',') {
                cells.emplace_back();
            } else if (c == '\n') {
                ++at_;
                return true;
            } else if (c != '\r') {
                cells.back() += c;
            }
        }
        if (in_quotes) throw Error("a quote is not closed");
        return true;
    }
    long row() const { return row_; }

  private:
    std::string_view text_;
    std::size_t at_ = 0;
    long row_ = 0;
};

/// Columns by their names in the first row.
struct Columns {
    std::array<std::size_t, kNumbers.size()> numbers{};
    std::optional<std::size_t> kind, stroke, hand, paint;

    explicit Columns(const std::vector<std::string>& names) {
        const auto find = [&](const char* name) -> std::optional<std::size_t> {
            const auto at = std::find(names.begin(), names.end(), name);
            if (at == names.end()) return std::nullopt;
            return static_cast<std::size_t>(at - names.begin());
        };
        for (std::size_t i = 0; i < kNumbers.size(); ++i) {
            const auto at = find(kNumbers[i]);
            if (!at)
                throw Error(
                    Message("has no column '{}'; a trajectory has {}", std::string(kNumbers[i]), std::string(kNeeded)));
            numbers[i] = *at;
        }
        kind = find(kKind);
        stroke = find(kStroke);
        hand = find(kHand);
        paint = find(kPaint);
    }
};

/// The strokes of a table.
class TableStrokes {
  public:
    explicit TableStrokes(const Columns& columns) : columns_(columns) {}

    void add(const std::vector<std::string>& cells) {
        if (columns_.kind && cell(cells, *columns_.kind) != motion::name_of(motion::MoveKind::stroke)) return;
        const double number = columns_.stroke ? number_in(cells, *columns_.stroke) : 1;
        if (!(number >= 0 && number <= kMostStrokes) || number != std::floor(number))
            throw Error(Message("'{}' is no number of a stroke", excerpt(cell(cells, *columns_.stroke))));
        const auto [at, is_new] = index_.emplace(static_cast<std::size_t>(number), strokes_.size());
        if (is_new) strokes_.push_back(begin(cells));
        std::array<double, kNumbers.size()> v;
        for (std::size_t i = 0; i < v.size(); ++i) v[i] = number_in(cells, columns_.numbers[i]);
        stroke::RecordedStroke& s = strokes_[at->second];
        if (is_new) clocks_.push_back({columns_.hand && !cell(cells, *columns_.hand).empty(), 0});
        Clock& clock = clocks_[at->second];
        const double time = clock.is_hand ? number_in(cells, *columns_.hand) : v[0];
        if (is_new) clock.start = time;
        stroke::StrokeSample sample;
        sample.time = time - clock.start;
        sample.position = kMillimetre * Vec3(v[1], v[2], v[3]);
        sample.rotation = Quat(v[4], v[5], v[6], v[7]);
        s.samples.push_back(sample);
    }
    std::vector<stroke::RecordedStroke> take() {
        if (strokes_.empty()) throw Error("has no strokes");
        for (const stroke::RecordedStroke& s : strokes_) stroke::check_samples(s);
        return std::move(strokes_);
    }

  private:
    /// Of a stroke: the hand's where its first row has one, else the tool's.
    struct Clock {
        bool is_hand = false;
        double start = 0;  ///< seconds
    };

    static const std::string& cell(const std::vector<std::string>& cells, std::size_t column) {
        if (column >= cells.size()) throw Error("a row has too few cells");
        return cells[column];
    }
    static double number_in(const std::vector<std::string>& cells, std::size_t column) {
        const std::string& text = cell(cells, column);
        const std::optional<double> value = finite_number(text);
        if (!value) throw Error(Message("'{}' is not a number", excerpt(text)));
        return *value;
    }
    stroke::RecordedStroke begin(const std::vector<std::string>& cells) const {
        stroke::RecordedStroke s;
        s.flat = false;
        if (!columns_.paint || *columns_.paint >= cells.size() || cells[*columns_.paint].empty()) return s;
        const std::string& text = cells[*columns_.paint];
        check_json_nesting(text, kPaint);
        try {
            return stroke_of(nlohmann::json::parse(text));
        } catch (const nlohmann::json::exception&) {
            throw Error(Message("'{}' does not say what a stroke is painted with", excerpt(text)));
        }
    }

    const Columns& columns_;
    std::map<std::size_t, std::size_t> index_;  // by the table's number
    std::vector<stroke::RecordedStroke> strokes_;
    std::vector<Clock> clocks_;
};

}  // namespace

std::string trajectory_csv(const MotionProgram& program) {
    std::string text = "move,kind,stroke,t_s,x_mm,y_mm,z_mm,qw,qx,qy,qz,fx_n,fy_n,fz_n,hand_s,stroke_json\n";
    for (std::size_t i = 0; i < program.trajectory.moves.size(); ++i) {
        const motion::Move& move = program.trajectory.moves[i];
        std::string paint;
        if (move.kind == motion::MoveKind::stroke)
            paint = quoted(stroke_json(program.strokes[move.stroke])
                               .dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
        for (const motion::Waypoint& p : move.points) {
            const Vec3 mm = p.pose.position / kMillimetre;
            const Quat& q = p.pose.rotation;
            text += fmt::format(
                "{},{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.9f},{:.9f},{:.9f},{:.9f},{:.5f},{:.5f},{:.5f},{},{}\n", i + 1,
                motion::name_of(move.kind), move.stroke + 1, p.pose.time, mm.x, mm.y, mm.z, q.w, q.x, q.y, q.z,
                p.force.x, p.force.y, p.force.z, p.hand_time ? fmt::format("{:.6f}", *p.hand_time) : "",
                std::exchange(paint, {}));
        }
    }
    return text;
}

std::vector<stroke::RecordedStroke> parse_trajectory_csv(std::string_view text, const std::string& source) {
    CsvReader reader(text);
    try {
        std::vector<std::string> cells;
        if (!reader.next(cells)) throw Error("the file is empty");
        const Columns columns(cells);
        TableStrokes strokes(columns);
        while (reader.next(cells))
            if (cells.size() > 1 || !cells[0].empty()) strokes.add(cells);
        return strokes.take();
    } catch (const Error& error) {
        throw Error(source, reader.row(), error.message());
    }
}

}  // namespace tuft::io
