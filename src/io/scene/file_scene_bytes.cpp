#include <array>
#include <cmath>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "core/error.h"
#include "io/scene/file_scene.h"

namespace tuft::io {
namespace {

constexpr std::string_view kMagic = "tuft scene 3\n";

class Writer {
  public:
    std::vector<char> bytes{kMagic.begin(), kMagic.end()};

    template <class T>
    void values(const T* first, std::size_t n) {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::uint64_t count = n;
        raw(&count, sizeof count);
        raw(first, n * sizeof(T));
    }
    template <class C>
    void list(const C& all) {
        values(all.data(), all.size());
    }
    template <class T>
    void value(const T& v) {
        values(&v, 1);
    }

  private:
    void raw(const void* first, std::size_t size) {
        const char* at = static_cast<const char*>(first);
        bytes.insert(bytes.end(), at, at + size);
    }
};

class Reader {
  public:
    Reader(std::span<const char> bytes, const std::string& file) : rest_(bytes), file_(file) {}

    [[noreturn]] void fail() const { throw Error(file_, "its importer handed over a damaged model"); }
    void magic() {
        if (rest_.size() < kMagic.size() || std::memcmp(rest_.data(), kMagic.data(), kMagic.size()) != 0) fail();
        rest_ = rest_.subspan(kMagic.size());
    }
    template <class C>
    void list(C& out) {
        using T = typename C::value_type;
        const std::size_t n = count(sizeof(T));
        out.resize(n);
        if (n > 0) std::memcpy(out.data(), rest_.data(), n * sizeof(T));
        rest_ = rest_.subspan(n * sizeof(T));
    }
    template <class T>
    void value(T& out) {
        if (count(sizeof(T)) != 1) fail();
        std::memcpy(&out, rest_.data(), sizeof(T));
        rest_ = rest_.subspan(sizeof(T));
    }
    /// Of things that take at least `each` bytes; checked before memory is taken.
    std::size_t count(std::size_t each) {
        std::uint64_t n = 0;
        if (rest_.size() < sizeof n) fail();
        std::memcpy(&n, rest_.data(), sizeof n);
        rest_ = rest_.subspan(sizeof n);
        if (n > rest_.size() / each) fail();
        return n;
    }

  private:
    std::span<const char> rest_;
    const std::string& file_;
};

void check(const FileScene& s, const Reader& reader) {
    const auto all_below = [](const std::vector<std::uint32_t>& all, std::size_t n) {
        for (const std::uint32_t i : all)
            if (i >= n) return false;
        return true;
    };
    std::size_t corners = 0;
    for (const std::uint32_t n : s.counts) corners += n;
    if (corners != s.corners.size() || s.polygon_parts.size() != s.counts.size() ||
        (!s.uvs.empty() && s.uvs.size() != corners) || (!s.normals.empty() && s.normals.size() != corners) ||
        (!s.colours.empty() && s.colours.size() != s.points.size()) || !all_below(s.corners, s.points.size()) ||
        !all_below(s.polygon_parts, s.parts.size()))
        reader.fail();
    for (const FilePart& part : s.parts)
        if (part.material != kNone && part.material >= s.materials.size()) reader.fail();
}

}  // namespace

void FileScene::add_polygon(std::uint32_t part, std::span<const std::uint32_t> polygon,
                            std::span<const Vec2f> polygon_uvs) {
    corners.insert(corners.end(), polygon.begin(), polygon.end());
    counts.push_back(static_cast<std::uint32_t>(polygon.size()));
    polygon_parts.push_back(part);
    if (polygon_uvs.empty() && uvs.empty()) return;
    uvs.resize(corners.size() - polygon.size(), Vec2f(NAN));
    uvs.insert(uvs.end(), polygon_uvs.begin(), polygon_uvs.end());
    uvs.resize(corners.size(), Vec2f(NAN));
}

std::vector<char> pack_scene(const FileScene& s) {
    Writer out;
    out.list(s.points);
    out.list(s.colours);
    out.list(s.corners);
    out.list(s.counts);
    out.list(s.polygon_parts);
    out.list(s.uvs);
    out.list(s.normals);
    out.value(std::uint64_t{s.parts.size()});
    for (const FilePart& part : s.parts) {
        out.list(part.object);
        out.value(part.material);
    }
    out.value(std::uint64_t{s.materials.size()});
    for (const FileMaterial& m : s.materials) {
        out.list(m.name);
        out.value(std::array{m.colour.r, m.colour.g, m.colour.b, m.alpha, m.roughness, m.metallic});
        out.list(m.picture);
        out.list(m.picture_bytes);
    }
    out.value(std::uint64_t{s.warnings.size()});
    for (const Message& warning : s.warnings) out.list(warning.text());
    out.value(s.stated_unit);
    return std::move(out.bytes);
}

FileScene unpack_scene(std::span<const char> bytes, const std::string& file) {
    Reader in(bytes, file);
    FileScene s;
    in.magic();
    in.list(s.points);
    in.list(s.colours);
    in.list(s.corners);
    in.list(s.counts);
    in.list(s.polygon_parts);
    in.list(s.uvs);
    in.list(s.normals);
    std::uint64_t n = 0;
    in.value(n);
    for (std::uint64_t i = 0; i < n; ++i) {  // each takes bytes, so a false count ends at the last one
        FilePart& part = s.parts.emplace_back();
        in.list(part.object);
        in.value(part.material);
    }
    in.value(n);
    for (std::uint64_t i = 0; i < n; ++i) {
        FileMaterial& m = s.materials.emplace_back();
        std::array<float, 6> numbers{};
        in.list(m.name);
        in.value(numbers);
        m.colour = {numbers[0], numbers[1], numbers[2]};
        m.alpha = numbers[3];
        m.roughness = numbers[4];
        m.metallic = numbers[5];
        in.list(m.picture);
        in.list(m.picture_bytes);
    }
    in.value(n);
    for (std::uint64_t i = 0; i < n; ++i) {
        std::string warning;
        in.list(warning);
        s.warnings.emplace_back(std::move(warning));
    }
    in.value(s.stated_unit);
    if (!(s.stated_unit > 0 && std::isfinite(s.stated_unit))) in.fail();
    check(s, in);
    return s;
}

}  // namespace tuft::io
