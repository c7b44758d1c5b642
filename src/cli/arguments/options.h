#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/arguments/arguments.h"
#include "core/geometry/bounds.h"
#include "core/text/units.h"

/// \file
/// Options that several commands share. Called by `parse_arguments`. Main thread.

// What help and manual call the value of an option that is a path.
template <>
constexpr const char* CLI::detail::type_name<std::filesystem::path>() {
    return "FILE";
}

namespace tuft::cli {

inline constexpr double kFarthestMm = kFarthest / kMillimetre;
inline constexpr double kMostTexels = 1e9;  // along a side; memory is asked about later
inline constexpr double kLeastTexelMm = 1e-9;
inline constexpr double kMostDegrees = 36000;  // a hundred turns

/// The whole of `text` as a finite number; nothing for anything else.
std::optional<double> number_of(const std::string& text);
/// "A,B[,C]" into numbers within ±`most`; empty when it is anything else.
std::vector<double> numbers(const std::string& text, char separator, std::size_t count, double most);
/// Checks every number of the command line: finite, and from `lo` to `hi`, which the help calls `name`.
CLI::Validator number_in(double lo, double hi, const std::string& name = {});
/// A relative path that leads nowhere is taken from the shipped files (core/files/shipped_file.h). Returns `option`.
CLI::Option* allow_shipped(CLI::Option* option);
void add_common(CLI::App* app, Common& c);
void add_store(CLI::App* app, Surface& s);
void add_reading(CLI::App* app, FileReading& reading, const std::string& what);
void add_surface(CLI::App* app, Surface& s);
void add_cache(CLI::App* app, Surface& s);
CLI::Option* add_point(CLI::App* app, const std::string& name, std::vector<double>& to, const std::string& what);
void add_layers(CLI::App* app, std::vector<std::string>& layers);
void add_recolouring(CLI::App* app, Recolouring& recolouring);
void add_view_direction(CLI::App* app, View& v);
/// Adds `add_view` without the layers.
void add_camera(CLI::App* app, View& v);
void add_view(CLI::App* app, View& v);
/// Adds what `tuft write` takes besides: the text, its characters and its layout.
void add_write_options(CLI::App* app, Write& write);
/// Adds what `tuft paint` takes besides its model, its stroke files and the common options.
void add_paint_options(CLI::App* app, Paint& paint);
/// Recorded strokes as by the pointer of the window.
void add_pointer_options(CLI::App* app, Paint& paint);
/// Adds `tuft device` with its commands.
CLI::App* add_device(CLI::App& app, DeviceWork& device);
/// Adds `tuft decals`.
CLI::App* add_decals(CLI::App& app, Decals& decals);
/// Adds `tuft film`.
CLI::App* add_film(CLI::App& app, Film& film);
/// Adds `tuft trajectory`.
CLI::App* add_trajectory(CLI::App& app, TrajectoryWork& work);
/// Add `tuft variants` and `tuft run-task`.
CLI::App* add_variants(CLI::App& app, VariantsWork& work);
CLI::App* add_run_task(CLI::App& app, RunTask& work);

}  // namespace tuft::cli
