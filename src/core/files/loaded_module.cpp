#include "core/files/loaded_module.h"

#include <dlfcn.h>

#include <vector>

#include "core/files/files.h"

namespace fs = std::filesystem;

namespace tuft {

ModuleSymbol find_in_module(const std::string& name, const fs::path& built, const char* symbol) {
    std::vector<fs::path> places;
    std::error_code ec;
    const fs::path program = fs::read_symlink("/proc/self/exe", ec).parent_path();
    if (!ec) {
        places.push_back(program / name);
        places.push_back(program.parent_path() / "lib" / "tuft" / name);
        places.push_back(program.parent_path() / TUFT_LIBDIR / "tuft" / name);
    }
    const fs::path prefix = data_folder().parent_path().parent_path();  // of an installed share/tuft
    places.push_back(prefix / TUFT_LIBDIR / "tuft" / name);
    places.push_back(built);
    ModuleSymbol found;
    for (const fs::path& place : places) {
        found.tried += (found.tried.empty() ? "" : ", ") + place.string();
        if (!fs::exists(place, ec)) continue;
        void* module = dlopen(place.c_str(), RTLD_LAZY | RTLD_LOCAL);
        if (!module) {
            found.fault = dlerror();
            continue;
        }
        found.symbol = dlsym(module, symbol);
        if (found.symbol) return found;
        found.fault = "it has no " + std::string(symbol);
    }
    return found;
}

}  // namespace tuft
