#include "io/gltf/draco_mesh.h"

#include <cstring>

#include "core/error.h"
#include "core/files/loaded_module.h"

namespace tuft::io {
namespace {

constexpr std::size_t kMostFacesPerByte = 32;  // two or three bytes a face are usual

/// The head of a stream, whose counts Draco allocates by.
class Head {
  public:
    Head(std::span<const unsigned char> bytes, const std::string& file) : rest_(bytes), file_(file) {}

    void check() {
        const std::size_t size = rest_.size();
        if (size < 12 || std::memcmp(rest_.data(), "DRACO", 5) != 0) fail();
        const unsigned major = rest_[5], minor = rest_[6], kind = rest_[7], method = rest_[8];
        const unsigned flags = rest_[9] | static_cast<unsigned>(rest_[10]) << 8;
        if (major != 2 || minor != 2)
            throw Error(file_, Message("its Draco meshes have bitstream {}.{}, and glTF has 2.2; export it anew", major,
                                       minor));
        if (kind != 1 || method > 1) fail();
        if (flags & 0x8000u) throw Error(file_, "its Draco meshes have metadata; export it without");
        // Edgebreaker: the kind of traversal, vertices, faces. Sequential: faces, points.
        rest_ = rest_.subspan(method == 1 ? 12 : 11);
        const std::uint64_t first = number(), second = number(), most = kMostFacesPerByte * size;
        if (first > 3 * most || second > 3 * most || (method == 1 ? second : first) > most)
            throw Error(file_, "a Draco mesh announces more than its bytes can say");
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

DracoDecoder load_decoder() {
    const ModuleSymbol found = find_in_module("libtuft_draco.so", TUFT_DRACO_BUILT, kDracoSymbol);
    if (found.symbol) return reinterpret_cast<DracoDecoder>(found.symbol);
    throw Error(Message("the Draco library cannot be loaded: {} (looked for {})", found.fault, found.tried));
}

}  // namespace

std::unique_ptr<DracoMesh> decode_draco(std::span<const unsigned char> bytes, const std::string& file) {
    Head(bytes, file).check();
    static const DracoDecoder decode = load_decoder();
    std::unique_ptr<DracoMesh> mesh(decode(bytes.data(), bytes.size()));
    if (!mesh) throw Error(file, "a Draco mesh is damaged");
    return mesh;
}

}  // namespace tuft::io
