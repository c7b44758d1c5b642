#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <future>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "brush/preset/preset.h"
#include "core/message.h"

/// \file
/// The brushes that one can choose, read once, in groups as a shop hangs them. Window thread.
namespace tuft::app {

/// Returns true for a brush of a file of the user: a name with a folder, or ending in .toml.
bool is_own_brush(const std::string& name);

/// Returns the family of a brush: "own" for a file; "goat", "mixed" or "wolf" for pointed brushes named after their
/// hair; by its build "sponge" for foam, "flat" for a broad side, "liner" for hair of at least six thicknesses, else
/// "round".
std::string family_of(const std::string& name, const brush::Preset& preset);

/// Brushes of one make.
struct BrushFamily {
    std::string title;               ///< English, has an entry in the catalogues
    std::vector<std::string> names;  ///< from short to long hair
};

/// A brush as it hangs there.
struct ShelfBrush {
    brush::Preset preset;       ///< as it was read last; of one that was never read that of no name
    Message fault;              ///< why it cannot be taken now, such as a file that is missing; empty: it can
    std::uint64_t reading = 0;  ///< another one whenever its file was read
    std::optional<std::filesystem::file_time_type> written;  ///< when its file was; nothing: there is none
};

/// Reads each brush when it is first asked for, and files of the user again when they change, go or come back. Those
/// are read on a thread of its own: a disk in a network may take long to answer, or never does. The destructor does not
/// wait for it.
class BrushShelf {
  public:
    BrushShelf() = default;
    ~BrushShelf();
    BrushShelf(const BrushShelf&) = delete;
    BrushShelf& operator=(const BrushShelf&) = delete;

    /// Returns a brush by the name of its own size.
    const ShelfBrush& at(const std::string& name);
    /// Reads the brush now.
    const ShelfBrush& read(const std::string& name);
    /// Takes what the last look found, and begins the next one, at most once a second. Lets go of files that are
    /// neither among `names` nor `in_hand`: when they are asked for again, they are read again. Returns at once.
    void watch(const std::vector<std::string>& names, const std::string& in_hand);
    /// Begins to read the files again that are not as they were, where no look is in work. Returns at once.
    void look();
    /// Takes what a look found, when it is done. A brush that was read since the look began stays as it is.
    void poll();
    void wait() const;
    bool busy() const { return looking_.valid(); }
    /// Returns the families of these brushes, each once: goat, mixed, wolf, flat, liner, round, sponge, own. Holds
    /// until the next call.
    const std::vector<BrushFamily>& families(const std::vector<std::string>& names);

  private:
    /// What was read of a brush.
    struct Read {
        std::optional<brush::Preset> preset;  ///< nothing: there is a fault
        Message fault;
        std::optional<std::filesystem::file_time_type> written;
    };
    /// A brush before a look.
    struct Known {
        std::string name;
        std::uint64_t reading = 0;
        std::optional<std::filesystem::file_time_type> written;
    };
    struct Changed {
        Known before;
        Read read;
    };
    static Read read_file_of(const std::string& name);
    const ShelfBrush& take(const std::string& name, Read read);

    std::map<std::string, ShelfBrush> brushes_;
    std::uint64_t readings_ = 0;
    std::chrono::steady_clock::time_point looked_;
    std::future<std::vector<Changed>> looking_;
    std::vector<BrushFamily> families_;
    std::vector<std::string> names_;  // that `families_` are of
    std::uint64_t families_at_ = 0;   // readings
};

}  // namespace tuft::app
