#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/error.h"
#include "mesh/read/ply_header.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/read/soup_builder.h"
#include "mesh/read/text_cursor.h"

static_assert(std::endian::native == std::endian::little, "binary PLY is read for this order");

namespace tuft::mesh {
namespace {

/// The rows behind the head, value by value, text or binary.
class PlyBody {
  public:
    PlyBody(const std::vector<char>& bytes, const std::string& file, const PlyHeader& header)
        : file_(file),
          format_(header.format),
          text_(std::span(bytes).subspan(header.body), file, {.comment = 0}),
          first_line_(header.body_line),
          at_(bytes.data() + header.body),
          end_(bytes.data() + bytes.size()) {}

    bool is_text() const { return format_ == PlyFormat::kAscii; }
    std::size_t left() const { return is_text() ? text_.left() + 1 : static_cast<std::size_t>(end_ - at_); }
    long line() const { return first_line_ + text_.line() - 1; }

    void begin_element(const PlyElement& element) {
        element_ = &element;
        row_ = 0;
    }
    /// Where the row now being read is, for messages: its line, or its number from 1.
    long place() const { return is_text() ? line() : static_cast<long>(row_); }

    void begin_row() {
        ++row_;
        if (is_text() && !text_.skip_to_token()) fail_short();
    }
    void end_row() {
        if (is_text()) text_.next_line();
    }

    double value(PlyType type) {
        if (is_text()) return text_value();
        const std::size_t size = size_of(type);
        if (size > left()) fail_short();
        char raw[8];
        std::memcpy(raw, at_, size);
        at_ += size;
        if (format_ == PlyFormat::kBigEndian) std::reverse(raw, raw + size);
        switch (type) {
            case PlyType::kInt8:
                return as<std::int8_t>(raw);
            case PlyType::kUint8:
                return as<std::uint8_t>(raw);
            case PlyType::kInt16:
                return as<std::int16_t>(raw);
            case PlyType::kUint16:
                return as<std::uint16_t>(raw);
            case PlyType::kInt32:
                return as<std::int32_t>(raw);
            case PlyType::kUint32:
                return as<std::uint32_t>(raw);
            case PlyType::kFloat32:
                return as<float>(raw);
            case PlyType::kFloat64:
                return as<double>(raw);
        }
        return 0;
    }

    /// A list's length, checked against the bytes that are left.
    std::size_t list_size(const PlyProperty& property) {
        const double n = value(property.count_type);
        const std::size_t each = is_text() ? 2 : size_of(property.type);
        if (!(n >= 0) || n != std::floor(n)) fail(Message("the list '{}' has an impossible length", property.name));
        const std::size_t most = left() / each;
        if (n > static_cast<double>(most))
            fail(Message("the list '{}' is longer than the rest of the file", property.name));
        return static_cast<std::size_t>(n);
    }

    /// One item of a list; in text it may stand on a later line.
    double list_value(const PlyProperty& property) {
        if (is_text() && !text_.skip_to_token()) fail_short();
        return value(property.type);
    }

    void skip_bytes(std::size_t n) {
        if (n > left()) fail_short();
        at_ += n;
    }

    [[noreturn]] void fail(const Message& what) const {
        if (is_text()) throw Error(file_, line(), what);
        throw Error(file_, Message("{} row {}: {}", element_->name, row_, what));
    }
    [[noreturn]] void fail_short() const {
        fail(Message("the file ends in row {} of {} of element '{}'; it is cut off", row_, element_->count,
                     element_->name));
    }

  private:
    template <class T>
    static double as(const char* raw) {
        T value;
        std::memcpy(&value, raw, sizeof value);
        return static_cast<double>(value);
    }
    double text_value() {
        try {
            return text_.number("a value");
        } catch (const Error&) {
            // The cursor counts lines of the body, the message is to count those of the file.
            fail(text_.at_end() ? Message("the file is cut off in this row")
                                : Message("the row of element '{}' holds too few values or one that is not a number",
                                          element_->name));
        }
    }

    std::string file_;
    PlyFormat format_;
    TextCursor text_;
    long first_line_;
    const char* at_;
    const char* end_;
    const PlyElement* element_ = nullptr;
    std::size_t row_ = 0;
};

/// Where the rows of faces have their colour.
struct FaceColour {
    std::array<int, 3> property;
    double scale = 255;  ///< of full red

    explicit FaceColour(const PlyElement& element)
        : property{element.find({"red", "diffuse_red", "r"}), element.find({"green", "diffuse_green", "g"}),
                   element.find({"blue", "diffuse_blue", "b"})} {
        for (const int p : property)
            if (p < 0 || element.properties[static_cast<std::size_t>(p)].is_list) property[0] = -1;
        if (!is_there()) return;
        const PlyType type = element.properties[static_cast<std::size_t>(property[0])].type;
        scale = is_real(type) ? 1 : size_of(type) == 2 ? 65535 : 255;
    }
    bool is_there() const { return property[0] >= 0; }
};

class PlyReader {
  public:
    PlyReader(const std::vector<char>& bytes, const std::string& file)
        : file_(file),
          header_(read_ply_header(bytes, file)),
          body_(bytes, file, header_),
          builder_(file, header_.format == PlyFormat::kAscii ? "line" : "row") {}

