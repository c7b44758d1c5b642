#pragma once

#include <string>
#include <utility>
#include <vector>

/// \file
/// What this build of tuft is made of, for `--version`, the About dialog and reports of faults.
/// CMake fills it in when it configures the build.
namespace tuft {

struct BuildFacts {
    std::string version;     ///< of tuft, "0.1.0"
    std::string released;    ///< day of this version, "2026-11-25"
    std::string commit;      ///< of the sources, as whoever built it said; empty: not said
    std::string compiler;    ///< "GNU 12.2.0"
    std::string build_type;  ///< "Release"
    std::string system;      ///< "Linux x86_64"
    std::vector<std::pair<std::string, std::string>> libraries;  ///< name and version, as they were compiled against
};

const BuildFacts& build_facts();

}  // namespace tuft
