#include "io/project/packing.h"

#include <zstd.h>

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <cstring>
#include <memory>
#include <string>

#include "core/error.h"
#include "core/system/interrupt.h"

namespace tuft::io {
namespace {

/// Bytes `byte` of the differences of numbers [begin, end).
template <class T>
void spread(const void* data, std::size_t begin, std::size_t end, std::size_t lag, std::size_t byte,
            unsigned char* out) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    const auto load = [&](std::size_t i) {
        T v;
        std::memcpy(&v, bytes + i * sizeof(T), sizeof v);
        return v;
    };
    for (std::size_t i = begin; i < end; ++i) {
        const T before = i >= lag ? load(i - lag) : T{0};
        const T difference = static_cast<T>(load(i) - before);
        *out++ = static_cast<unsigned char>(difference >> (8 * byte));
    }
}

void check(std::size_t result) {
    if (ZSTD_isError(result)) throw Error(Message("compression failed: {}", ZSTD_getErrorName(result)));
}

/// Compresses what it is given piece by piece.
class Compressor {
  public:
    Compressor(std::size_t bytes, int level)
        : context_(ZSTD_createCCtx(), ZSTD_freeCCtx),
          buffer_(std::min(ZSTD_CStreamOutSize(), ZSTD_compressBound(bytes))) {
        if (!context_) throw Error("compression failed: out of memory");
        check(ZSTD_CCtx_setParameter(context_.get(), ZSTD_c_compressionLevel, level));
        check(ZSTD_CCtx_setPledgedSrcSize(context_.get(), bytes));
        blob_.reserve(ZSTD_compressBound(bytes));  // taken from the machine as it is filled
    }

    void add(const unsigned char* data, std::size_t size, ZSTD_EndDirective mode) {
        ZSTD_inBuffer in{data, size, 0};
        for (std::size_t left = 1; mode == ZSTD_e_end ? left > 0 : in.pos < in.size;) {
            ZSTD_outBuffer out{buffer_.data(), buffer_.size(), 0};
            left = ZSTD_compressStream2(context_.get(), &out, &in, mode);
            check(left);
            blob_.insert(blob_.end(), buffer_.data(), buffer_.data() + out.pos);
        }
    }

    std::vector<char> finish() {
        add(nullptr, 0, ZSTD_e_end);
        return std::move(blob_);
    }

  private:
    std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> context_;
    std::vector<char> buffer_, blob_;
};

template <class T>
void merge_planes(const unsigned char* planes, std::size_t count, std::size_t lag, void* out) {
    auto* bytes = static_cast<unsigned char*>(out);
    for (std::size_t i = 0; i < count; ++i) {
        T v = 0;
        for (std::size_t b = 0; b < sizeof(T); ++b)
            v = static_cast<T>(v | static_cast<T>(static_cast<T>(planes[b * count + i]) << (8 * b)));
        if (i >= lag) {
            T before;
            std::memcpy(&before, bytes + (i - lag) * sizeof(T), sizeof before);
            v = static_cast<T>(v + before);
        }
        std::memcpy(bytes + i * sizeof(T), &v, sizeof v);
    }
}

}  // namespace

// Piece by piece, so that a model of a million triangles is not held three times while it is
// written.
std::vector<char> pack(const void* data, std::size_t count, const Packing& packing) {
    assert(packing.element == 1 || packing.element == 4 || packing.element == 8);
    constexpr std::size_t kPiece = std::size_t{1} << 17;
    Compressor compressor(count * packing.element, packing.level);
    std::vector<unsigned char> piece(std::min(count, kPiece));
    for (std::size_t byte = 0; byte < packing.element; ++byte)
        for (std::size_t begin = 0; begin < count; begin += kPiece) {
            check_interrupt();
            const std::size_t end = std::min(count, begin + kPiece);
            if (packing.element == 1) spread<std::uint8_t>(data, begin, end, packing.lag, byte, piece.data());
            if (packing.element == 4) spread<std::uint32_t>(data, begin, end, packing.lag, byte, piece.data());
            if (packing.element == 8) spread<std::uint64_t>(data, begin, end, packing.lag, byte, piece.data());
            compressor.add(piece.data(), end - begin, ZSTD_e_continue);
        }
    return compressor.finish();
}

std::size_t packed_bytes(const void* blob, std::size_t blob_size) {
    const auto bytes = ZSTD_getFrameContentSize(blob, blob_size);
    return bytes == ZSTD_CONTENTSIZE_UNKNOWN || bytes == ZSTD_CONTENTSIZE_ERROR ? 0 : bytes;
}

void check_packed(const void* blob, std::size_t blob_size, std::size_t bytes, const Message& what) {
    if (ZSTD_getFrameContentSize(blob, blob_size) != bytes) throw Error(Message("{} is damaged", what));
}

void unpack(const void* blob, std::size_t blob_size, void* out, std::size_t count, const Packing& packing,
            const Message& what) {
    const std::size_t expected = count * packing.element;
    check_packed(blob, blob_size, expected, what);
    std::vector<unsigned char> planes(expected);
    const std::size_t size = ZSTD_decompress(planes.data(), planes.size(), blob, blob_size);
    if (ZSTD_isError(size) || size != expected) throw Error(Message("{} is damaged", what));
    if (packing.element == 1) merge_planes<std::uint8_t>(planes.data(), count, packing.lag, out);
    if (packing.element == 4) merge_planes<std::uint32_t>(planes.data(), count, packing.lag, out);
    if (packing.element == 8) merge_planes<std::uint64_t>(planes.data(), count, packing.lag, out);
}

}  // namespace tuft::io