    PolygonSoup read() {
        bool has_vertices = false;
        for (const PlyElement& e : header_.elements) {
            if (e.name != "vertex") continue;
            // Colours and UVs of one list would not fit the points of both.
            if (has_vertices) throw Error(file_, e.line, "the element 'vertex' is there twice");
            has_vertices = true;
            n_points_ = e.count;
        }
        for (const PlyElement& e : header_.elements) read_element(e);
        if (texcoord_mismatches_.count)
            builder_.soup.warnings.push_back(texcoord_mismatches_.text(
                "faces have a texcoord list that does not fit their corners", body_.is_text() ? "line" : "row"));
        PolygonSoup soup = builder_.finish();
        if (header_.textures.size() == 1 && soup.polygon_groups.empty() && soup.materials.empty())
            soup.material_names = header_.textures;
        return soup;
    }

  private:
    void read_element(const PlyElement& element);
    void read_vertices(const PlyElement& element);
    void read_faces(const PlyElement& element);
    void read_strips(const PlyElement& element);
    void skip_rows(const PlyElement& element);
    std::uint32_t point_index(double written) const;
    void add_face(std::span<const std::uint32_t> corners, std::span<const double> texcoords, std::uint32_t group);

    std::string file_;
    PlyHeader header_;
    PlyBody body_;
    SoupBuilder builder_;
    std::uint64_t n_points_ = 0;
    std::vector<Vec2f> point_uvs_;
    std::vector<Vec2f> face_uvs_;
    Tally texcoord_mismatches_;
};

void PlyReader::read_element(const PlyElement& element) {
    const std::size_t row = element.least_row_size(header_.format);
    body_.begin_element(element);
    if (row == 0 || element.count == 0) return;
    if (element.count > body_.left() / row)
        throw Error(file_, element.line,
                    Message("element '{}' promises {} rows, but the file holds at most {}; it is cut off or damaged",
                            element.name, element.count, body_.left() / row));
    if (element.name == "vertex") return read_vertices(element);
    const int list = element.find({"vertex_indices", "vertex_index"});
    if (list >= 0 && element.properties[static_cast<std::size_t>(list)].is_list) {
        if (element.name == "face") return read_faces(element);
        if (element.name == "tristrips") return read_strips(element);
    }
    skip_rows(element);
}

void PlyReader::skip_rows(const PlyElement& element) {
    if (!body_.is_text() && !element.has_list())
        return body_.skip_bytes(element.least_row_size(header_.format) * element.count);
    for (std::uint64_t r = 0; r < element.count; ++r) {
        body_.begin_row();
        for (const PlyProperty& p : element.properties) {
            if (!p.is_list) {
                body_.value(p.type);
                continue;
            }
            const std::size_t n = body_.list_size(p);
            for (std::size_t i = 0; i < n; ++i) body_.list_value(p);
        }
        body_.end_row();
    }
}

void PlyReader::read_vertices(const PlyElement& element) {
    const int xyz[3] = {element.find({"x"}), element.find({"y"}), element.find({"z"})};
    if (xyz[0] < 0 || xyz[1] < 0 || xyz[2] < 0) throw Error(file_, element.line, "the vertices have no x, y and z");
    const int rgba[4] = {element.find({"red", "diffuse_red", "r"}), element.find({"green", "diffuse_green", "g"}),
                         element.find({"blue", "diffuse_blue", "b"}), element.find({"alpha", "diffuse_alpha", "a"})};
    const int u = element.find({"s", "u", "texture_u", "texture_s"});
    const int v = element.find({"t", "v", "texture_v", "texture_t"});
    const bool has_colour = rgba[0] >= 0 && rgba[1] >= 0 && rgba[2] >= 0;
    const bool has_uv = u >= 0 && v >= 0;
    const PlyType colour_type =
        has_colour ? element.properties[static_cast<std::size_t>(rgba[0])].type : PlyType::kUint8;
    const double alpha = is_real(colour_type) ? 1.0 : size_of(colour_type) == 2 ? 65535.0 : 255.0;

    builder_.soup.points.reserve(element.count);
    if (has_colour) builder_.soup.point_colours.reserve(element.count);
    if (has_uv) point_uvs_.reserve(element.count);
    std::vector<double> row(element.properties.size());
    for (std::uint64_t r = 0; r < element.count; ++r) {
        body_.begin_row();
        const long place = body_.place();
        for (std::size_t k = 0; k < row.size(); ++k) {
            const PlyProperty& p = element.properties[k];
            row[k] = 0;
            if (!p.is_list) {
                row[k] = body_.value(p.type);
                continue;
            }
            const std::size_t n = body_.list_size(p);
            for (std::size_t i = 0; i < n; ++i) body_.list_value(p);
        }
        body_.end_row();
        const auto at = [&](int k) { return row[static_cast<std::size_t>(k)]; };
        builder_.add_point({at(xyz[0]), at(xyz[1]), at(xyz[2])}, place);
        if (has_uv) point_uvs_.emplace_back(at(u), at(v));
        if (has_colour) {
            std::array<double, 4> c{at(rgba[0]), at(rgba[1]), at(rgba[2]), rgba[3] >= 0 ? at(rgba[3]) : alpha};
            for (double& channel : c)
                if (alpha == 65535.0) channel /= 257.0;
            builder_.soup.point_colours.push_back(colour_from(c, is_real(colour_type)));
        }
    }
}

std::uint32_t PlyReader::point_index(double written) const {
    if (!(written >= 0) || written >= static_cast<double>(n_points_) || written != std::floor(written))
        body_.fail(Message("the face uses vertex {}, but the file has only {} (counted from 0)",
                           static_cast<long long>(std::isfinite(written) ? std::clamp(written, -1e15, 1e15) : -1.0),
                           n_points_));
    return static_cast<std::uint32_t>(written);
}

void PlyReader::add_face(std::span<const std::uint32_t> corners, std::span<const double> texcoords,
                         std::uint32_t group) {
    face_uvs_.clear();
    if (texcoords.size() == 2 * corners.size()) {
        for (std::size_t i = 0; i < corners.size(); ++i) face_uvs_.emplace_back(texcoords[2 * i], texcoords[2 * i + 1]);
    } else {
        if (!texcoords.empty()) texcoord_mismatches_.add(body_.place());
        if (!point_uvs_.empty())
            for (const std::uint32_t c : corners) face_uvs_.push_back(c < point_uvs_.size() ? point_uvs_[c] : Vec2f(0));
    }
    builder_.add_polygon(corners, face_uvs_, group, body_.place());
}

void PlyReader::read_faces(const PlyElement& element) {
    const int list = element.find({"vertex_indices", "vertex_index"});
    const int texcoord = element.find({"texcoord"});
    const int texture = element.find({"texnumber"});
    // The UVs of several images share one square: groups keep them apart.
    const bool has_groups = texture >= 0 && header_.textures.size() > 1;
    const FaceColour colour(element);
    builder_.soup.polygon_start.reserve(element.count + 1);
    builder_.soup.polygon_groups.reserve(element.count);
    builder_.soup.corners.reserve(std::min<std::size_t>(3 * element.count, body_.left() / (body_.is_text() ? 2 : 1)));
    std::vector<std::uint32_t> corners;
    std::vector<double> texcoords;
    for (std::uint64_t r = 0; r < element.count; ++r) {
        body_.begin_row();
        corners.clear();
        texcoords.clear();
        std::uint32_t group = kNone;
        std::array<double, 4> rgb{};
        for (std::size_t k = 0; k < element.properties.size(); ++k) {
            const PlyProperty& p = element.properties[k];
            const int i = static_cast<int>(k);
            if (!p.is_list) {
                const double value = body_.value(p.type);
                for (std::size_t c = 0; c < 3; ++c)
                    if (i == colour.property[c]) rgb[c] = value / colour.scale;
                if (i != texture || !has_groups) continue;
                const bool named = value >= 0 && value < static_cast<double>(header_.textures.size());
                group = named ? builder_.group(header_.textures[static_cast<std::size_t>(value)],
                                               header_.textures[static_cast<std::size_t>(value)])
                              : builder_.group("");
                continue;
            }
            const std::size_t n = body_.list_size(p);
            for (std::size_t j = 0; j < n; ++j) {
                const double value = body_.list_value(p);
                if (i == list) corners.push_back(point_index(value));
                if (i == texcoord) texcoords.push_back(value);
            }
        }
        if (colour.is_there() && !has_groups) group = builder_.colour_group(colour_from(rgb, true));
        add_face(corners, texcoords, group);
        body_.end_row();
    }
}

/// Triangle strips as old Stanford scans have them: -1 starts a new strip, every second
/// triangle is turned.
void PlyReader::read_strips(const PlyElement& element) {
    const int list = element.find({"vertex_indices", "vertex_index"});
    for (std::uint64_t r = 0; r < element.count; ++r) {
        body_.begin_row();
        for (std::size_t k = 0; k < element.properties.size(); ++k) {
            const PlyProperty& p = element.properties[k];
            if (!p.is_list) {
                body_.value(p.type);
                continue;
            }
            const std::size_t n = body_.list_size(p);
            std::uint32_t a = kNone, b = kNone;
            bool turned = false;
            for (std::size_t j = 0; j < n; ++j) {
                const double value = body_.list_value(p);
                if (static_cast<int>(k) != list) continue;
                if (value == -1) {
                    a = b = kNone;
                    turned = false;
                    continue;
                }
                const std::uint32_t c = point_index(value);
                if (a != kNone) {
                    const std::uint32_t corners[3] = {turned ? b : a, turned ? a : b, c};
                    // Strips repeat a vertex to turn round; those triangles are no defect.
                    if (a != b && b != c && a != c) add_face(corners, {}, kNone);
                    turned = !turned;
                }
                a = b;
                b = c;
            }
        }
        body_.end_row();
    }
}

}  // namespace

PolygonSoup read_ply(const std::vector<char>& bytes, const std::filesystem::path& path) {
    return PlyReader(bytes, path.string()).read();
}

}  // namespace tuft::mesh
