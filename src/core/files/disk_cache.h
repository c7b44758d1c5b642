#pragma once

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <ostream>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "core/error.h"
#include "core/files/shared_array.h"
#include "core/hash.h"

/// \file
/// Results that can be computed again, stored between runs in the user's cache folder. `stroke` stores prepared models
/// and measured tip lags, `writer` fitted strokes, `app` pictures of brushes.
namespace tuft {

/// Returns the folder `tuft/NAME` in $XDG_CACHE_HOME, or else in $HOME/.cache. Empty when neither variable is set.
std::filesystem::path cache_folder(const std::string& name);

/// Fingerprint of everything that a result depends on: 128 bits, two XXH3 chains with different seeds. Values are
/// hashed as raw bytes, so a key holds only on machines of one byte order and one ABI.
class CacheKey {
  public:
    /// `kind` names the result and the version of its layout, such as "model 1".
    explicit CacheKey(std::string_view kind) { add_text(kind); }

    template <class T>
    void add(const T& value) {
        static_assert(std::is_arithmetic_v<T> || std::is_enum_v<T>);
        add_bytes(&value, sizeof(T));
    }
    /// Adds the number of elements first, so that neighbouring arrays cannot trade elements.
    template <class T>
    void add_array(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        add(values.size());
        add_bytes(values.data(), values.size_bytes());
    }
    void add_text(std::string_view text) { add_array(std::span<const char>(text)); }

    std::uint64_t low() const { return low_; }
    std::uint64_t high() const { return high_; }

  private:
    void add_bytes(const void* data, std::size_t size) {
        low_ = hash_bytes(data, size, low_);
        high_ = hash_bytes(data, size, high_);
    }

    std::uint64_t low_ = 0, high_ = 0x9e3779b97f4a7c15;
};

/// Writes the arrays of one entry, each with its size and its hash.
class CacheWriter {
  public:
    /// `at`: bytes of the file before what is written.
    CacheWriter(std::ostream& out, std::uint64_t at) : out_(out), at_(at) {}

    template <class T>
    void put(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        put_bytes(values.data(), values.size_bytes());
    }
    template <class T>
    void put(const std::vector<T>& values) {
        put(std::span<const T>(values));
    }
    void put_text(std::string_view text) { put(std::span<const char>(text)); }
    /// Stores a large array so that `CacheReader::map` can read it.
    template <class T>
    void put_to_map(const SharedArray<T>& values) {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= kMapped);
        put_large(values.data(), values.size(), sizeof(T));
    }

    static constexpr std::uint64_t kMapped = 65536;  ///< alignment in the file: every system's pages divide it
    /// Elements of so many bytes that are hashed at a time, each hash the seed of the next.
    static constexpr std::size_t in_piece(std::size_t element) {
        return std::max<std::size_t>(1, (std::size_t{1} << 20) / element);
    }

  private:
    void put_bytes(const void* data, std::size_t size);
    void put_large(const void* data, std::size_t n, std::size_t element);
    void write(const void* data, std::size_t size);

    std::ostream& out_;
    std::uint64_t at_ = 0;  ///< bytes
};

/// A file open for reading; closed with the object.
class OpenFile {
  public:
    OpenFile() = default;
    /// Opens a regular file; nothing when it cannot.
    explicit OpenFile(const std::filesystem::path& path);
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
    ~OpenFile();

    explicit operator bool() const { return descriptor_ >= 0; }
    std::uint64_t size() const { return size_; }
    /// Returns false unless all bytes were read.
    bool read(std::uint64_t at, void* out, std::uint64_t size) const;
    /// Maps a part that begins at a multiple of `CacheWriter::kMapped` and is not empty; null when it cannot. The
    /// mapping outlives the object, and the file's name. A file system over a network is not mapped: a page that does
    /// not come would end the process.
    std::shared_ptr<const void> map(std::uint64_t at, std::uint64_t size) const;

  private:
    int descriptor_ = -1;
    std::uint64_t size_ = 0;
};

