#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/paint/paint_thread.h"
#include "core/message.h"
#include "io/model/read_model.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/repair/inspect.h"

/// \file
/// Opening of models and projects in the background. Window thread.
namespace tuft::app {

/// Content of a model file, before it has an atlas.
struct Inspected {
    std::filesystem::path path;
    mesh::PolygonSoup soup;
    mesh::MeshSummary summary;     ///< lengths in metres, by the guessed unit
    std::vector<Message> defects;  ///< found and repaired, one line each

    bool unit_stated() const { return soup.stated_unit > 0; }
    /// Metres per unit of the soup's points by the choice of a person, else as the file states it.
    double metres_per_unit(const FileFrame& frame) const;
};

/// Choices of the opening dialog.
struct OpenOptions {
    FileFrame frame;               ///< of the model file
    std::filesystem::path framed;  ///< the file that `frame` was chosen for
    std::uint32_t atlas_size = 2048;
    std::string substrate = "porcelain";
    bool own_colours = true;    ///< shows the model's own colours, if any
    bool turned_round = false;  ///< the other side of open parts is their front than reading chose
    bool follow = true;         ///< of a revised model: strokes go where it, or their part of it, was moved
    io::CadReading cad;         ///< by which a CAD file was read
};

/// Purpose of opening a project.
enum class OpenAs {
    work,  ///< continues in its file, or in a copy where that is not writable
    view,  ///< read-only, while another program works on it
    copy,  ///< continues in a copy
};

/// A project that another program holds.
struct InUse {
    std::filesystem::path project;
    io::LockHolder holder;
};

/// Opens a model in two steps: `inspect` reads and checks the file; `prepare` unwraps it and makes it ready for
/// painting. A project needs `load` only. Each step runs on a thread of its own. One step at a time: a new one cancels
/// the last.
class Opening {
  public:
    Opening();
    ~Opening();

    /// Begins to read a file; then begins to prepare what was read.
    void inspect(const std::filesystem::path& path, const io::CadReading& cad = {});
    void prepare(Inspected inspected, const OpenOptions& options, const std::filesystem::path& project);
    /// Prepares a model that replaces another: paints the strokes of the project `former` on it.
    void revise(Inspected inspected, const OpenOptions& options, const std::filesystem::path& former,
                const std::filesystem::path& project);
    /// Loads a project. `session`: where a copy is created.
    void load(const std::filesystem::path& project, const std::filesystem::path& session, OpenAs as = OpenAs::work);
    void cancel();

    bool running() const { return job_ != nullptr; }
    std::string phase() const;  ///< in English, for the status bar
    double fraction() const;    ///< of the whole step, 0–1

    /// The result of a step, returned once. `error`: one line, or empty.
    struct Result {
        std::optional<Inspected> inspected;
        std::optional<PaintWork> work;
        std::optional<InUse> in_use;  ///< why it was not opened
        Message error;
        bool done = false;
    };
    /// Returns the result once the work that runs has ended.
    Result poll();

  private:
    struct Job;
    template <class Step>
    void start(Step step);

    std::unique_ptr<Job> job_;
    std::filesystem::path loaded_;               ///< project of the last `load`
    std::vector<std::unique_ptr<Job>> leaving_;  ///< cancelled, still running
};

/// Returns the texel size in metres that an atlas of `size` texels per side gives a surface of `area` m². It assumes
/// the usual utilisation of 3/4.
double expected_texel(double area, std::uint32_t size);
/// Returns the proposed side of the atlas in texels: 2048; 4096 where texels would be larger than 0.4 mm, a fine
/// brush's line, and memory suffices.
std::uint32_t proposed_size(double area);

}  // namespace tuft::app
