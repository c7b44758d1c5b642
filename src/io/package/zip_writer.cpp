#include "io/package/zip_writer.h"

#include <zlib.h>

#include "core/error.h"

// APPNOTE.TXT - .ZIP File Format Specification 6.3.10, PKWARE.
namespace tuft::io {
namespace {

constexpr std::uint32_t kEnd = 0x06054b50, kCentral = 0x02014b50, kLocal = 0x04034b50;
constexpr std::uint32_t kDate = (0u << 9 | 1u << 5 | 1u) << 16;  // 1 January 1980, 0:00
constexpr std::size_t kMostBytes = 0xfffffffe, kMostEntries = 65'534;

void put(std::vector<std::uint8_t>& out, std::size_t value, int n_bytes) {
    for (int k = 0; k < n_bytes; ++k) out.push_back(static_cast<std::uint8_t>(value >> (8 * k)));
}

std::vector<std::uint8_t> deflate_raw(std::span<const std::uint8_t> bytes) {
    z_stream stream{};
    if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, -MAX_WBITS, 8, Z_DEFAULT_STRATEGY) != Z_OK)
        throw Error("the archive cannot be packed");
    std::vector<std::uint8_t> out(deflateBound(&stream, static_cast<uLong>(bytes.size())));
    stream.next_in = const_cast<Bytef*>(bytes.data());
    stream.avail_in = static_cast<uInt>(bytes.size());
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(out.size());
    const int result = deflate(&stream, Z_FINISH);
    out.resize(stream.total_out);
    deflateEnd(&stream);
    if (result != Z_STREAM_END) throw Error("the archive cannot be packed");
    return out;
}

}  // namespace

void ZipWriter::add(const std::string& name, std::span<const std::uint8_t> bytes, Method method) {
    if (bytes.size() > kMostBytes - bytes_.size() || count_ >= kMostEntries)
        throw Error("the archive would be larger than 4 GiB");
    const bool stored = method == Method::stored || bytes.empty();
    const std::vector<std::uint8_t> packed =
        stored ? std::vector<std::uint8_t>(bytes.begin(), bytes.end()) : deflate_raw(bytes);
    const std::size_t at = bytes_.size();
    const auto fields = [&](std::vector<std::uint8_t>& out) {
        put(out, stored ? 10 : 20, 2);  // version needed
        put(out, 0x0800, 2);            // names are UTF-8
        put(out, stored ? 0 : 8, 2);
        put(out, kDate, 4);
        put(out, crc32(0, bytes.data(), static_cast<uInt>(bytes.size())), 4);
        put(out, packed.size(), 4);
        put(out, bytes.size(), 4);
        put(out, name.size(), 2);
        put(out, 0, 2);  // extra
    };
    put(bytes_, kLocal, 4);
    fields(bytes_);
    bytes_.insert(bytes_.end(), name.begin(), name.end());
    bytes_.insert(bytes_.end(), packed.begin(), packed.end());
    put(directory_, kCentral, 4);
    put(directory_, 20, 2);  // made by
    fields(directory_);
    put(directory_, 0, 2);  // comment
    put(directory_, 0, 2);  // disk
    put(directory_, 0, 2);  // internal attributes
    put(directory_, 0, 4);  // external attributes
    put(directory_, at, 4);
    directory_.insert(directory_.end(), name.begin(), name.end());
    ++count_;
}

void ZipWriter::add(const std::string& name, const std::string& text, Method method) {
    add(name, std::span(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), method);
}

std::vector<std::uint8_t> ZipWriter::finish() {
    const std::size_t at = bytes_.size();
    if (directory_.size() > kMostBytes - at) throw Error("the archive would be larger than 4 GiB");
    bytes_.insert(bytes_.end(), directory_.begin(), directory_.end());
    put(bytes_, kEnd, 4);
    put(bytes_, 0, 4);  // disks
    put(bytes_, count_, 2);
    put(bytes_, count_, 2);
    put(bytes_, directory_.size(), 4);
    put(bytes_, at, 4);
    put(bytes_, 0, 2);  // comment
    return std::move(bytes_);
}

}  // namespace tuft::io
