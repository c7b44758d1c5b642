/// \file
/// `io_draco_sample METHOD BITS`: encodes a mesh by Draco, for gltf_compression_test.cpp. Standard input: numbers of
/// points and of indices (u32), points (3 floats each), UVs (2 floats each), indices (u32). BITS 0: positions are not
/// rounded.
#include <draco/compression/encode.h>
#include <draco/mesh/mesh.h>

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <vector>

namespace {

template <class T>
std::vector<T> read(std::size_t n) {
    std::vector<T> out(n);
    if (std::fread(out.data(), sizeof(T), n, stdin) != n) std::exit(1);
    return out;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    const std::vector<std::uint32_t> counts = read<std::uint32_t>(2);
    const std::vector<float> points = read<float>(3 * std::size_t{counts[0]}),
                             uvs = read<float>(2 * std::size_t{counts[0]});
    const std::vector<std::uint32_t> indices = read<std::uint32_t>(counts[1]);
    draco::Mesh mesh;
    mesh.set_num_points(counts[0]);
    const auto add = [&](draco::GeometryAttribute::Type type, const float* values, std::int8_t components) {
        draco::GeometryAttribute attribute;
        attribute.Init(type, nullptr, components, draco::DT_FLOAT32, false, components * 4, 0);
        const int id = mesh.AddAttribute(attribute, true, counts[0]);
        for (std::uint32_t i = 0; i < counts[0]; ++i)
            mesh.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i),
                                                  values + i * std::uint32_t(components));
    };
    add(draco::GeometryAttribute::POSITION, points.data(), 3);
    add(draco::GeometryAttribute::TEX_COORD, uvs.data(), 2);
    for (std::size_t f = 0; f + 2 < indices.size(); f += 3)
        mesh.AddFace(
            {draco::PointIndex(indices[f]), draco::PointIndex(indices[f + 1]), draco::PointIndex(indices[f + 2])});
    draco::Encoder encoder;
    encoder.SetEncodingMethod(std::atoi(argv[1]));
    if (const int bits = std::atoi(argv[2])) encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(mesh, &buffer).ok()) return 1;
    return std::fwrite(buffer.data(), 1, buffer.size(), stdout) == buffer.size() ? 0 : 1;
}