/// Reads the arrays of one entry in the order in which they were written. Every function throws `Error` for an array
/// that is missing, too short, of another element size, or that has not its hash. Sizes are checked against the bytes
/// left in the file before memory is allocated.
class CacheReader {
  public:
    /// Reads from byte `at` of the file on, which outlives the reader.
    CacheReader(const OpenFile& file, std::uint64_t at) : file_(file), at_(at) {}

    template <class T>
    std::vector<T> get() {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::uint64_t size = next_size();
        if (size % sizeof(T) != 0) fail();
        std::vector<T> values(size / sizeof(T));
        get_bytes(values.data(), size);
        return values;
    }
    /// Returns an array of exactly one value.
    template <class T>
    T get_one() {
        const std::vector<T> values = get<T>();
        if (values.size() != 1) fail();
        return values.front();
    }
    /// Returns the next text.
    std::string get_text();
    /// Returns an array that `put_to_map` stored. Its bytes are read once for their hash, through a small buffer; the
    /// elements stay in the file, or are read where it cannot be mapped. `sound` is called with all elements, some at a
    /// time, and the index of the first of them; where it returns false the entry is damaged.
    template <class T>
    SharedArray<T> map(const std::function<bool(std::span<const T>, std::size_t)>& sound) {
        static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= CacheWriter::kMapped);
        const std::uint64_t size = begin_mapped();
        if (size % sizeof(T) != 0) fail();
        const std::size_t n = size / sizeof(T), most = CacheWriter::in_piece(sizeof(T));
        std::vector<T> piece(std::min(n, most));
        std::uint64_t hash = 0;
        for (std::size_t i = 0; i < n; i += most) {
            const std::span<T> now(piece.data(), std::min(most, n - i));
            read_piece(i * sizeof(T), now.data(), now.size_bytes(), hash);
            if (!sound(now, i)) fail();
        }
        if (hash != hash_) fail();
        std::shared_ptr<const void> bytes = n > 0 ? file_.map(at_, size) : nullptr;
        if (!bytes && n > 0) {
            const auto owned = std::make_shared<std::vector<T>>(n);
            if (!file_.read(at_, owned->data(), size)) fail();
            bytes = {owned, owned->data()};
        }
        at_ += size;
        const std::span<const T> elements(static_cast<const T*>(bytes.get()), n);
        return {std::move(bytes), elements};
    }

    /// Throws the `Error` for an entry that is not what it should be.
    [[noreturn]] static void fail();

  private:
    std::uint64_t next_size();
    void get_bytes(void* out, std::uint64_t size);
    std::uint64_t begin_mapped();
    void read_piece(std::uint64_t from, void* out, std::uint64_t size, std::uint64_t& hash) const;

    const OpenFile& file_;
    std::uint64_t at_ = 0;  ///< bytes
    std::uint64_t hash_ = 0;
};

/// A folder of entries, one file each, named by their keys. Several processes may use one folder at once: an entry is
/// written beside its place and renamed. A failure to write costs time only, so it is not an error.
class DiskCache {
  public:
    static constexpr std::uintmax_t kDefaultLimit = std::uintmax_t{2} << 30;

    /// No cache: `read` finds nothing, `write` does nothing.
    DiskCache() = default;
    /// Entries of together at most `limit` bytes in `folder`, which `write` creates when it is absent. An empty folder
    /// means no cache.
    explicit DiskCache(std::filesystem::path folder, std::uintmax_t limit = kDefaultLimit)
        : folder_(std::move(folder)), limit_(limit) {}

    const std::filesystem::path& folder() const { return folder_; }
    std::uintmax_t limit() const { return limit_; }

    /// Calls `take` with the entry of the key. Returns false when there is no entry or when `take` throws `Error`; a
    /// damaged entry is deleted. `take` must not change anything outside before it has read all it needs.
    bool read(const CacheKey& key, const std::function<void(CacheReader&)>& take) const;

    /// Stores an entry. Returns false when it could not be stored.
    bool write(const CacheKey& key, const std::function<void(CacheWriter&)>& put) const;

    /// Deletes the entries that were used longest ago until the folder is within its limit. To be called after `write`,
    /// once for many.
    void trim() const;

  private:
    std::filesystem::path path_of(const CacheKey& key) const;

    std::filesystem::path folder_;
    std::uintmax_t limit_ = kDefaultLimit;
};

}  // namespace tuft
