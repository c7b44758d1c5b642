#include <array>
#include <cstring>
#include <string_view>

#include "core/error.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/read/soup_builder.h"
#include "mesh/read/text_cursor.h"

// STL as 3D Systems' StereoLithography Interface Specification (1988) has it. Many binary
// files begin with "solid" too, so the size decides which kind it is.
namespace tuft::mesh {
namespace {

constexpr std::size_t kHead = 84;      // bytes before the first triangle
constexpr std::size_t kTriangle = 50;  // bytes: normal, three points, 16-bit attribute

std::uint32_t count_in_head(const std::vector<char>& bytes) {
    std::uint32_t n = 0;
    std::memcpy(&n, bytes.data() + kHead - 4, sizeof n);
    return n;
}

bool looks_like_text(const std::vector<char>& bytes, const std::string& file) {
    TextCursor text(bytes, file, {.comment = 0});
    if (!text.skip_to_token() || !same_word(text.word(), "solid")) return false;
    const std::size_t n = std::min<std::size_t>(bytes.size(), 1024);
    for (std::size_t i = 0; i < n; ++i) {
        const auto c = static_cast<unsigned char>(bytes[i]);
        if (c < 9 || (c > 13 && c < 32)) return false;
    }
    return true;
}

/// What the 16 bits behind a facet say of its colour: five bits each of red, green and blue. As VisCAM
/// and SolidView write it, the highest bit says that there is one, and blue is lowest. Where the head has
/// "COLOR=" and four bytes, as Materialise Magics writes it, that is the colour of all facets but of those
/// whose highest bit is 0, and red is lowest.
class FacetColours {
  public:
    explicit FacetColours(const std::vector<char>& bytes) {
        constexpr std::string_view kKey = "COLOR=";
        const std::string_view head(bytes.data(), kHead - 4);
        const std::size_t at = head.find(kKey);
        magics_ = at != std::string_view::npos && at + kKey.size() + 4 <= head.size();
        if (!magics_) return;
        for (std::size_t k = 0; k < 4; ++k) whole_[k] = static_cast<std::uint8_t>(head[at + kKey.size() + k]);
    }

    std::uint32_t group(std::uint16_t bits, SoupBuilder& builder) const {
        const bool high = bits & 0x8000;
        if (magics_ == high) return magics_ ? builder.colour_group(whole_) : kNone;
        const auto channel = [&](int shift) {
            return static_cast<std::uint8_t>(((bits >> shift & 31) * 255 + 15) / 31);
        };
        return builder.colour_group({channel(magics_ ? 0 : 10), channel(5), channel(magics_ ? 10 : 0), 255});
    }

  private:
    bool magics_ = false;
    std::array<std::uint8_t, 4> whole_{};
};

PolygonSoup read_binary(const std::vector<char>& bytes, const std::string& file) {
    if (bytes.size() < kHead) throw Error(file, Message("is too short to be an STL file ({} bytes)", bytes.size()));
    const std::size_t promised = count_in_head(bytes);
    const std::size_t held = (bytes.size() - kHead) / kTriangle;
    SoupBuilder builder(file, "triangle");
    std::size_t n = promised;
    if (promised == 0 && held > 0 && (bytes.size() - kHead) % kTriangle == 0) {
        builder.soup.warnings.push_back(Message("the head says 0 triangles, the file holds {}", held));
        n = held;
    } else if (promised > held) {
        throw Error(
            file,
            Message("the head promises {} triangles, but the file holds only {}; it is cut off or not an STL file",
                    promised, held));
    } else if (kHead + promised * kTriangle != bytes.size()) {
        builder.soup.warnings.push_back(
            Message("{} bytes behind the last triangle are not read", bytes.size() - kHead - promised * kTriangle));
    }
    builder.soup.points.reserve(3 * n);
    builder.soup.corners.reserve(3 * n);
    builder.soup.polygon_start.reserve(n + 1);
    builder.soup.polygon_groups.reserve(n);
    const FacetColours colours(bytes);
    for (std::size_t t = 0; t < n; ++t) {
        float values[12];
        std::uint16_t attribute;
        std::memcpy(values, bytes.data() + kHead + kTriangle * t, sizeof values);
        std::memcpy(&attribute, bytes.data() + kHead + kTriangle * t + sizeof values, sizeof attribute);
        const auto first = static_cast<std::uint32_t>(builder.soup.points.size());
        for (int k = 1; k <= 3; ++k)
            builder.add_point({values[3 * k], values[3 * k + 1], values[3 * k + 2]}, static_cast<long>(t + 1));
        const std::uint32_t corners[3] = {first, first + 1, first + 2};
        builder.add_polygon(corners, {}, colours.group(attribute, builder), static_cast<long>(t + 1));
    }
    return builder.finish();
}

PolygonSoup read_text(const std::vector<char>& bytes, const std::string& file) {
    TextCursor text(bytes, file, {.comment = 0});
    SoupBuilder builder(file, "line");
    std::vector<std::uint32_t> corners;
    std::uint32_t group = kNone;
    bool in_loop = false, in_solid = false;
    std::size_t solids = 0;
    for (; text.skip_to_token(); text.next_line()) {
        const std::string_view key = text.word();
        const long line = text.line();
        if (same_word(key, "vertex")) {
            if (!in_loop) text.fail("a vertex stands outside of a loop");
            const double x = text.number("a coordinate");
            const double y = text.number("a coordinate");
            const double z = text.number("a coordinate");
            corners.push_back(static_cast<std::uint32_t>(builder.soup.points.size()));
            builder.add_point({x, y, z}, line);
        } else if (same_word(key, "outer")) {
            in_loop = true;
            corners.clear();
        } else if (same_word(key, "endloop")) {
            if (!in_loop) text.fail("endloop without 'outer loop'");
            in_loop = false;
            builder.add_polygon(corners, {}, group, line);
        } else if (same_word(key, "solid")) {
            const std::string name(text.rest());
            in_solid = true;
            ++solids;
            group = builder.group(name.empty() ? "solid " + std::to_string(solids) : name);
        } else if (same_word(key, "endsolid")) {
            in_solid = false;
        } else if (!same_word(key, "facet") && !same_word(key, "endfacet")) {
            text.fail(Message("{} is not an STL keyword", in_quotes(key)));
        }
    }
    if (in_loop || in_solid) text.fail("the file ends inside a solid; it is cut off (no endsolid)");
    PolygonSoup soup = builder.finish();
    if (solids < 2) {
        soup.polygon_groups.clear();
        soup.group_names.clear();
    }
    return soup;
}

}  // namespace

PolygonSoup read_stl(const std::vector<char>& bytes, const std::filesystem::path& path) {
    const std::string file = path.string();
    const bool exact_binary = bytes.size() >= kHead && bytes.size() == kHead + kTriangle * count_in_head(bytes);
    if (!exact_binary && looks_like_text(bytes, file)) return read_text(bytes, file);
    return read_binary(bytes, file);
}

}  // namespace tuft::mesh
