#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstring>

#include "core/error.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/read/soup_builder.h"
#include "mesh/read/text_cursor.h"

// OFF as the Geomview manual [Phillips1993] has it: [ST][C][N][4][n]OFF [BINARY].
namespace tuft::mesh {
namespace {

struct OffKind {
    bool has_uv = false, has_colour = false, has_normal = false, is_binary = false;
};

/// Reads the first word, e.g. "STCNOFF"; files that begin with the counts have none.
OffKind read_kind(TextCursor& text) {
    OffKind kind;
    if (!text.skip_to_token()) text.fail("holds no data");
    TextCursor ahead = text;
    std::string_view word = ahead.word();
    const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
    if (is_digit(word.front()) && is_digit(word.back())) return kind;
    // Some writers leave out the end of the line: OFF490 518 0.
    if (const std::size_t head = word.find_last_of("Ff"); head != word.npos && head > 0 && head + 1 < word.size())
        if (std::all_of(word.begin() + static_cast<std::ptrdiff_t>(head) + 1, word.end(), is_digit))
            word = word.substr(0, head + 1);
    text.skip(word.size());
    const std::string_view whole = word;
    const auto take = [&](std::string_view prefix) {
        if (word.size() < prefix.size() + 3 || !same_word(word.substr(0, prefix.size()), prefix)) return false;
        word.remove_prefix(prefix.size());
        return true;
    };
    kind.has_uv = take("ST");
    kind.has_colour = take("C");
    kind.has_normal = take("N");
    if (!same_word(word, "OFF"))
        text.fail(Message("{} is not a three-dimensional OFF head such as OFF or COFF", in_quotes(whole)));
    ahead = text;
    if (same_word(ahead.word(), "BINARY")) {
        text.word();
        kind.is_binary = true;
    }
    return kind;
}

class OffReader {
  public:
    OffReader(const std::vector<char>& bytes, const std::string& file)
        : file_(file), bytes_(bytes), text_(bytes, file, {.comment = '#'}), builder_(file, "line") {}

    PolygonSoup read() {
        kind_ = read_kind(text_);
        if (kind_.is_binary) {
            text_.next_line();
            return read_binary();
        }
        return read_text();
    }

  private:
    PolygonSoup read_text();
    PolygonSoup read_binary();
    void read_text_point();
    void read_text_face();
    void check_counts(std::int64_t points, std::int64_t faces, std::size_t left, std::size_t point_size,
                      std::size_t face_size) const;
    std::uint32_t point_index(std::int64_t written) const;
    void add_face(long place, std::uint32_t group);
    std::uint32_t face_colour();
    void finish_colours();

    std::string file_;
    std::span<const char> bytes_;
    TextCursor text_;
    SoupBuilder builder_;
    OffKind kind_;
    std::size_t n_points_ = 0;
    std::vector<std::array<double, 4>> colours_;
    bool colour_is_real_ = false;
    std::vector<Vec2f> point_uvs_, face_uvs_;
    std::vector<std::uint32_t> corners_;
};

void OffReader::check_counts(std::int64_t points, std::int64_t faces, std::size_t left, std::size_t point_size,
                             std::size_t face_size) const {
    const auto limit = [&](std::size_t size) { return static_cast<std::int64_t>(left / size); };
    if (points < 0 || faces < 0 || points > limit(point_size) || faces > limit(face_size))
        text_.fail(Message("promises {} vertices and {} faces, more than the file can hold; it is cut off or damaged",
                           points, faces));
}

PolygonSoup OffReader::read_text() {
    if (!text_.skip_to_token()) text_.fail("the file ends before its counts");
    const std::int64_t points = text_.integer("the number of vertices");
    if (!text_.skip_to_token()) text_.fail("the file ends before its counts");
    const std::int64_t faces = text_.integer("the number of faces");
    check_counts(points, faces, text_.left(), 6, 8);
    text_.next_line();  // the number of edges is not needed and often wrong
    n_points_ = static_cast<std::size_t>(points);
    builder_.soup.points.reserve(n_points_);
    for (std::int64_t i = 0; i < points; ++i) read_text_point();
    for (std::int64_t i = 0; i < faces; ++i) read_text_face();
    finish_colours();
    return builder_.finish();
}

void OffReader::read_text_point() {
    if (!text_.skip_to_token()) text_.fail("the file ends among its vertices; it is cut off");
    const long line = text_.line();
    double xyz[3];
    for (double& value : xyz) value = text_.number("a coordinate");
    double more[11] = {};
    bool real[9] = {};
    int n = 0;
    for (; n < 9 && text_.more(); ++n) {
        more[n] = text_.number("a vertex value");
        real[n] = text_.last_was_real();
    }
    text_.next_line();
    builder_.add_point({xyz[0], xyz[1], xyz[2]}, line);
    if (kind_.has_uv) {
        n = std::max(n - 2, 0);
        point_uvs_.emplace_back(more[n], more[n + 1]);
    }
    const int first = kind_.has_normal ? 3 : 0;
    if (n - first >= 3 && (kind_.has_colour || !kind_.has_normal)) {
        const bool has_alpha = n - first >= 4;
        colour_is_real_ = colour_is_real_ || real[first] || real[first + 1] || real[first + 2];
        colours_.resize(builder_.soup.points.size() - 1, {255, 255, 255, -1});
        colours_.push_back({more[first], more[first + 1], more[first + 2], has_alpha ? more[first + 3] : -1});
    }
}

std::uint32_t OffReader::point_index(std::int64_t written) const {
    if (written < 0 || static_cast<std::size_t>(written) >= n_points_) {
        const std::string what = "the face uses vertex " + std::to_string(written) + ", but the file has only " +
                                 std::to_string(n_points_) + " (counted from 0)";
        if (kind_.is_binary) throw Error(file_, what);
        text_.fail(what);
    }
    return static_cast<std::uint32_t>(written);
}

void OffReader::add_face(long place, std::uint32_t group) {
    face_uvs_.clear();
    if (kind_.has_uv)
        for (const std::uint32_t c : corners_) face_uvs_.push_back(point_uvs_[c]);
    builder_.add_polygon(corners_, face_uvs_, group, place);
}

/// Three or four numbers behind the corners are the colour of the face, whole or real ones; fewer are
/// an index into a table that there is none of.
std::uint32_t OffReader::face_colour() {
    std::array<double, 4> rgba{};
    int n = 0;
    bool is_real = false;
    for (; n < 4 && text_.more(); ++n) {
        const std::string_view word = text_.word();
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), rgba[n]);
        if (error != std::errc() || end != word.data() + word.size()) break;
        is_real = is_real || word.find_first_of(".eE") != std::string_view::npos;
    }
    return n < 3 ? kNone : builder_.colour_group(colour_from(rgba, is_real));
}

