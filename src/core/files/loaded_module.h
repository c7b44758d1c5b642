#pragma once

#include <filesystem>
#include <string>

/// \file
/// Modules of this program, each with a library that is loaded on first use: `tuft_images` (OpenImageIO), `tuft_draco`
/// and `tuft_colour` (OpenColorIO). Called by `io` and `ink`. Any thread.
namespace tuft {

/// What was found of a module, or why not.
struct ModuleSymbol {
    void* symbol = nullptr;
    std::string fault, tried;  ///< the system's words; the places looked at
};

/// Loads the module `name` ("libtuft_images.so") from beside the program, from the installed folder or from `built`,
/// where the build puts it, and returns the address of its function `symbol`. What the module links stays out of the
/// symbols of this program. A module stays loaded.
ModuleSymbol find_in_module(const std::string& name, const std::filesystem::path& built, const char* symbol);

}  // namespace tuft
