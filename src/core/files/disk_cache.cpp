#include "core/files/disk_cache.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/vfs.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <tuple>
#include <utility>

#include "core/files/files.h"

namespace fs = std::filesystem;

namespace tuft {
namespace {

constexpr std::uint64_t kMagic = 0x3165686361637475;  // "utcache1"
constexpr const char* kExtension = ".entry";
// What a killed process left unfinished is deleted after a day: until then another may still be writing it.
constexpr auto kUnfinishedFor = std::chrono::hours(24);

std::uint64_t before_mapped(std::uint64_t at) {
    return (CacheWriter::kMapped - at % CacheWriter::kMapped) % CacheWriter::kMapped;
}

/// NFS, SMB, CIFS, 9P, Ceph and what FUSE serves.
bool is_remote(const struct statfs& system) {
    constexpr std::uint32_t kRemote[] = {0x6969, 0x517b, 0xff534d42, 0xfe534d42, 0x01021997, 0x00c36400, 0x65735546};
    return std::ranges::find(kRemote, static_cast<std::uint32_t>(system.f_type)) != std::end(kRemote);
}

std::array<std::uint64_t, 3> head_of(const CacheKey& key) {
    return {kMagic, key.low(), key.high()};
}

}  // namespace

fs::path cache_folder(const std::string& name) {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "tuft" / name;
    if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "tuft" / name;
    return {};
}

void CacheWriter::write(const void* data, std::size_t size) {
    if (size > 0) out_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
    at_ += size;
}

void CacheWriter::put_bytes(const void* data, std::size_t size) {
    const std::array<std::uint64_t, 2> head{size, hash_bytes(data, size)};
    write(head.data(), sizeof(head));
    write(data, size);
}

void CacheWriter::put_large(const void* data, std::size_t n, std::size_t element) {
    const auto* const bytes = static_cast<const char*>(data);
    const std::size_t size = n * element, piece = in_piece(element) * element;
    std::uint64_t hash = 0;
    for (std::size_t i = 0; i < size; i += piece) hash = hash_bytes(bytes + i, std::min(piece, size - i), hash);
    const std::array<std::uint64_t, 2> head{size, hash};
    write(head.data(), sizeof(head));
    const std::vector<char> padding(before_mapped(at_));
    write(padding.data(), padding.size());
    write(data, size);
}

OpenFile::OpenFile(const fs::path& path) : descriptor_(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK)) {
    struct stat facts {};
    if (descriptor_ < 0) return;
    if (::fstat(descriptor_, &facts) == 0 && S_ISREG(facts.st_mode)) {
        size_ = static_cast<std::uint64_t>(facts.st_size);
        return;
    }
    ::close(descriptor_);
    descriptor_ = -1;
}

OpenFile::~OpenFile() {
    if (descriptor_ >= 0) ::close(descriptor_);
}

bool OpenFile::read(std::uint64_t at, void* out, std::uint64_t size) const {
    auto* bytes = static_cast<char*>(out);
    while (size > 0) {
        const ssize_t n = ::pread(descriptor_, bytes, size, static_cast<off_t>(at));
        if (n < 0 && errno == EINTR) continue;
        if (n <= 0) return false;
        bytes += n, at += static_cast<std::uint64_t>(n), size -= static_cast<std::uint64_t>(n);
    }
    return true;
}

std::shared_ptr<const void> OpenFile::map(std::uint64_t at, std::uint64_t size) const {
    struct statfs system {};
    if (::fstatfs(descriptor_, &system) != 0 || is_remote(system)) return nullptr;
    void* const bytes = ::mmap(nullptr, size, PROT_READ, MAP_PRIVATE, descriptor_, static_cast<off_t>(at));
    if (bytes == MAP_FAILED) return nullptr;
    return {bytes, [size](const void* p) { ::munmap(const_cast<void*>(p), size); }};
}

void CacheReader::fail() {
    throw Error("an entry of the cache is damaged");
}

