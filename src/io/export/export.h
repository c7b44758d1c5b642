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

/// \file
/// Export of decorated models and their maps for other programs. Called by `cli` and by the studio's paint thread. Any
/// thread; the document that the canvas belongs to must not change meanwhile.
namespace tuft::io {

/// The maps of a decoration, all of one size in texels.
struct ModelMaps {
    ink::AtlasMap<std::uint8_t> base_colour;  ///< sRGB, 3 channels
    ink::AtlasMap<std::uint8_t> orm;          ///< occlusion, roughness, metallic; may be empty
    ink::AtlasMap<float> height;              ///< micrometres; may be empty
    /// Part of the light that passes, 1 channel; empty: no part is of glass.
    ink::AtlasMap<std::uint8_t> transmission = {};
};

/// Composes all maps of a canvas, or of the visible layers of a stack. With `options.seams` gutters continue over
/// seams.
ModelMaps make_maps(const ink::Stack& stack, const atlas::TexelMap& texels, const ink::Substrate& substrate,
                    const ink::ComposeOptions& options = {});

/// Returns the tangent-space normals of a height map, n ∝ (−∂h/∂u, −∂h/∂v, 1), v up, encoded in 8 bits as (n + 1)/2.
/// Heights are in micrometres, `texel_size` is in metres. Slopes are clamped to [−1, 1].
ink::AtlasMap<std::uint8_t> normal_map(const ink::AtlasMap<float>& height, double texel_size);

/// The same normals encoded in 16 bits, and as vectors in [−1, 1].
ink::AtlasMap<std::uint16_t> normal_map16(const ink::AtlasMap<float>& height, double texel_size);
ink::AtlasMap<float> normal_map_float(const ink::AtlasMap<float>& height, double texel_size);

/// Encodes heights (micrometres) in steps of 0.01 µm, at most 655.35 µm.
ink::AtlasMap<std::uint16_t> height16(const ink::AtlasMap<float>& height);

/// Returns the EXR channel name of a pigment. Dots, which separate layers in EXR, become dashes. R, G, B, A, Y and Z
/// get a dash as well, so that no viewer takes them for colours.
std::string channel_name(const std::string& pigment);

/// Options of `export_model`.
struct ExportOptions {
    FileFrame frame;                  ///< of OBJ coordinates; glTF is always in metres, y up
    bool normals_from_height = true;  ///< adds a normal map where the height map is not zero
    /// [n_parts] parts that get the decorated material, as `painted_parts` returns them. The others retain the file's
    /// material, if any. Empty: all parts get it.
    std::vector<std::uint8_t> painted;
    /// [n_parts] parts whose decorated material lets light pass, as `transmitting_parts` returns them; empty: none.
    std::vector<std::uint8_t> transmits = {};
    ProgressFn progress = {};
};

/// Returns for each part of the mesh (mesh::part_of) whether ink lies on it, or whether it has a substrate of its own.
/// Ink is a texel with more than 1e-4 film units of pigment or liquid in a visible layer. Less changes no colour code.
std::vector<std::uint8_t> painted_parts(const ink::Stack& stack, const mesh::TriangleMesh& mesh,
                                        const atlas::Atlas& atlas, const atlas::TexelMap& texels);

/// Returns for each part of the mesh whether the substrate of one of its texels lets light pass.
std::vector<std::uint8_t> transmitting_parts(const ink::Stack& stack, const ink::Substrate& substrate,
                                             const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas,
                                             const atlas::TexelMap& texels);

/// Writes a model with its maps. The extension chooses the format:
///
/// - `.glb`: one binary file in metres, y up: indexed triangles with POSITION, NORMAL, TEXCOORD_0 and, with a normal
///   map, TANGENT; PNG maps in buffer views. A vertex is repeated for each distinct normal or UV. Triangles keep their
///   order within a part.
/// - `.gltf`: the same as NAME.gltf, NAME.bin and NAME_*.png.
/// - `.obj`: NAME.obj, NAME.mtl and NAME_*.png. Coordinates are in `frame`. Vertices keep their order, triangles keep
///   theirs within a part.
/// - `.3mf`: one file in millimetres, in the axes of the mesh: one object with the base colour as texture, for colour
///   printers (export_formats.h).
///
/// Nodes and names are those of the file, else the groups. Parts without ink retain their material with pictures,
/// transparency and extensions. Parts of glass get a decorated material with KHR_materials_transmission: light passes
/// where there is no ink. OBJ and 3MF have no such map and write them opaque, with a note. From a glTF file such parts
/// and all other content are written as they were read. OBJ gets the properties that MTL can express.
///
/// Without maps (all empty) materials retain names and factors and lose the pictures that use the file's UVs.
///
/// Several atlas pages: OBJ gets UVs by the UDIM convention, pictures NAME_*.1001.png … and `<UDIM>` in the MTL. glTF
/// gets one primitive and one material with its own pictures for each page.
///
/// The picture's top row is v = 1 in OBJ and v = 0 in glTF. Existing files are replaced only when all new ones are
/// complete; after a failure no new file remains. Throws `Error` for an unknown extension or unit, for a missing or
/// full folder and for more than 4 GiB in GLB. Returns notes for the user, one line each.
std::vector<Message> export_model(const std::filesystem::path& path, const mesh::TriangleMesh& mesh,
                                  const atlas::Atlas& atlas, const ModelMaps& maps, const ExportOptions& options = {});

/// Returns the paths that `export_model` writes for `path` with these maps, except pictures of the file's own
/// materials.
std::vector<std::filesystem::path> exported_files(const std::filesystem::path& path, const ModelMaps& maps,
                                                  const ExportOptions& options = {}, const atlas::Atlas& atlas = {});

/// Returns the view of one page of a picture of the whole atlas, without a copy.
PixelView page_view(const PixelView& whole, const atlas::Atlas& atlas, std::uint32_t page);
/// Returns `path` with the page's UDIM number before the extension: name.1001.png. With a single page it is `path`.
std::filesystem::path page_path(const std::filesystem::path& path, const atlas::Atlas& atlas, std::uint32_t page);

/// Runs `write(folder)` with a new folder beside `path`, then moves the files made there beside `path`. Throws `Error`;
/// then nothing has changed.
void write_together(const std::filesystem::path& path,
                    const std::function<void(const std::filesystem::path& folder)>& write);

}  // namespace tuft::io
