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

/// \file
/// The `.tuft` project: one SQLite database (application id "TUFT") with the model, its atlas, the presets, the journal
/// and a cache of the texels. Called by `cli` and by the studio's paint thread.
namespace tuft::io {

inline constexpr int kProjectFormat = 11;  ///< highest format version that this program reads
inline constexpr int kUnderFormat = 11;    ///< needed for areas that reach under later ones
inline constexpr int kTilesFormat = 11;    ///< needed for pictures on UDIM tiles
inline constexpr int kPartsFormat = 10;    ///< needed for parts with a state, and for substrates of glass
inline constexpr int kEdgesFormat = 9;     ///< needed for areas that end at edges, pictures, masks clear of edges
inline constexpr int kRolledFormat = 8;    ///< needed for strokes with a roll of the holder
inline constexpr int kStencilFormat = 7;   ///< needed for strokes with a stencil
inline constexpr int kColoursFormat = 6;   ///< needed for colours of the model
inline constexpr int kDrapedFormat = 5;    ///< needed for draped strokes
inline constexpr int kPaletteFormat = 4;   ///< needed for a palette
inline constexpr int kLayersFormat = 3;    ///< needed for layers, masks or fills
inline constexpr int kFilmsFormat = 2;     ///< needed for dry films, soaked ink or water
inline constexpr int kFirstFormat = 1;     ///< all else

/// A preset's name and TOML text.
using PresetText = std::pair<std::string, std::string>;

/// A model to be written, without copies; the references must outlive it.
struct ModelToWrite {
    std::string source;              ///< path of the model file, for messages
    FileFrame frame;                 ///< of that file
    const mesh::TriangleMesh& mesh;  ///< metres
    const atlas::Atlas& atlas;
    std::string substrate;  ///< TOML text
};

/// A model as read from a project.
struct ProjectModel {
    std::string source;
    FileFrame frame;
    mesh::TriangleMesh mesh;
    atlas::Atlas atlas;
    std::string substrate;

    operator ModelToWrite() const { return {source, frame, mesh, atlas, substrate}; }
};

/// Texels of the first layer as they were after stroke `stroke_id`.
struct SavedCanvas {
    ink::Canvas canvas;
    std::uint64_t stroke_id = 0;
};

/// Texels of all layers as they were after stroke `stroke_id`.
struct SavedCanvases {
    std::vector<stroke::LayerCanvas> layers;
    std::uint64_t stroke_id = 0;
};

/// Access to a project. One process at a time may write it (`ProjectLock`). Any number of others may read it meanwhile;
/// they see each change once it is committed.
enum class Access { read, write };

/// Options of `Project::open` and `Project::create`.
struct OpenOptions {
    Access access = Access::write;
    std::chrono::milliseconds patience{0};  ///< longest wait for another program to release the lock
    /// Called about every tenth of a second while any method works; may throw `Cancelled`. See `listen`.
    ProgressFn progress = {};
};

/// Another program changed the project since it was opened here, or replaced the file. Nothing is written then.
class ChangedOutside : public Error {
  public:
    explicit ChangedOutside(const std::filesystem::path& project);
};

/// An open project. One thread at a time.
///
/// Every change is one committed transaction. A kill at any moment loses at most the change in progress. Afterwards the
/// project is one file; a file NAME-journal beside it after a kill is needed by the next opening. Methods throw `Error`
/// naming the file when it is damaged or the disk is full; those that change it also throw `ChangedOutside`. The file
/// is untrusted: no code in it runs, and sizes are checked before memory is taken.
class Project {
  public:
    /// Creates a project with the content that `fill` adds, and replaces a file of that name. After an error or a kill
    /// the old file is unchanged. Throws `ProjectInUse` where another program has the project of that name.
    static Project create(const std::filesystem::path& path, const ModelToWrite& model,
                          const std::function<void(Project&)>& fill = {}, const OpenOptions& options = {});
    /// Opens a project and checks all its pages. Throws `Error` for a file that is no tuft project, damaged, or from a
    /// newer version; `ProjectInUse`; `Cancelled`.
    static Project open(const std::filesystem::path& path, const OpenOptions& options = {});
    ~Project();
    Project(Project&&) noexcept;
    Project& operator=(Project&&) noexcept;

    const std::filesystem::path& path() const;
    /// Sets the function that is called while methods work; empty: none.
    void listen(ProgressFn progress);
    /// Returns true when another program changed or replaced the file since it was opened. Cost: about 1 µs while the
    /// file's time does not change.
    bool changed_outside() const;
    /// Runs `read` within one read transaction, so that all its reads see one state of the file.
    void read_together(const std::function<void()>& read) const;
    int format() const;
    std::string written_by() const;  ///< name and version of the program that created it

    ProjectModel model() const;        ///< checked: sizes agree, indices in range, numbers finite, UVs valid
    std::uint64_t model_hash() const;  ///< of positions and triangles

    /// Store a preset, in place of one of its name and kind, in one transaction.
    void put_brush(const PresetText& preset);
    void put_ink(const PresetText& preset);
    void put_substrate(const std::string& toml);
    std::vector<PresetText> brushes() const;  ///< by name
    std::vector<PresetText> inks() const;

    /// Appearance, apart from the journal: an ink shown in place of the one of that name, and a substrate shown in
    /// place of the project's (TOML text; empty: none).
    void put_recolour(const PresetText& preset);
    std::vector<PresetText> recolours() const;
    void put_shown_substrate(const std::string& toml);
    std::string shown_substrate() const;

    /// Attachments of a kind, by name (io/project/attachments.h). One of the same name is replaced.
    void put_attachment(const std::string& kind, const Attachment& attachment);
    void remove_attachment(const std::string& kind, const std::string& name);
    std::vector<Attachment> attachments(const std::string& kind) const;

    /// Appends finished strokes in one transaction. Their ids must be new.
    void append(std::span<const stroke::JournalEntry> strokes);
    void append(const stroke::JournalEntry& stroke) { append(std::span(&stroke, 1)); }
    void set_hidden(std::uint64_t stroke_id, bool hidden);  ///< drops texels stored after this or a later stroke
    void remove(std::uint64_t stroke_id);                   ///< drops texels likewise
    /// Returns all strokes in order, equal bit by bit to those appended.
    std::vector<stroke::JournalEntry> strokes() const;
    std::size_t n_strokes() const;

    /// Stores all painted tiles, in place of those stored before.
    void save_canvases(std::span<const stroke::LayerTexels> layers, std::uint64_t stroke_id);
    void save_canvas(const ink::Canvas& canvas, std::uint64_t stroke_id);  ///< of the first layer
    /// Returns the stored tiles for a texel map of `n_slots` slots; nothing where none are stored or they belong to
    /// another map.
    std::optional<SavedCanvases> load_canvases(std::size_t n_slots) const;
    std::optional<SavedCanvas> load_canvas(std::size_t n_slots) const;  ///< of the first layer

  private:
    struct State;
    explicit Project(std::unique_ptr<State> state);
    static Project open_file(const std::filesystem::path& path, std::optional<ProjectLock> lock,
                             const ProgressFn& progress);
    std::unique_ptr<State> state_;
};

/// Returns true when the file starts like a SQLite database with the application id "TUFT".
bool is_project(const std::filesystem::path& path);

}  // namespace tuft::io
