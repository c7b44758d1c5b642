#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

/// \file
/// One variant of a decoration as plain data, and its fingerprint. `plan.h` makes tasks, `jobs.h` stores them, `cli`
/// paints them. Any thread.
namespace tuft::variants {

inline constexpr std::size_t kMostTasks = 100'000;
inline constexpr int kMostSamples = 10'000;
inline constexpr int kLargestPicture = 2048;  ///< pixels

/// A model file and how it is read.
struct ModelChoice {
    std::string file;              ///< as `find_input` takes it
    std::string unit, up;          ///< as --unit and --up; empty: by the file
    std::uint32_t atlas_size = 0;  ///< texels; 0: the default

    bool operator==(const ModelChoice&) const = default;
};

/// Where flat strokes go.
struct PlacementChoice {
    std::vector<double> at_mm;  ///< [3], or empty
    std::string side;           ///< stroke::side_name, or empty
    double width_mm = 0;        ///< 0: as in the file
    double turn_deg = 0;
    std::string mapping;  ///< drape, wrap, project; empty: the default

    bool operator==(const PlacementChoice&) const = default;
};

/// Spread of placements and hands: standard deviations of independent normal numbers (deviation.h).
struct Tolerance {
    std::string name;
    double shift_mm = 0;         ///< 0–1000, of the placement, along each axis
    double turn_deg = 0;         ///< 0–90, of the placement
    double scale = 0;            ///< 0–0.2, of the size, relative
    double hand_mm = 0;          ///< 0–1000, of the hand's path, along each axis
    double hand_length_mm = 10;  ///< 0.01–10,000, correlation length of `hand_mm` along the path
    double pressure = 0;         ///< 0–1, of each stroke's pressure, relative

    bool operator==(const Tolerance&) const = default;
};

/// Which variants get a picture, and from where.
struct PictureChoice {
    std::string of = "all";          ///< all, planned (those without deviation), none
    int width = 320, height = 240;   ///< pixels
    std::vector<double> view_deg{};  ///< [2] azimuth and elevation; empty: the side that the strokes are on
    double zoom = 1;                 ///< 1: the whole model; else that many times as large, about the drawing

    /// Whether the picture of this sample is drawn.
    bool has(int sample) const { return of == "all" || (of == "planned" && sample == 0); }

    bool operator==(const PictureChoice&) const = default;
};

/// How strokes are painted; words as those of `tuft paint`.
struct PaintingChoice {
    std::string substrate = "porcelain";
    std::string film = "still";  ///< still, wet
    std::string dip = "each";    ///< each, persistent (in tasks of earlier versions: carry), endless
    bool fit_brush = false;      ///< a size that suits the drawing

    bool operator==(const PaintingChoice&) const = default;
};

/// One variant. All that its result depends on is in it, or is a file whose hash is in it.
struct Task {
    std::string name;  ///< unique in its plan, for people
    ModelChoice model;
    std::string strokes;     ///< file
    std::string ink, brush;  ///< empty: those of the stroke file
    PaintingChoice painting;
    PlacementChoice placement;
    Tolerance tolerance;     ///< with an empty name: painted as planned
    int sample = 0;          ///< number of the deviation, from 1; 0: none
    std::uint64_t seed = 0;  ///< of the deviation
    PictureChoice picture;
    std::string program;                          ///< version of tuft that it is for
    std::map<std::string, std::string> contents;  ///< hash of each file and preset

    bool operator==(const Task&) const = default;
};

/// The version of this program, as `Task::program`.
std::string program_version();

/// Throws `Error` for values out of range; `source` names the file that they are from.
void check_task(const Task& task, const std::string& source);

/// A task as JSON text, and back. Back throws `Error` for a text that is no task, and where `check_task` does.
std::string json_of(const Task& task);
Task task_of_json(const std::string& text, const std::string& source);

/// Returns 32 hexadecimal digits of a 128-bit hash of the task's JSON text: its fingerprint.
std::string hash_of(const Task& task);

/// Returns the path of a file that a plan names: inside `folder`, or where it has no such file a shipped model or
/// stroke file. Throws `Error` for absolute names, for names that leave the folder, also by links, and for files that
/// are not there.
std::filesystem::path find_input(const std::filesystem::path& folder, const std::string& name);

/// Returns the hash of a file's bytes. Throws `Error` where it cannot be read.
std::string content_hash(const std::filesystem::path& file);

/// Hashes by the names that `Task::contents` gives them.
using ContentHashes = std::map<std::string, std::string>;

/// Returns the hashes of model, strokes, ink and brush as they are now. Those in `known` are taken from there, others
/// are added to it. Throws `Error` for one that is missing, and for presets with a fault.
ContentHashes contents_of(const Task& task, const std::filesystem::path& folder, ContentHashes& known);

}  // namespace tuft::variants
