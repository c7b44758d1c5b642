#pragma once

#include <filesystem>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments.h"
#include "cli/console.h"
#include "io/project/project.h"
#include "render/picture/picture.h"
#include "stroke/document/document.h"

/// Steps that several commands share.
namespace tuft::cli {

/// What the arguments say of the model file, else `otherwise`.
FileFrame frame_of(const std::string& unit, const std::string& up, const FileFrame& otherwise = {});

/// Atlas and UV options in the terms of `stroke`.
stroke::ModelOptions model_options(const Surface& surface, Console& console);

/// A model and how its file was read.
struct Loaded {
    stroke::Model model;
    FileFrame frame;
};

/// Reads, repairs and unwraps a model file. Where neither the arguments nor the format say its
/// unit, it is guessed from the size; a guess other than millimetres is reported.
Loaded load_model(const std::filesystem::path& path, const Surface& surface, Console& console);

/// The same without an atlas and without what finds points of the surface.
Loaded load_bare(const std::filesystem::path& path, const std::string& unit, const std::string& up, Console& console);

/// Throws `Error` when a file could not be written there: its folder is missing or not
/// writable. Called before long work. Empty paths are fine.
void check_output(const std::filesystem::path& path);
/// Throws `UsageError` when the extension is none of `allowed` (".glb", ...).
void check_extension(const std::filesystem::path& path, const std::vector<std::string>& allowed);

/// Strokes of InkML and SVG files in order, with brush and ink filled in where the file names none; each file is a
/// group, numbered from 1.
std::vector<stroke::JournalEntry> load_strokes(const Paint& arguments, Console& console);

/// Has only the layers of these names seen; throws `UsageError` for a name that is not there.
void show_layers(stroke::Document& painting, const std::vector<std::string>& names);

/// What every painting command can leave behind; empty paths are skipped.
struct Outputs {
    std::filesystem::path project, exported, preview;
    View view;
    FileFrame frame;
};
void check_outputs(const Outputs& outputs);
/// Exported model and preview; the project is written while painting.
void write_outputs(const Outputs& outputs, const stroke::Document& painting, Console& console);

/// Picture of a painted model, or of a bare one (canvas == nullptr).
render::Image draw_picture(const stroke::Model& model, const stroke::Document* painting, const std::string& material,
                           const View& view, int turntable_frame, int turntable_count, Console& console);

void write_picture(const std::filesystem::path& path, const render::Image& image);

/// A new project with the model and the presets of these strokes; strokes are appended
/// to it as they are finished.
/// Throws `Error` for a brush or ink that there is none of, before any paint flows.
void find_presets(stroke::Document& painting, const std::vector<stroke::JournalEntry>& strokes);
/// Stores the presets that these entries use.
void put_presets(io::Project& project, stroke::Document& painting, const std::vector<stroke::JournalEntry>& strokes);
io::Project start_project(const std::filesystem::path& path, const std::string& source, const FileFrame& frame,
                          stroke::Document& painting, const std::vector<stroke::JournalEntry>& strokes);

/// A project with its model ready to be painted on.
struct OpenProject {
    io::Project file;
    std::string source;
    FileFrame frame;  ///< of the model file
    ink::Substrate substrate;
    stroke::Model model;
};
bool is_project_file(const std::filesystem::path& path);
/// How this program opens projects: another one that changes it may end within two seconds; Ctrl-C is heard.
io::OpenOptions open_options(io::Access access, Console& console);
/// The right to write `path`, held while it lives, so that another program that has it is
/// reported before long work, not after it; empty paths are fine.
std::optional<io::ProjectLock> reserve(const std::filesystem::path& path, Console& console);
std::unique_ptr<OpenProject> open_project(const std::filesystem::path& path, io::Access access, Console& console);
/// Shows the painting as the project and then the command line say; notes pigments that
/// other inks share.
void apply_recolouring(const io::Project& project, stroke::Document& painting, const Recolouring& recolouring,
                       Console& console);
/// Brings the painting to where the project stands: substrate, presets, strokes.
void restore(const OpenProject& project, stroke::Document& painting, Console& console);

/// Throws `Error` when `at` (metres) lies further beside the surface than a twentieth of the model: then it is another
/// point that was meant. `option` gave it.
void check_on_surface(const stroke::Model& model, const Vec3& at, const char* option);

/// One JSON object on standard output. Names of files that are not UTF-8 get a replacement character.
void print_json(const nlohmann::json& json);
nlohmann::json to_json(const mesh::RepairReport& report);
nlohmann::json to_json(const atlas::Atlas& atlas, const atlas::AtlasReport& report);
nlohmann::json to_json(const stroke::StrokeReport& report, const stroke::JournalEntry& stroke);

/// Greatest resident memory of this process so far, MiB.
double peak_megabytes();

}  // namespace tuft::cli
