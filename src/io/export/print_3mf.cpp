#include "io/export/print_3mf.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "core/error.h"
#include "core/files/files.h"
#include "core/system/parallel.h"
#include "core/text/xml_text.h"
#include "ink/composite/match.h"
#include "ink/spectra/colorimetry.h"
#include "io/export/export_formats.h"
#include "io/package/zip_writer.h"

namespace tuft::io {
namespace {

constexpr double kMm = 1000;  // millimetres per metre
constexpr std::size_t kMostTriangles = std::size_t{1} << 24;

// The parts of the package that every model needs.
void add_package(ZipWriter& zip, bool png) {
    zip.add(
        "[Content_Types].xml",
        fmt::format("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Types "
                    "xmlns=\"http://schemas.openxmlformats.org/package/2006/content-types\">\n <Default "
                    "Extension=\"rels\" ContentType=\"application/vnd.openxmlformats-package.relationships+xml\"/>\n "
                    "<Default Extension=\"model\" ContentType=\"application/vnd.ms-package.3dmanufacturing-3dmodel+"
                    "xml\"/>\n{}</Types>\n",
                    png ? " <Default Extension=\"png\" ContentType=\"image/png\"/>\n" : ""));
    zip.add("_rels/.rels",
            std::string("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Relationships "
                        "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n <Relationship "
                        "Target=\"/3D/3dmodel.model\" Id=\"rel0\" "
                        "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel\"/>\n</Relationships>\n"));
}

std::string model_begin() {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<model unit=\"millimeter\" xml:lang=\"en-US\" "
           "xmlns=\"http://schemas.microsoft.com/3dmanufacturing/core/2015/02\" "
           "xmlns:m=\"http://schemas.microsoft.com/3dmanufacturing/material/2015/02\" "
           "xmlns:slic3rpe=\"http://schemas.slic3r.org/3mf/2017/06\">\n"
           " <metadata name=\"Application\">tuft</metadata>\n <resources>\n";
}

std::string model_end(int object) {
    return fmt::format(
        "</triangles>\n  </mesh></object>\n </resources>\n <build><item objectid=\"{}\"/></build>\n</model>\n", object);
}

template <class Point>
void append_vertices(std::string& out, const std::vector<Point>& positions) {
    out += "<vertices>\n";
    for (const Point& p : positions)
        fmt::format_to(std::back_inserter(out), "<vertex x=\"{:.9g}\" y=\"{:.9g}\" z=\"{:.9g}\"/>\n", kMm * double{p.x},
                       kMm * double{p.y}, kMm * double{p.z});
    out += "</vertices>\n<triangles>\n";
}

/// Code of a triangle that is painted whole with filament 1 … 16, as PrusaSlicer's TriangleSelector writes it.
std::string slicer_code(std::uint32_t filament) {
    const std::uint32_t state = filament + 1;
    return state < 3 ? fmt::format("{:X}", 4 * state) : fmt::format("{:X}C", state - 3);
}

/// A triangle while it is halved.
struct Facet {
    std::array<std::uint32_t, 3> v{};
    std::array<Vec2, 3> uv{};
    ink::FilamentChoice choice;
    double area = 0;     // m²
    bool mixed = false;  // samples would get different filaments
};

class FilamentSubdivision {
  public:
    FilamentSubdivision(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas, const ink::AtlasMap<float>& colour,
                        const PaintOptions& options)
        : colour_(colour), options_(options) {
        for (const Vec3f& p : mesh.positions) positions_.emplace_back(p);
        for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
            Facet facet{.v = mesh.triangles[t]};
            for (std::size_t k = 0; k < 3; ++k) facet.uv[k] = Vec2(atlas.corner_uvs[3 * t + k]);
            facets_.push_back(facet);
        }
        for (const ink::Filament& f : options.filaments)
            printed_.push_back(ink::colour_of_wall(f, options.filaments.front(), options.wall));
    }

