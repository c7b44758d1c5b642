// The module `tuft_draco`: the only code that sees Draco.
#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

#include <array>
#include <cstring>
#include <utility>

#include "io/gltf/draco_mesh.h"

namespace tuft::io {
namespace {

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

class Decoded : public DracoMesh {
  public:
    explicit Decoded(std::unique_ptr<draco::Mesh> mesh) : mesh_(std::move(mesh)) {}

    std::size_t n_points() const override { return mesh_->num_points(); }

    bool indices(std::vector<std::uint32_t>& out) const override {
        out.reserve(3 * static_cast<std::size_t>(mesh_->num_faces()));
        for (draco::FaceIndex f(0); f < mesh_->num_faces(); ++f)
            for (const draco::PointIndex& p : mesh_->face(f)) {
                if (p.value() >= mesh_->num_points()) return false;
                out.push_back(p.value());
            }
        return true;
    }

    bool rows(unsigned id, int component_type, int n, std::vector<unsigned char>& out) const override {
        const draco::PointAttribute* attribute = mesh_->GetAttributeByUniqueId(id);
        if (!attribute || attribute->num_components() != n) return false;
        switch (component_type) {
            case 5120:
                return convert<std::int8_t>(*attribute, n_points(), n, out);
            case 5121:
                return convert<std::uint8_t>(*attribute, n_points(), n, out);
            case 5122:
                return convert<std::int16_t>(*attribute, n_points(), n, out);
            case 5123:
                return convert<std::uint16_t>(*attribute, n_points(), n, out);
            case 5125:
                return convert<std::uint32_t>(*attribute, n_points(), n, out);
            case 5126:
                return convert<float>(*attribute, n_points(), n, out);
            default:
                return false;
        }
    }

  private:
    std::unique_ptr<draco::Mesh> mesh_;
};

}  // namespace
}  // namespace tuft::io

extern "C" __attribute__((visibility("default"))) tuft::io::DracoMesh* tuft_decode_draco(const unsigned char* bytes,
                                                                                         std::size_t size) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes), size);
    draco::Decoder decoder;
    auto result = decoder.DecodeMeshFromBuffer(&buffer);
    if (!result.ok()) return nullptr;
    std::unique_ptr<draco::Mesh> mesh = std::move(result).value();
    return mesh ? new tuft::io::Decoded(std::move(mesh)) : nullptr;
}
