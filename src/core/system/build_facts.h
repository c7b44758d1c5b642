#pragma once

#include <string>
#include <utility>
#include <vector>

/// \file
/// Versions of tuft, its compiler and its libraries, for `--version`, the About dialog and fault reports. CMake
/// fills the data when it configures the build.
namespace tuft {

/// How this program was built.
struct BuildFacts {
    std::string version;     ///< of tuft, "0.1.0"
    std::string released;    ///< day of this version, "2026-11-25"
    std::string commit;      ///< of the sources, as given to CMake; empty: not given
    std::string compiler;    ///< "GNU 12.2.0"
    std::string build_type;  ///< "Release"
    std::string system;      ///< "Linux x86_64"
    std::vector<std::pair<std::string, std::string>> libraries;  ///< name and version at compile time
};

/// Returns the facts of this program.
const BuildFacts& build_facts();

}  // namespace tuft