    PaintedTriangles run() {
        choose(0);
        while (halve()) report(options_.progress, "filaments", 0.5);
        PaintedTriangles out;
        double sum = 0, area = 0;
        for (const Facet& f : facets_) {
            out.triangles.push_back(f.v);
            out.filament.push_back(static_cast<std::uint32_t>(f.choice.filament));
            sum += f.area * f.choice.delta_e;
            area += f.area;
        }
        out.positions = std::move(positions_);
        out.mean_delta_e = area > 0 ? sum / area : 0;
        return out;
    }

  private:
    /// Linear sRGB of the texel at a UV.
    ink::Rgb colour_at(const Vec2& uv) const {
        const double size = colour_.size;
        const auto texel = [&](double v) {
            return static_cast<std::size_t>(std::clamp(std::floor(v * size), 0.0, size - 1));
        };
        const float* c = &colour_.texels[3 * (texel(uv.y) * colour_.size + texel(uv.x))];
        return {c[0], c[1], c[2]};
    }

    void choose(std::size_t from) {
        parallel_for(facets_.size() - from, 256, [&](std::size_t begin, std::size_t end) {
            std::vector<ink::ColourPatch> patches;
            for (std::size_t i = from + begin; i < from + end; ++i) choose(facets_[i], patches);
        });
    }

    void choose(Facet& f, std::vector<ink::ColourPatch>& patches) const {
        constexpr double kMostSide = 20;  // points along an edge
        const Vec3 a = positions_[f.v[0]];
        f.area = 0.5 * glm::length(glm::cross(positions_[f.v[1]] - a, positions_[f.v[2]] - a));
        double longest = 0;
        for (std::size_t k = 0; k < 3; ++k)
            longest = std::max(longest, glm::length(f.uv[(k + 1) % 3] - f.uv[k]) * static_cast<double>(colour_.size));
        // n² congruent triangles; one sample in the middle of each.
        const int n = static_cast<int>(std::clamp(std::ceil(longest), 1.0, kMostSide));
        patches.clear();
        const auto add = [&](double s, double t) {
            patches.push_back({colour_at(f.uv[0] + s / n * (f.uv[1] - f.uv[0]) + t / n * (f.uv[2] - f.uv[0])), 1});
        };
        for (int i = 0; i < n; ++i)
            for (int j = 0; i + j < n; ++j) {
                add(i + 1 / 3.0, j + 1 / 3.0);
                if (i + j + 1 < n) add(i + 2 / 3.0, j + 2 / 3.0);
            }
        f.choice = ink::choose_filament(patches, printed_);
        f.mixed = false;
        for (const ink::ColourPatch& patch : patches) {
            if (patch.colour == patches.front().colour) continue;
            f.mixed |= ink::choose_filament({&patch, 1}, printed_).filament != f.choice.filament;
            if (f.mixed) break;
        }
    }

    static std::uint64_t edge_of(std::uint32_t a, std::uint32_t b) {
        return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
    }

    /// Halves all edges of mixed triangles that are longer than the detail. Returns false when there are none.
    bool halve() {
        if (facets_.size() > kMostTriangles / 4) return false;
        std::unordered_map<std::uint64_t, std::uint32_t> middle;
        for (const Facet& f : facets_)
            for (std::size_t k = 0; f.mixed && k < 3; ++k) {
                const std::uint32_t a = f.v[k], b = f.v[(k + 1) % 3];
                if (glm::length(positions_[a] - positions_[b]) <= options_.detail) continue;
                const auto [at, is_new] =
                    middle.try_emplace(edge_of(a, b), static_cast<std::uint32_t>(positions_.size()));
                if (is_new) positions_.push_back(0.5 * (positions_[std::min(a, b)] + positions_[std::max(a, b)]));
            }
        if (middle.empty()) return false;
        std::vector<Facet> kept, cut;
        for (const Facet& f : facets_) split(f, middle, kept, cut);
        const std::size_t from = kept.size();
        facets_ = std::move(kept);
        facets_.insert(facets_.end(), cut.begin(), cut.end());
        choose(from);
        return true;
    }

