#pragma once

#include <filesystem>

/// \file
/// Files that come with the program, named as from its folder. Any thread.
namespace tuft {

/// Returns `path`; where it is relative and nothing is there, the file of that path in the data folder, if there is
/// one. So the sample strokes find their inks, "samples/inks/indigo-wash.toml", from any working folder. A path that
/// leads out of the data folder is returned as it is.
std::filesystem::path or_shipped(const std::filesystem::path& path);

}  // namespace tuft
