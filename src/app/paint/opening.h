#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/paint/paint_thread.h"
#include "core/message.h"
#include "mesh/read/polygon_soup.h"
#include "mesh/repair/inspect.h"

namespace tuft::app {

/// What a model file holds, before it is given an atlas.
struct Inspected {
    std::filesystem::path path;
    mesh::PolygonSoup soup;
    mesh::MeshSummary summary;     ///< lengths in metres by the guessed unit
    std::vector<Message> defects;  ///< found and repaired, one line each
    bool unit_fixed = false;       ///< the format says the unit
};

struct OpenOptions {
    FileFrame frame;  ///< of the model file
    std::uint32_t atlas_size = 2048;
    std::string substrate = "porcelain";
    bool own_colours = true;    ///< the model's, where it brings any along
    bool turned_round = false;  ///< all faces, of a model that is inside out
};

/// What a project is opened for.
enum class OpenAs {
    work,  ///< to go on in its file; in a copy where that cannot be written
    view,  ///< to look at it while another program works on it
    copy,  ///< to go on in a copy
};

/// A project that another program has.
struct InUse {
    std::filesystem::path project;
    io::LockHolder holder;
};

/// Opening a model takes two steps, each on a thread of its own: `inspect` reads and checks
/// the file; `prepare` unwraps it and makes it ready to be painted on. A project needs
/// `load` only. One step at a time; starting one stops the one before.
class Opening {
  public:
    Opening();
    ~Opening();

    void inspect(const std::filesystem::path& path);
    void prepare(Inspected inspected, const OpenOptions& options, const std::filesystem::path& project);
    /// The same for a model that takes the place of another: paints the strokes of `former` on it.
    void revise(Inspected inspected, const OpenOptions& options, const std::filesystem::path& former,
                const std::filesystem::path& project);
    /// `session`: where a copy goes.
    void load(const std::filesystem::path& project, const std::filesystem::path& session, OpenAs as = OpenAs::work);
    void cancel();

    bool running() const { return job_ != nullptr; }
    std::string phase() const;  ///< for a person, English
    double fraction() const;    ///< of the whole

    /// Whether the step is done; results are taken once. The error is empty if there was none.
    struct Result {
        std::optional<Inspected> inspected;
        std::optional<PaintWork> work;
        std::optional<InUse> in_use;  ///< and therefore not opened
        Message error;
        bool done = false;
    };
    Result poll();

  private:
    struct Job;
    template <class Step>
    void start(Step step);

    std::unique_ptr<Job> job_;
    std::filesystem::path loaded_;               ///< project of the last `load`
    std::vector<std::unique_ptr<Job>> leaving_;  ///< cancelled, not ended yet
};

/// Texel size in metres that an atlas of `size` texels per side gives a surface of that area
/// (m²), with the usual three quarters of it used.
double expected_texel(double area, std::uint32_t size);
/// Side of the atlas that is proposed for it: 2048, or 4096 where texels would be larger than
/// 0.4 mm, a fine brush's line, and there is memory for it.
std::uint32_t proposed_size(double area);

}  // namespace tuft::app