    /// Cuts a triangle along the middles of its halved edges into two, three or four.
    static void split(const Facet& f, const std::unordered_map<std::uint64_t, std::uint32_t>& middle,
                      std::vector<Facet>& kept, std::vector<Facet>& cut) {
        std::array<std::uint32_t, 6> v{f.v[0], f.v[1], f.v[2], kNone, kNone, kNone};  // corners, middles of k … k+1
        std::array<Vec2, 6> uv{f.uv[0], f.uv[1], f.uv[2]};
        std::size_t halved = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const auto at = middle.find(edge_of(f.v[k], f.v[(k + 1) % 3]));
            if (at == middle.end()) continue;
            v[3 + k] = at->second;
            uv[3 + k] = 0.5 * (f.uv[k] + f.uv[(k + 1) % 3]);
            ++halved;
        }
        if (halved == 0) return kept.push_back(f);
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            cut.push_back({.v = {v[a], v[b], v[c]}, .uv = {uv[a], uv[b], uv[c]}});
        };
        if (halved == 3) {
            add(0, 3, 5), add(3, 1, 4), add(5, 4, 2), add(3, 4, 5);
            return;
        }
        // Turned so that edge 0 → 1 is halved and, of two, 1 → 2 is too.
        for (std::size_t k = 0; k < 3; ++k) {
            const std::size_t a = k, b = (k + 1) % 3, c = (k + 2) % 3, ab = 3 + a, bc = 3 + b, ca = 3 + c;
            if (v[ab] == kNone || (halved == 2 && v[ca] != kNone)) continue;
            if (halved == 1) {
                add(a, ab, c), add(ab, b, c);
            } else {
                add(ab, b, bc), add(a, ab, bc), add(a, bc, c);
            }
            return;
        }
    }

    const ink::AtlasMap<float>& colour_;
    const PaintOptions& options_;
    std::vector<ink::Rgb> printed_;
    std::vector<Vec3> positions_;
    std::vector<Facet> facets_;
};

/// Textures of a package: of page p the picture has the id 2 p + 1, its UVs the next.
struct TexturedPages {
    std::string resources, relations;  ///< XML
    std::vector<std::uint32_t> index;  ///< [n_wedges] of its UV on its page
};

TexturedPages add_textures(ZipWriter& zip, const ExportScene& scene, std::span<const EncodedMap> maps) {
    TexturedPages out;
    std::vector<std::string> uvs(scene.udims.size());
    std::vector<std::uint32_t> count(uvs.size(), 0);
    for (const std::uint32_t corner : scene.wedges.corner) {
        const std::uint32_t page = scene.page_of(corner / 3);
        out.index.push_back(count[page]++);
        fmt::format_to(std::back_inserter(uvs[page]), "<m:tex2coord u=\"{:.9g}\" v=\"{:.9g}\"/>\n",
                       scene.corner_uvs[corner].x, scene.corner_uvs[corner].y);
    }
    for (const EncodedMap& map : maps) {
        if (map.kind != "base_colour" || uvs[map.page].empty()) continue;
        const std::string name = fmt::format("3D/Textures/{}", map.file);
        zip.add(name, std::span<const std::uint8_t>(map.png), ZipWriter::Method::stored);
        out.relations += fmt::format(
            " <Relationship Target=\"/{}\" Id=\"rel{}\" "
            "Type=\"http://schemas.microsoft.com/3dmanufacturing/2013/01/3dtexture\"/>\n",
            name, map.page);
        out.resources += fmt::format(
            "  <m:texture2d id=\"{0}\" path=\"/{2}\" contenttype=\"image/png\" tilestyleu=\"clamp\" "
            "tilestylev=\"clamp\"/>\n  <m:texture2dgroup id=\"{1}\" texid=\"{0}\">\n{3}  </m:texture2dgroup>\n",
            2 * map.page + 1, 2 * map.page + 2, name, uvs[map.page]);
    }
    return out;
}

}  // namespace

