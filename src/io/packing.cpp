#include "io/packing.h"

#include <zstd.h>

#include <cassert>
#include <cstdint>
#include <cstring>

#include "core/error.h"

namespace tuft::io {
namespace {

template <class T>
void spread(const void* data, std::size_t count, std::size_t lag, unsigned char* planes) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    const auto load = [&](std::size_t i) {
        T v;
        std::memcpy(&v, bytes + i * sizeof(T), sizeof v);
        return v;
    };
    for (std::size_t i = 0; i < count; ++i) {
        const T before = i >= lag ? load(i - lag) : T{0};
        const T difference = static_cast<T>(load(i) - before);
        for (std::size_t b = 0; b < sizeof(T); ++b)
            planes[b * count + i] = static_cast<unsigned char>(difference >> (8 * b));
    }
}

template <class T>
void gather(const unsigned char* planes, std::size_t count, std::size_t lag, void* out) {
    auto* bytes = static_cast<unsigned char*>(out);
    for (std::size_t i = 0; i < count; ++i) {
        T v = 0;
        for (std::size_t b = 0; b < sizeof(T); ++b)
            v = static_cast<T>(v |
                               static_cast<T>(static_cast<T>(planes[b * count + i]) << (8 * b)));
        if (i >= lag) {
            T before;
            std::memcpy(&before, bytes + (i - lag) * sizeof(T), sizeof before);
            v = static_cast<T>(v + before);
        }
        std::memcpy(bytes + i * sizeof(T), &v, sizeof v);
    }
}

}  // namespace

std::vector<char> pack(const void* data, std::size_t count, const Packing& packing) {
    assert(packing.element == 1 || packing.element == 4 || packing.element == 8);
    std::vector<unsigned char> planes(count * packing.element);
    if (packing.element == 1) spread<std::uint8_t>(data, count, packing.lag, planes.data());
    if (packing.element == 4) spread<std::uint32_t>(data, count, packing.lag, planes.data());
    if (packing.element == 8) spread<std::uint64_t>(data, count, packing.lag, planes.data());
    std::vector<char> blob(ZSTD_compressBound(planes.size()));
    const std::size_t size =
        ZSTD_compress(blob.data(), blob.size(), planes.data(), planes.size(), packing.level);
    if (ZSTD_isError(size))
        throw Error(std::string("compression failed: ") + ZSTD_getErrorName(size));
    blob.resize(size);
    return blob;
}

void check_packed(const void* blob, std::size_t blob_size, std::size_t bytes,
                  const std::string& what) {
    if (ZSTD_getFrameContentSize(blob, blob_size) != bytes) throw Error(what + " is damaged");
}

void unpack(const void* blob, std::size_t blob_size, void* out, std::size_t count,
            const Packing& packing, const std::string& what) {
    const std::size_t expected = count * packing.element;
    check_packed(blob, blob_size, expected, what);
    std::vector<unsigned char> planes(expected);
    const std::size_t size = ZSTD_decompress(planes.data(), planes.size(), blob, blob_size);
    if (ZSTD_isError(size) || size != expected) throw Error(what + " is damaged");
    if (packing.element == 1) gather<std::uint8_t>(planes.data(), count, packing.lag, out);
    if (packing.element == 4) gather<std::uint32_t>(planes.data(), count, packing.lag, out);
    if (packing.element == 8) gather<std::uint64_t>(planes.data(), count, packing.lag, out);
}

}  // namespace tuft::io
