#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments/arguments.h"
#include "cli/steps/console.h"
#include "io/import/read_import.h"
#include "io/project/project.h"
#include "pictures/picture_look.h"
#include "render/picture/picture.h"
#include "stroke/document/document.h"
#include "stroke/journal/entries.h"

/// \file
/// Steps that several commands share. Main thread. All functions throw `Error` where a file cannot be read or written.
namespace tuft::cli {

/// Returns the atlas and UV options of `stroke` for these arguments.
stroke::ModelOptions model_options(const Surface& surface, Console& console);

/// Returns the cache of measured tip lags for `stroke::DocumentOptions`: none with `--no-cache`.
DiskCache tip_lag_cache(const Surface& surface);
/// Returns the cache of prepared models, or none with `--no-cache`.
DiskCache model_cache(const Surface& surface);

/// A model and how its file was read.
struct Loaded {
    stroke::Model model;
    FileFrame frame;
    bool unit_stated = false;  ///< by the file, and nobody said another one
};

/// Returns how the surfaces of a CAD file become triangles. Throws `UsageError` where the options say it of another
/// file.
io::CadReading cad_reading(const std::filesystem::path& path, const FileReading& how);

/// Returns how the points of a file that was read become metres, z up, by the arguments, then by the file. Reports a
/// unit that goes before the one that the file states, and an axis that the file states itself.
mesh::RepairOptions repair_of(const mesh::PolygonSoup& soup, const std::filesystem::path& path, const FileReading& how,
                              Console& console);

/// Reads, repairs and unwraps a model file. Its unit is that of the arguments or the file, else it is guessed from
/// the size. A guess other than millimetres is reported.
/// `former`: unit and axis of the file that this one revises, which hold where nobody says others.
Loaded load_model(const std::filesystem::path& path, const Surface& surface, Console& console,
                  const FileFrame* former = nullptr);

/// Reads and repairs a model file, without an atlas and without surface queries.
Loaded load_bare(const std::filesystem::path& path, const FileReading& how, Console& console);

/// Throws `Error` when a file cannot be written there because its folder is missing or not writable. Call it before
/// long work. Empty paths are skipped.
void check_output(const std::filesystem::path& path);
/// Throws `Error` when `folder` is none that files can be written to and cannot be made, because the folder it lies in
/// is missing or not writable. A slash at its end makes no difference. Call it before long work.
void check_folder(const std::filesystem::path& folder);
/// Throws `UsageError` when the extension is none of `allowed` (".glb" …).
void check_extension(const std::filesystem::path& path, const std::vector<std::string>& allowed);

/// Returns the settings of strokes by the arguments.
stroke::EntryOptions entry_options(const Paint& arguments);

/// Returns the strokes of InkML and SVG files in order. Brush and ink are filled in where the file names none. Each
/// file is a group, numbered from 1.
std::vector<stroke::JournalEntry> load_strokes(const Paint& arguments, Console& console);

/// Makes only the layers of these names visible. Throws `UsageError` for an unknown name.
void show_layers(stroke::Document& painting, const std::vector<std::string>& names);

/// Output files of a painting command; empty paths are skipped.
struct Outputs {
    std::filesystem::path project, exported, preview;
    View view;
    FileFrame frame;
};
void check_outputs(const Outputs& outputs);
/// Writes the exported model and the preview. The project is written while painting.
void write_outputs(const Outputs& outputs, const stroke::Document& painting, Console& console);

/// Returns size, camera and lights of the arguments.
render::PictureOptions picture_options(const View& view, const stroke::Model& model);

/// What to draw. The references must outlive it.
struct PictureRequest {
    const stroke::Model& model;
    const stroke::Document* painting = nullptr;  ///< null: the bare model
    const View& view;
    std::string material = {};                     ///< of the bare surface; empty: the painting's, else porcelain
    int turntable_frame = 0, turntable_count = 1;  ///< the view is rotated by frame / count of a revolution
};
/// Draws a painted or a bare model.
render::Image draw_picture(const PictureRequest& request, Console& console);

/// Returns the viewpoint from which `draw_picture` draws a model.
render::View picture_view(const View& view, const mesh::TriangleMesh& mesh);

/// Writes a picture in the format of its extension. Throws `Error`.
void write_picture(const std::filesystem::path& path, const render::Image& image);

/// Loads the brushes and inks of the strokes. Throws `Error` for an unknown one, before any ink flows.
void find_presets(stroke::Document& painting, const std::vector<stroke::JournalEntry>& strokes);
/// Stores the presets that the strokes use.
void put_presets(io::Project& project, stroke::Document& painting, const std::vector<stroke::JournalEntry>& strokes);
/// Creates a project with the model and the presets of the strokes. Finished strokes are appended to it later.
io::Project start_project(const std::filesystem::path& path, const std::string& source, const FileFrame& frame,
                          stroke::Document& painting, const std::vector<stroke::JournalEntry>& strokes);

/// A project and its model, ready for painting.
struct OpenProject {
    io::Project file;
    std::string source;
    FileFrame frame;  ///< of the model file
    ink::Substrate substrate;
    stroke::Model model;
};
bool is_project_file(const std::filesystem::path& path);
/// Returns the options by which this program opens projects: it waits up to two seconds for another writer and stops on
/// Ctrl-C.
io::OpenOptions open_options(io::Access access, Console& console);
/// Takes the lock of the project `path`, so that another program that holds it is reported before long work. Empty
/// paths are skipped.
std::optional<io::ProjectLock> reserve(const std::filesystem::path& path, Console& console);
/// Returns the model that the strokes of a project are painted on again: the stored one, with a new atlas if asked for,
/// or a revised file, whose frame becomes that of `project`. The stored one is moved out of `project`.
stroke::Model replay_model(const Replay& arguments, OpenProject& project, Console& console);
std::unique_ptr<OpenProject> open_project(const std::filesystem::path& path, io::Access access, Console& console,
                                          const DiskCache& cache = stroke::shared_model_cache());
/// Shows the painting by the project's recolouring, then by the command line's. Notes pigments that other inks share.
void apply_recolouring(const io::Project& project, stroke::Document& painting, const Recolouring& recolouring,
                       Console& console);
/// Brings the painting to the project's last stroke: substrate, presets, strokes.
void restore(const OpenProject& project, stroke::Document& painting, Console& console);

/// Throws `Error` when `at` (metres) is further from the surface than 1/20 of the model's size. `option` names the
/// option that gave the point.
void check_on_surface(const stroke::Model& model, const Vec3& at, const char* option);

/// Writes one JSON object to standard output. File names that are not UTF-8 get replacement characters.
void print_json(const nlohmann::json& json);
nlohmann::json to_json(const stroke::Layer& layer);
nlohmann::json to_json(const mesh::RepairReport& report);
nlohmann::json to_json(const atlas::Atlas& atlas, const atlas::AtlasReport& report);
nlohmann::json to_json(const stroke::StrokeReport& report, const stroke::JournalEntry& stroke);

/// Returns the greatest resident memory of this process so far, MiB.
double peak_megabytes();

}  // namespace tuft::cli
