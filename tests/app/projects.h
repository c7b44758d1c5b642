#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "atlas/texel_map.h"
#include "io/project.h"

/// What the studio kept, asked of the file and of the command line.
namespace tuft::test {

/// What `tuft ARGUMENTS --json` prints; `out` is a file it may write.
inline nlohmann::json tuft(const std::string& arguments, const std::string& out) {
    const std::string line = "TUFT_DATA='" TUFT_SOURCE "' '" TUFT_PROGRAM "' " + arguments +
                             " --json >'" + out + "' 2>/dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << arguments;
    std::ifstream in(out);
    return nlohmann::json::parse(in);
}

/// Hash of the texels as the studio left them in a project.
inline std::string stored_hash(const std::string& project) {
    const io::Project p = io::Project::open(project);
    const io::ProjectModel model = p.model();
    const auto saved = p.load_canvas(atlas::build_texel_map(model.mesh, model.atlas).n_slots());
    if (!saved) return "";
    char text[20];
    std::snprintf(text, sizeof text, "%016llx",
                  static_cast<unsigned long long>(saved->canvas.hash()));
    return text;
}

}  // namespace tuft::test