std::uint64_t CacheReader::next_size() {
    std::array<std::uint64_t, 2> head{};
    if (at_ > file_.size() || file_.size() - at_ < sizeof(head) || !file_.read(at_, head.data(), sizeof(head))) fail();
    at_ += sizeof(head);
    if (head[0] > file_.size() - at_) fail();
    hash_ = head[1];
    return head[0];
}

void CacheReader::get_bytes(void* out, std::uint64_t size) {
    if (!file_.read(at_, out, size)) fail();
    at_ += size;
    if (hash_bytes(out, size) != hash_) fail();
}

std::uint64_t CacheReader::begin_mapped() {
    const std::uint64_t size = next_size();
    at_ += before_mapped(at_);
    if (at_ > file_.size() || size > file_.size() - at_) fail();
    return size;
}

void CacheReader::read_piece(std::uint64_t from, void* out, std::uint64_t size, std::uint64_t& hash) const {
    if (!file_.read(at_ + from, out, size)) fail();
    hash = hash_bytes(out, size, hash);
}

std::string CacheReader::get_text() {
    const std::vector<char> text = get<char>();
    return {text.begin(), text.end()};
}

fs::path DiskCache::path_of(const CacheKey& key) const {
    return folder_ / fmt::format("{:016x}{:016x}{}", key.high(), key.low(), kExtension);
}

bool DiskCache::read(const CacheKey& key, const std::function<void(CacheReader&)>& take) const {
    if (folder_.empty()) return false;
    const fs::path path = path_of(key);
    std::error_code ec;
    const OpenFile file(path);
    if (!file) return false;
    try {
        std::array<std::uint64_t, 3> head{};
        if (file.size() < sizeof(head) || !file.read(0, head.data(), sizeof(head)) || head != head_of(key))
            CacheReader::fail();
        CacheReader reader(file, sizeof(head));
        take(reader);
    } catch (const Error&) {
        fs::remove(path, ec);
        return false;
    }
    fs::last_write_time(path, fs::file_time_type::clock::now(), ec);  // used now: it is deleted last
    return true;
}

bool DiskCache::write(const CacheKey& key, const std::function<void(CacheWriter&)>& put) const {
    if (folder_.empty()) return false;
    try {
        fs::create_directories(folder_);
        write_atomically(path_of(key), [&](const fs::path& temporary) {
            std::ofstream file(temporary, std::ios::binary | std::ios::trunc);
            const std::array<std::uint64_t, 3> head = head_of(key);
            file.write(reinterpret_cast<const char*>(head.data()), sizeof(head));
            CacheWriter writer(file, sizeof(head));
            put(writer);
            file.close();
            if (!file) throw Error(temporary.string(), "could not be written to its end (disk full?)");
        });
    } catch (const Error&) {
        return false;
    } catch (const fs::filesystem_error&) {
        return false;
    }
    return true;
}

void DiskCache::trim() const {
    struct Entry {
        fs::file_time_type used;
        fs::path path;
        std::uintmax_t size = 0;
    };
    std::vector<Entry> entries;
    std::uintmax_t total = 0;
    std::error_code ec;
    for (fs::directory_iterator it(folder_, ec), end; !ec && it != end; it.increment(ec)) {
        std::error_code gone;  // another process may delete it meanwhile
        if (it->path().extension() != kExtension || !it->is_regular_file(gone)) continue;
        Entry entry{it->last_write_time(gone), it->path(), it->file_size(gone)};
        if (gone) continue;
        const bool unfinished = it->path().filename().string().starts_with('.');
        if (unfinished && fs::file_time_type::clock::now() - entry.used < kUnfinishedFor) continue;
        if (unfinished) {
            fs::remove(entry.path, gone);
            continue;
        }
        total += entry.size;
        entries.push_back(std::move(entry));
    }
    std::sort(entries.begin(), entries.end(),
              [](const Entry& a, const Entry& b) { return std::tie(a.used, a.path) < std::tie(b.used, b.path); });
    for (const Entry& entry : entries) {
        if (total <= limit_) break;
        std::error_code gone;
        fs::remove(entry.path, gone);
        total -= entry.size;
    }
}

}  // namespace tuft
