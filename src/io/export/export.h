#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "atlas/atlas.h"
#include "atlas/texels/texel_map.h"
#include "core/message.h"
#include "core/system/progress.h"
#include "core/text/units.h"
#include "ink/composite/composite.h"
#include "io/image/image.h"
#include "mesh/triangle_mesh.h"

/// Decorated models for other programs.
namespace tuft::io {

/// The maps of a decoration, all of one size.
struct ModelMaps {
    ink::AtlasMap<std::uint8_t> base_colour;  ///< sRGB, 3 channels
    ink::AtlasMap<std::uint8_t> orm;          ///< occlusion, roughness, metallic; may be empty
    ink::AtlasMap<float> height;              ///< micrometres; may be empty
};

/// All maps of what is seen of a canvas or of layers; `options.seams` makes their gutters continue over seams.
ModelMaps make_maps(const ink::Stack& stack, const atlas::TexelMap& texels, const ink::Substrate& substrate,
                    const ink::ComposeOptions& options = {});

/// Tangent-space normals of a height map (micrometres over texels of `texel_size` metres):
/// n ∝ (−∂h/∂u, −∂h/∂v, 1), v up, encoded as 8 bit (n + 1)/2; slopes are cut at 1.
ink::AtlasMap<std::uint8_t> normal_map(const ink::AtlasMap<float>& height, double texel_size);

/// The same with 16 bits a channel, and as plain vectors in [−1, 1].
ink::AtlasMap<std::uint16_t> normal_map16(const ink::AtlasMap<float>& height, double texel_size);
ink::AtlasMap<float> normal_map_float(const ink::AtlasMap<float>& height, double texel_size);

/// Micrometres in steps of 0.01 µm, at most 655.35.
ink::AtlasMap<std::uint16_t> height16(const ink::AtlasMap<float>& height);

/// A pigment's name as that of an EXR channel: dots, which part layers there, become dashes;
/// R, G, B, A, Y and Z get a dash too, so that no viewer takes them for colours.
std::string channel_name(const std::string& pigment);

struct ExportOptions {
    FileFrame frame;                  ///< of OBJ coordinates; glTF is always in metres, y up
    bool normals_from_height = true;  ///< a normal map when there is a height map with any height
    /// [n_parts] parts that get the decorated material (`painted_parts`); the others keep what the file
    /// gave them, where it gave them any. Empty: all get it.
    std::vector<std::uint8_t> painted;
    ProgressFn progress = {};
};

/// Whether ink lies on a part of the mesh (mesh::part_of), for each part: whether one of its texels has
/// pigment or liquid in a layer that is seen, more than 1e-4 film units, which no code of a colour shows.
std::vector<std::uint8_t> painted_parts(const ink::Stack& stack, const mesh::TriangleMesh& mesh,
                                        const atlas::Atlas& atlas, const atlas::TexelMap& texels);

/// Writes a model with its maps; the extension chooses the format:
///
/// - `.glb`: one binary file; metres, y up, indexed triangles with POSITION, NORMAL,
///   TEXCOORD_0 and (with a normal map) TANGENT; PNG maps in buffer views. A vertex is
///   repeated for each distinct normal or UV, triangles keep their order within a part.
/// - `.gltf`: the same as NAME.gltf, NAME.bin and NAME_*.png.
/// - `.obj`: NAME.obj, NAME.mtl and NAME_*.png; coordinates in `frame`;
///   vertices in their order, triangles in their order within a part.
///
/// Nodes and names are those of the file, or the groups. Parts without ink keep their material with its
/// pictures, transparency and extensions. Out of a glTF file they, and whatever else it holds, are
/// written as they were read; OBJ takes of their materials what MTL has words for.
///
/// Without maps (all of them empty) materials keep their names and factors, and lose the pictures that lay by
/// the UVs of the file.
///
/// An atlas of several pages: OBJ gets UVs by the UDIM convention, pictures NAME_*.1001.png and
/// so on, and `<UDIM>` in their names in the MTL; glTF gets a primitive and a material with its
/// own pictures for each page.
///
/// UVs are written so that the picture's top row is v = 1 in OBJ and v = 0 in glTF, as
/// those formats say. Nothing is left behind when anything fails; existing files are
/// replaced only when all new ones are complete. Throws `Error` for an unknown
/// extension or unit, a folder that does not exist or is full, more than 4 GiB in GLB.
/// Returns what a user should know of it, one line each.
std::vector<Message> export_model(const std::filesystem::path& path, const mesh::TriangleMesh& mesh,
                                  const atlas::Atlas& atlas, const ModelMaps& maps, const ExportOptions& options = {});

/// Names of the files `export_model` writes for `path` with these maps, but for pictures of the file's own
/// materials.
std::vector<std::filesystem::path> exported_files(const std::filesystem::path& path, const ModelMaps& maps,
                                                  const ExportOptions& options = {}, const atlas::Atlas& atlas = {});

/// One page of a picture of the whole atlas; no copy.
PixelView page_view(const PixelView& whole, const atlas::Atlas& atlas, std::uint32_t page);
/// `path` with the page's UDIM number before the extension: name.1001.png. With one page, `path`.
std::filesystem::path page_path(const std::filesystem::path& path, const atlas::Atlas& atlas, std::uint32_t page);

/// Runs `write(folder)` with a fresh folder beside `path`, then moves the files made in it
/// beside `path`. On any error nothing has changed and `Error` is thrown.
void write_together(const std::filesystem::path& path,
                    const std::function<void(const std::filesystem::path& folder)>& write);

}  // namespace tuft::io
