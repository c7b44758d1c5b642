#include "io/package/zip.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <string_view>

#include "core/error.h"
#include "core/text/text.h"

// APPNOTE.TXT - .ZIP File Format Specification 6.3.10, PKWARE.
namespace tuft::io {
namespace {

constexpr std::size_t kEndSize = 22, kCentralSize = 46, kLocalSize = 30, kLocatorSize = 20, kLongestComment = 65535;
constexpr std::uint32_t kEnd = 0x06054b50, kCentral = 0x02014b50, kLocal = 0x04034b50;
// ZIP64: numbers that are all ones in the old fields stand in records of their own.
constexpr std::uint32_t kLocator = 0x07064b50, kEnd64 = 0x06064b50, kAllOnes = 0xffffffff;
constexpr std::size_t kOfZip64 = 1;  // kind of an entry's extra field

}  // namespace

void Zip::fail(const Message& what) const {
    throw Error(file_, what);
}

std::size_t Zip::number(std::size_t at, int n_bytes) const {
    if (at > bytes_.size() || bytes_.size() - at < static_cast<std::size_t>(n_bytes)) fail("the archive is cut short");
    std::size_t value = 0;
    for (int k = n_bytes - 1; k >= 0; --k)
        value = value << 8 | static_cast<unsigned char>(bytes_[at + static_cast<std::size_t>(k)]);
    return value;
}

void Zip::read_zip64(std::size_t at, std::size_t size, Entry& entry) const {
    for (const std::size_t end = at + size; at + 4 <= end;) {
        const std::size_t kind = number(at, 2), length = number(at + 2, 2);
        at += 4;
        if (kind != kOfZip64) {
            at += length;
            continue;
        }
        const std::size_t last = std::min(end, at + length);
        for (std::size_t* value : {&entry.size, &entry.packed, &entry.offset}) {
            if (*value != kAllOnes) continue;
            if (at + 8 > last) fail("the archive's directory is damaged");
            *value = number(at, 8);
            at += 8;
        }
        return;
    }
    fail("the archive's directory is damaged");
}

Zip::Zip(std::span<const char> bytes, std::string file)
    : bytes_(bytes), file_(std::move(file)), budget_((std::size_t{64} << 20) + 64 * bytes.size()) {
    if (bytes.size() < kEndSize || number(0, 2) != 0x4b50) fail("is no ZIP archive");
    std::size_t end = bytes.size() - kEndSize;
    const std::size_t least = end > kLongestComment ? end - kLongestComment : 0;
    while (number(end, 4) != kEnd) {
        if (end == least) fail("the archive is cut short: it has no directory");
        --end;
    }
    std::size_t n = number(end + 10, 2), at = number(end + 16, 4);
    if (at == kAllOnes || n == 0xffff) {
        if (end < kLocatorSize || number(end - kLocatorSize, 4) != kLocator) fail("the archive's directory is damaged");
        const std::size_t end64 = number(end - kLocatorSize + 8, 8);
        if (number(end64, 4) != kEnd64) fail("the archive's directory is damaged");
        n = number(end64 + 32, 8);
        at = number(end64 + 48, 8);
    }
    for (std::size_t i = 0; i < n; ++i) {
        if (number(at, 4) != kCentral) fail("the archive's directory is damaged");
        const std::size_t name = number(at + 28, 2), extra = number(at + 30, 2), comment = number(at + 32, 2);
        if (at + kCentralSize + name > bytes.size()) fail("the archive is cut short");
        Entry entry{.offset = number(at + 42, 4),
                    .packed = number(at + 20, 4),
                    .size = number(at + 24, 4),
                    .method = static_cast<int>(number(at + 10, 2))};
        if (entry.offset == kAllOnes || entry.packed == kAllOnes || entry.size == kAllOnes)
            read_zip64(at + kCentralSize + name, extra, entry);
        const bool encrypted = number(at + 8, 2) & 1;
        if (encrypted) fail("the archive is encrypted");
        entries_.emplace(std::string(bytes.data() + at + kCentralSize, name), entry);
        at += kCentralSize + name + extra + comment;
    }
}

std::vector<char> Zip::read(const std::string& name) {
    const auto it = entries_.find(name);
    if (it == entries_.end()) fail(Message("the archive has no '{}'", excerpt(name)));
    const Entry& entry = it->second;
    const std::string what = "'" + excerpt(name) + "' in the archive ";
    if (number(entry.offset, 4) != kLocal) fail(Message("{}is damaged", what));
    const std::size_t begin = entry.offset + kLocalSize + number(entry.offset + 26, 2) + number(entry.offset + 28, 2);
    if (begin > bytes_.size() || bytes_.size() - begin < entry.packed) fail(Message("{}is cut short", what));
    if (entry.size > budget_) fail(Message("{}is larger than its archive allows", what));
    if (std::max(entry.size, entry.packed) >= kAllOnes) fail(Message("{}is larger than 4 GiB", what));
    budget_ -= entry.size;
    const std::span packed = bytes_.subspan(begin, entry.packed);
    if (entry.method == 0) return {packed.begin(), packed.end()};
    if (entry.method != 8) fail(Message("{}is packed in a way that tuft does not read", what));
    // A byte of DEFLATE gives 1032 at most.
    if (entry.size / 1032 > entry.packed) fail(Message("{}is damaged", what));
    std::vector<char> out(entry.size);
    z_stream stream{};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = reinterpret_cast<Bytef*>(out.data());
    stream.avail_out = static_cast<uInt>(out.size());
    if (inflateInit2(&stream, -MAX_WBITS) != Z_OK) fail(Message("{}cannot be unpacked", what));
    const int result = inflate(&stream, Z_FINISH);
    inflateEnd(&stream);
    if (result != Z_STREAM_END || stream.total_out != entry.size) fail(Message("{}is damaged", what));
    return out;
}

}  // namespace tuft::io
