#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "atlas/texels/texel_map.h"
#include "core/hash.h"
#include "io/project/project.h"
#include "paths.h"
#include "stroke/document/document.h"
#include "stroke/journal/tables.h"

/// What the studio kept, asked of the file and of the command line.
namespace tuft::test {

/// What `tuft ARGUMENTS --json` prints; `out` is a file it may write.
inline nlohmann::json tuft(const std::string& arguments, const std::string& out) {
    const std::string line = "TUFT_DATA='" + source_folder() + "' '" + tuft_program() + "' " + arguments +
                             " --json >'" + out + "' 2>/dev/null";
    EXPECT_EQ(std::system(line.c_str()), 0) << arguments;
    std::ifstream in(out);
    return nlohmann::json::parse(in);
}

/// Hash of the texels of all layers as the studio left them in a project, as stroke::LayerStack::hash makes it; ""
/// where none are stored.
inline std::string stored_hash(const std::string& project) {
    const io::Project p = io::Project::open(project);
    const io::ProjectModel model = p.model();
    const auto saved = p.load_canvases(atlas::build_texel_map(model.mesh, model.atlas).n_slots());
    if (!saved) return "";
    const std::vector<stroke::Layer> table = stroke::layers_after(p.strokes()).layers;
    std::uint64_t hash = 0;
    for (const stroke::Layer& layer : table) {
        const auto stored = std::ranges::find(saved->layers, layer.id, &stroke::LayerCanvas::layer);
        // Of a layer without ink nothing is stored.
        const std::uint64_t part[] = {layer.id,
                                      stored == saved->layers.end() ? ink::Canvas().hash() : stored->canvas.hash()};
        hash = table.size() == 1 ? part[1] : hash_bytes(part, sizeof part, hash);
    }
    char text[20];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(hash));
    return text;
}

}  // namespace tuft::test
