#include "io/model/draco_mesh.h"

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <array>
#include <cstring>

#include "core/error.h"

namespace tuft::io {
namespace {

constexpr std::size_t kMostFacesPerByte = 32;  // two or three bytes a face are usual

/// The head of a stream, whose counts Draco allocates by.
class Head {
  public:
    Head(std::span<const unsigned char> bytes, const std::string& file) : rest_(bytes), file_(file) {}

    void check() {
        const std::size_t size = rest_.size();
        if (size < 11 || std::memcmp(rest_.data(), "DRACO", 5) != 0) fail();
        const unsigned major = rest_[5], minor = rest_[6], kind = rest_[7], method = rest_[8];
        const unsigned flags = rest_[9] | static_cast<unsigned>(rest_[10]) << 8;
        if (major != 2 || minor != 2)
            throw Error(file_, Message("its Draco meshes have bitstream {}.{}, and glTF has 2.2; export it anew", major,
                                       minor));
        if (kind != 1 || method > 1) fail();
        if (flags & 0x8000u) throw Error(file_, "its Draco meshes have metadata; export it without");
        rest_ = rest_.subspan(11);
        std::uint64_t faces = 0, points = 0;
        if (method == 1) {  // edgebreaker: the kind of traversal, vertices, faces
            rest_ = rest_.subspan(1);
            points = number();
            faces = number();
        } else {
            faces = number();
            points = number();
        }
        const std::uint64_t most = kMostFacesPerByte * size;
        if (faces > most || points > 3 * most) throw Error(file_, "a Draco mesh announces more than its bytes can say");
    }

  private:
    [[noreturn]] void fail() const { throw Error(file_, "a Draco mesh is damaged"); }
    /// Seven bits a byte, lowest first.
    std::uint64_t number() {
        std::uint64_t value = 0;
        for (int shift = 0; shift < 35; shift += 7) {
            if (rest_.empty()) fail();
            const unsigned char byte = rest_.front();
            rest_ = rest_.subspan(1);
            value |= static_cast<std::uint64_t>(byte & 0x7fu) << shift;
            if (!(byte & 0x80u)) return value;
        }
        fail();
    }

    std::span<const unsigned char> rest_;
    const std::string& file_;
};

template <class T>
bool convert(const draco::PointAttribute& attribute, std::size_t n_points, int n, std::vector<unsigned char>& out) {
    std::array<T, 16> row{};
    const std::size_t size = static_cast<std::size_t>(n) * sizeof(T);
    out.resize(n_points * size);
    for (std::size_t i = 0; i < n_points; ++i) {
        const auto at = attribute.mapped_index(draco::PointIndex(static_cast<std::uint32_t>(i)));
        if (at.value() >= attribute.size() || !attribute.ConvertValue<T>(at, static_cast<std::int8_t>(n), row.data()))
            return false;
        std::memcpy(out.data() + i * size, row.data(), size);
    }
    return true;
}

}  // namespace

DracoMesh::DracoMesh(std::span<const unsigned char> bytes, const std::string& file) : file_(file) {
    Head(bytes, file).check();
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok()) throw Error(file, "a Draco mesh is damaged");
    mesh_ = std::move(result).value();
    if (!mesh_) throw Error(file, "a Draco mesh is damaged");
}

DracoMesh::~DracoMesh() = default;

std::size_t DracoMesh::n_points() const {
    return mesh_->num_points();
}

std::vector<std::uint32_t> DracoMesh::indices() const {
    std::vector<std::uint32_t> out;
    out.reserve(3 * static_cast<std::size_t>(mesh_->num_faces()));
    for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f)
        for (const draco::PointIndex& p : mesh_->face(f)) {
            if (p.value() >= mesh_->num_points()) throw Error(file_, "a Draco mesh is damaged");
            out.push_back(p.value());
        }
    return out;
}

std::vector<unsigned char> DracoMesh::rows(unsigned id, int component_type, int n_components) const {
    const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(id);
    if (!attribute || attribute->num_components() != n_components)
        throw Error(file_, "a Draco mesh lacks an attribute that its primitive names");
    std::vector<unsigned char> out;
    const std::size_t n = n_points();
    bool good = false;
    switch (component_type) {
        case 5120:
            good = convert<std::int8_t>(*attribute, n, n_components, out);
            break;
        case 5121:
            good = convert<std::uint8_t>(*attribute, n, n_components, out);
            break;
        case 5122:
            good = convert<std::int16_t>(*attribute, n, n_components, out);
            break;
        case 5123:
            good = convert<std::uint16_t>(*attribute, n, n_components, out);
            break;
        case 5125:
            good = convert<std::uint32_t>(*attribute, n, n_components, out);
            break;
        case 5126:
            good = convert<float>(*attribute, n, n_components, out);
            break;
        default:
            break;
    }
    if (!good) throw Error(file_, "a Draco mesh is damaged");
    return out;
}

}  // namespace tuft::io
