#pragma once

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "atlas/atlas.h"
#include "core/system/progress.h"
#include "core/text/units.h"
#include "ink/canvas/canvas.h"
#include "io/project/attachments.h"
#include "io/project/project_lock.h"
#include "mesh/triangle_mesh.h"
#include "stroke/journal/journal.h"

/// The `.tuft` project: one SQLite database (application id "TUFT") that holds the model,
/// its atlas, the presets used, the journal and a picture of the texels.
namespace tuft::io {

inline constexpr int kProjectFormat = 8;  ///< highest format version this program reads
inline constexpr int kRolledFormat = 8;   ///< of projects with strokes whose holder rolls
inline constexpr int kTapedFormat = 7;    ///< of projects with strokes that keep to stencil edge
inline constexpr int kColoursFormat = 6;  ///< of projects with colours of the model
inline constexpr int kDrapedFormat = 5;   ///< of projects with draped strokes
inline constexpr int kPaletteFormat = 4;  ///< of projects with a palette
inline constexpr int kLayersFormat = 3;   ///< of projects with layers, masks or fills
inline constexpr int kFilmsFormat = 2;    ///< of projects with dry films, soaked ink or water
inline constexpr int kFirstFormat = 1;    ///< of projects without any of these

/// A preset's name and TOML text.
using PresetText = std::pair<std::string, std::string>;

/// What is written of a model, where it lies: a million triangles are not copied for it.
struct ModelToWrite {
    std::string source;              ///< file the model came from, for people
    FileFrame frame;                 ///< of that file
    const mesh::TriangleMesh& mesh;  ///< metres
    const atlas::Atlas& atlas;
    std::string substrate;  ///< TOML text
};

/// And what is read.
struct ProjectModel {
    std::string source;
    FileFrame frame;
    mesh::TriangleMesh mesh;
    atlas::Atlas atlas;
    std::string substrate;

    operator ModelToWrite() const { return {source, frame, mesh, atlas, substrate}; }
};

/// Texels as they were after stroke `stroke_id`, to be shown without a replay.
struct SavedCanvas {
    ink::Canvas canvas;
    std::uint64_t stroke_id = 0;
};

/// The same of all layers.
struct SavedCanvases {
    std::vector<stroke::LayerCanvas> layers;
    std::uint64_t stroke_id = 0;
};

/// What a project is opened for. One process at a time may write it (`ProjectLock`); any number read
/// it meanwhile, and see each change once it is whole.
enum class Access { read, write };

struct OpenOptions {
    Access access = Access::write;
    std::chrono::milliseconds patience{0};  ///< to wait for another program to let go of it
    ProgressFn progress =
        {};  ///< asked about every tenth of a second, also by the methods, while they work; see `listen`
};

/// Another program changed the project, or put another file in its place, since it was opened here:
/// nothing is written on top of that.
class ChangedOutside : public Error {
  public:
    explicit ChangedOutside(const std::filesystem::path& project);
};

/// An open project. Every change is one committed transaction: a kill at any moment loses
/// at most the change in hand, and after any end the project is the one file (a file
/// NAME-journal beside it after a kill is needed by the next opening). Methods throw
/// `Error` naming the file when it is damaged or the disk is full, and those that change it
/// `ChangedOutside`. A file may come from anywhere: nothing that it brings is run, sizes are
/// checked before memory is taken. One thread at a time.
class Project {
  public:
    /// Makes a new project in place of any file of that name, complete with what `fill` puts into
    /// it, or not at all: on any error, or a kill, what was there stays. Throws `ProjectInUse` where
    /// another program has the project of that name.
    static Project create(const std::filesystem::path& path, const ModelToWrite& model,
                          const std::function<void(Project&)>& fill = {}, const OpenOptions& options = {});
    /// Opens a project. Throws `Error` for a file that is not a tuft project, is from a
    /// newer version, or is damaged (all pages are checked); `ProjectInUse`; `Cancelled`.
    static Project open(const std::filesystem::path& path, const OpenOptions& options = {});
    ~Project();
    Project(Project&&) noexcept;
    Project& operator=(Project&&) noexcept;

    const std::filesystem::path& path() const;
    /// Who is asked from now on whether to go on; nobody: empty.
    void listen(ProgressFn progress);
    /// Whether another program changed the file since it was opened, or another file is in its place.
    /// Appearance at the file's time first: about a microsecond while nothing changes.
    bool changed_outside() const;
    /// Runs `read` on one state of the file, whoever writes meanwhile.
    void read_together(const std::function<void()>& read) const;
    int format() const;
    std::string written_by() const;  ///< program and version that made it

    ProjectModel model() const;        ///< checked: sizes agree, indices in range, numbers finite, UVs sound
    std::uint64_t model_hash() const;  ///< of positions and triangles

    void put_brush(const PresetText& preset);
    void put_ink(const PresetText& preset);
    void put_substrate(const std::string& toml);
    std::vector<PresetText> brushes() const;  ///< by name
    std::vector<PresetText> inks() const;

    /// How the work is shown, apart from how it was painted: another ink in place of the one
    /// named, another substrate (TOML text; empty: none).
    void put_recolour(const PresetText& preset);
    std::vector<PresetText> recolours() const;
    void put_shown_substrate(const std::string& toml);
    std::string shown_substrate() const;

    /// What the project carries of a kind, by name (io/project/attachments.h). One of the same name is replaced.
    void put_attachment(const std::string& kind, const Attachment& attachment);
    void remove_attachment(const std::string& kind, const std::string& name);
    std::vector<Attachment> attachments(const std::string& kind) const;

    /// Adds finished strokes after the last one, in one transaction. Their ids must be new.
    void append(std::span<const stroke::JournalEntry> strokes);
    void append(const stroke::JournalEntry& stroke) { append(std::span(&stroke, 1)); }
    void set_hidden(std::uint64_t stroke_id, bool hidden);  ///< forgets texels stored after it or a later one
    void remove(std::uint64_t stroke_id);                   ///< likewise
    /// All strokes in order, every number as it was put in, to the bit.
    std::vector<stroke::JournalEntry> strokes() const;
    std::size_t n_strokes() const;

    /// Stores all painted tiles in place of those stored before.
    void save_canvases(std::span<const stroke::LayerTexels> layers, std::uint64_t stroke_id);
    void save_canvas(const ink::Canvas& canvas, std::uint64_t stroke_id);  ///< of the first layer
    /// The stored tiles for a texel map of `n_slots` slots; nothing when none were stored
    /// or they were made for another map.
    std::optional<SavedCanvases> load_canvases(std::size_t n_slots) const;
    std::optional<SavedCanvas> load_canvas(std::size_t n_slots) const;  ///< of the first layer

  private:
    struct State;
    explicit Project(std::unique_ptr<State> state);
    static Project open_file(const std::filesystem::path& path, std::optional<ProjectLock> lock,
                             const ProgressFn& progress);
    std::unique_ptr<State> state_;
};

/// Whether the file starts like a SQLite database with our application id.
bool is_project(const std::filesystem::path& path);

}  // namespace tuft::io