void OffReader::read_text_face() {
    if (!text_.skip_to_token()) text_.fail("the file ends among its faces; it is cut off");
    const long line = text_.line();
    const std::int64_t n = text_.integer("the number of corners");
    if (n < 0 || n > static_cast<std::int64_t>(text_.left()))
        text_.fail(Message("a face cannot have {} corners here", n));
    corners_.clear();
    for (std::int64_t k = 0; k < n; ++k) corners_.push_back(point_index(text_.integer("a corner")));
    const std::uint32_t group = face_colour();
    text_.next_line();
    add_face(line, group);
}

/// Big-endian 32-bit values: counts, points, then per face its corners and a colour list.
PolygonSoup OffReader::read_binary() {
    const char* at = text_.position();
    const char* end = bytes_.data() + bytes_.size();
    const auto left = [&] { return static_cast<std::size_t>(end - at); };
    const auto word = [&]() -> std::uint32_t {
        if (left() < 4) throw Error(file_, "the file is cut off");
        unsigned char raw[4];
        std::memcpy(raw, at, 4);
        at += 4;
        return std::uint32_t{raw[0]} << 24 | std::uint32_t{raw[1]} << 16 | std::uint32_t{raw[2]} << 8 | raw[3];
    };
    const auto real = [&] {
        const std::uint32_t bits = word();
        float value;
        std::memcpy(&value, &bits, sizeof value);
        return static_cast<double>(value);
    };
    const auto points = static_cast<std::int32_t>(word());
    const auto faces = static_cast<std::int32_t>(word());
    word();
    const std::size_t point_size =
        12 + (kind_.has_normal ? 12 : 0) + (kind_.has_colour ? 16 : 0) + (kind_.has_uv ? 8 : 0);
    check_counts(points, faces, left(), point_size, 8);
    n_points_ = static_cast<std::size_t>(points);
    colour_is_real_ = true;
    for (std::int32_t i = 0; i < points; ++i) {
        const double x = real(), y = real(), z = real();
        builder_.add_point({x, y, z}, i + 1);
        for (int k = 0; kind_.has_normal && k < 3; ++k) real();
        if (kind_.has_colour) {
            const double r = real(), g = real(), b = real(), a = real();
            colours_.push_back({r, g, b, a});
        }
        if (kind_.has_uv) {
            const double u = real(), v = real();
            point_uvs_.emplace_back(u, v);
        }
    }
    for (std::int32_t i = 0; i < faces; ++i) {
        const std::uint32_t n = word();
        if (n > left() / 4) throw Error(file_, Message("face {} is cut off", i + 1));
        corners_.clear();
        for (std::uint32_t k = 0; k < n; ++k) corners_.push_back(point_index(static_cast<std::int32_t>(word())));
        const std::uint32_t n_colour = word();
        if (n_colour > left() / 4) throw Error(file_, Message("face {} is cut off", i + 1));
        std::array<double, 4> rgba{};
        for (std::uint32_t k = 0; k < n_colour; ++k) {
            const double value = real();
            if (k < 4) rgba[k] = value;
        }
        add_face(i + 1, n_colour < 3 ? kNone : builder_.colour_group(colour_from(rgba, true)));
    }
    finish_colours();
    return builder_.finish();
}

void OffReader::finish_colours() {
    if (colours_.empty()) return;
    const double full = colour_is_real_ ? 1 : 255;
    colours_.resize(builder_.soup.points.size(), {full, full, full, -1});
    for (std::array<double, 4>& c : colours_) {
        if (c[3] < 0) c[3] = full;
        builder_.soup.point_colours.push_back(colour_from(c, colour_is_real_));
    }
}

}  // namespace

PolygonSoup read_off(const std::vector<char>& bytes, const std::filesystem::path& path) {
    return OffReader(bytes, path.string()).read();
}

}  // namespace tuft::mesh
