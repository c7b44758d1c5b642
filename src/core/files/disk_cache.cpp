#include "core/files/disk_cache.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdlib>
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

std::array<std::uint64_t, 3> head_of(const CacheKey& key) {
    return {kMagic, key.low(), key.high()};
}

}  // namespace

fs::path cache_folder(const std::string& name) {
    if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) return fs::path(cache) / "tuft" / name;
    if (const char* home = std::getenv("HOME"); home && *home) return fs::path(home) / ".cache" / "tuft" / name;
    return {};
}

void CacheWriter::put_bytes(const void* data, std::size_t size) {
    const std::array<std::uint64_t, 2> head{size, hash_bytes(data, size)};
    out_.write(reinterpret_cast<const char*>(head.data()), sizeof(head));
    if (size > 0) out_.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
}

void CacheReader::fail() {
    throw Error("an entry of the cache is damaged");
}

std::uint64_t CacheReader::next_size() {
    std::array<std::uint64_t, 2> head{};
    if (left_ < sizeof(head) || !file_.read(reinterpret_cast<char*>(head.data()), sizeof(head))) fail();
    left_ -= sizeof(head);
    if (head[0] > left_) fail();
    hash_ = head[1];
    return head[0];
}

void CacheReader::get_bytes(void* out, std::uint64_t size) {
    if (size > 0 && !file_.read(static_cast<char*>(out), static_cast<std::streamsize>(size))) fail();
    left_ -= size;
    if (hash_bytes(out, size) != hash_) fail();
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
    if (!fs::is_regular_file(path, ec)) return false;
    const std::uintmax_t size = fs::file_size(path, ec);
    std::ifstream file(path, std::ios::binary);
    if (ec || !file) return false;
    try {
        std::array<std::uint64_t, 3> head{};
        if (size < sizeof(head) || !file.read(reinterpret_cast<char*>(head.data()), sizeof(head)) ||
            head != head_of(key))
            CacheReader::fail();
        CacheReader reader(std::move(file), size - sizeof(head));
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
            CacheWriter writer(file);
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