PaintedTriangles paint_triangles(const mesh::TriangleMesh& mesh, const atlas::Atlas& atlas,
                                 const ink::AtlasMap<float>& colour, const PaintOptions& options) {
    if (options.filaments.empty() || options.filaments.size() > ink::kMostFilaments)
        throw Error(Message("there must be 1 to {} filaments", ink::kMostFilaments));
    return FilamentSubdivision(mesh, atlas, colour, options).run();
}

void write_painted_3mf(const std::filesystem::path& path, const PaintedTriangles& painted,
                       std::span<const ink::Filament> filaments, bool closed) {
    std::string model = model_begin();
    model += "  <basematerials id=\"1\">\n";
    for (const ink::Filament& f : filaments) {
        std::string hex = ink::to_hex(f.colour);
        std::transform(hex.begin(), hex.end(), hex.begin(), [](unsigned char c) { return std::toupper(c); });
        model += fmt::format("   <base name=\"{}\" displaycolor=\"{}\"/>\n", xml_text(f.name), hex);
    }
    model +=
        fmt::format("  </basematerials>\n  <object id=\"2\" name=\"{}\" type=\"{}\" pid=\"1\" pindex=\"0\"><mesh>\n",
                    xml_text(safe_stem(path)), closed ? "model" : "surface");
    append_vertices(model, painted.positions);
    for (std::size_t t = 0; t < painted.triangles.size(); ++t) {
        const auto& v = painted.triangles[t];
        const std::uint32_t f = painted.filament[t];
        fmt::format_to(std::back_inserter(model), "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\"", v[0], v[1], v[2]);
        if (f > 0)
            fmt::format_to(std::back_inserter(model), " pid=\"1\" p1=\"{0}\" slic3rpe:mmu_segmentation=\"{1}\"", f,
                           slicer_code(f));
        model += "/>\n";
    }
    model += model_end(2);
    ZipWriter zip;
    add_package(zip, false);
    zip.add("3D/3dmodel.model", model);
    const std::vector<std::uint8_t> bytes = zip.finish();
    write_file(path, bytes.data(), bytes.size());
}

void write_3mf(const std::filesystem::path& path, const ExportScene& scene, std::span<const EncodedMap> maps) {
    const mesh::TriangleMesh& mesh = scene.mesh;
    const bool closed = std::find(mesh.neighbours.begin(), mesh.neighbours.end(), kNone) == mesh.neighbours.end();
    ZipWriter zip;
    add_package(zip, true);
    const TexturedPages pages = add_textures(zip, scene, maps);
    std::string model = model_begin() + pages.resources;
    const int object = static_cast<int>(2 * scene.udims.size() + 1);
    const std::uint32_t first = scene.page_of(0);
    model += fmt::format("  <object id=\"{}\" name=\"{}\" type=\"{}\" pid=\"{}\" pindex=\"0\"><mesh>\n", object,
                         xml_text(scene.name), closed ? "model" : "surface", 2 * first + 2);
    append_vertices(model, mesh.positions);
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t) {
        const auto& v = mesh.triangles[t];
        const auto p = [&](std::size_t k) { return pages.index[scene.wedges.corner_wedge[3 * t + k]]; };
        fmt::format_to(std::back_inserter(model),
                       "<triangle v1=\"{}\" v2=\"{}\" v3=\"{}\" pid=\"{}\" p1=\"{}\" p2=\"{}\" p3=\"{}\"/>\n", v[0],
                       v[1], v[2], 2 * scene.page_of(t) + 2, p(0), p(1), p(2));
    }
    model += model_end(object);
    zip.add("3D/3dmodel.model", model);
    zip.add("3D/_rels/3dmodel.model.rels",
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<Relationships "
            "xmlns=\"http://schemas.openxmlformats.org/package/2006/relationships\">\n" +
                pages.relations + "</Relationships>\n");
    const std::vector<std::uint8_t> bytes = zip.finish();
    write_staged(path, bytes.data(), bytes.size());
}

}  // namespace tuft::io
