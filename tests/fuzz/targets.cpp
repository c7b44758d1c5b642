#include "targets.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "brush/preset/preset.h"
#include "fuzz_paint.h"
#include "importer.h"
#include "ink/colour/pigments.h"
#include "ink/colour/presets.h"
#include "io/gltf/read_gltf.h"
#include "io/image/image.h"
#include "io/model/read_3mf.h"
#include "io/model/read_vrml.h"
#include "io/model/read_x3d.h"
#include "io/motion/motion_files.h"
#include "io/project/project.h"
#include "io/scene/file_scene.h"
#include "io/strokes/inkml.h"
#include "io/svg/svg.h"
#include "mesh/repair/repair.h"
#include "promise.h"
#include "stroke/gesture/bias_correction.h"
#include "stroke/journal/entry/entry_json.h"
#include "variants/plan.h"

namespace tuft::fuzz {
namespace {

using Input = std::span<const std::uint8_t>;

std::vector<char> chars_of(Input input) {
    return {input.begin(), input.end()};
}
std::string text_of(Input input) {
    return {input.begin(), input.end()};
}

/// A folder of this process alone, where files may be looked for and none are.
class EmptyFolder {
  public:
    EmptyFolder() { std::filesystem::create_directories(path); }
    ~EmptyFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path, ignored);
    }
    EmptyFolder(const EmptyFolder&) = delete;
    EmptyFolder& operator=(const EmptyFolder&) = delete;

    const std::filesystem::path path =
        std::filesystem::path(std::filesystem::is_directory("/dev/shm") ? "/dev/shm"
                                                                        : std::filesystem::temp_directory_path()) /
        ("tuft_fuzz_" + std::to_string(::getpid()));
};
const std::filesystem::path& empty_folder() {
    static const EmptyFolder folder;
    return folder.path;
}

template <class V>
bool finite(const V& v) {
    for (int k = 0; k < V::length(); ++k)
        if (!std::isfinite(v[k])) return false;
    return true;
}

void check_surface(const mesh::Surface& surface) {
    const mesh::TriangleMesh& m = surface.mesh;
    promise(m.n_triangles() > 0, "a surface has triangles");
    for (const Vec3f& p : m.positions) promise(finite(p), "positions are finite");
    for (const auto& triangle : m.triangles)
        for (const std::uint32_t v : triangle) promise(v < m.n_vertices(), "triangles use vertices that are there");
    for (std::size_t i = 0; i < m.neighbours.size(); ++i)
        promise(m.neighbours[i] == kNone || m.neighbours[i] < m.n_triangles(), "neighbours are there");
    for (const Vec3f& n : m.corner_normals)
        promise(finite(n) && std::abs(glm::length(n) - 1) < 1e-3f, "normals are of length 1");
    for (const std::uint32_t g : m.triangle_groups) promise(g < m.group_names.size(), "groups are there");
}

template <mesh::PolygonSoup (*Read)(const std::vector<char>&, const std::filesystem::path&)>
void run_mesh(Input input) {
    refusing([&] { check_surface(mesh::build_surface(Read(chars_of(input), empty_folder() / "input"))); });
}

/// An importer, then what `read_import` makes of what it hands over.
template <const char* Format>
void run_import(Input input) {
    const std::vector<char> packed = import_in_child(Format, input);
    if (packed.empty()) return;
    refusing([&] {
        check_surface(mesh::build_surface(io::soup_of(io::unpack_scene(packed, "input"), empty_folder() / "input")));
    });
}
constexpr char kFbx[] = "fbx", kDae[] = "dae", kStp[] = "stp", kIgs[] = "igs";

/// What an importer hands over to this process.
void run_scene(Input input) {
    refusing([&] {
        io::FileScene scene = io::unpack_scene(chars_of(input), "input");
        check_surface(mesh::build_surface(io::soup_of(std::move(scene), empty_folder() / "input")));
    });
}

void check_traces(const std::vector<stroke::RecordedStroke>& traces) {
    for (const stroke::RecordedStroke& trace : traces) {
        stroke::check_samples(trace);
        double last = -HUGE_VAL;
        for (const stroke::StrokeSample& s : trace.samples) {
            promise(s.time >= last, "time never falls");
            promise(s.pressure >= 0 && s.pressure <= 1, "pressures are parts");
            last = s.time;
        }
    }
}

constexpr std::size_t kMostSamples = 20'000;

void run_inkml(Input input) {
    const io::InkmlOptions options{.max_samples = kMostSamples, .actions = true};
    std::vector<stroke::RecordedStroke> traces;
    refusing([&] { traces = io::parse_inkml(text_of(input), "input.inkml", options); });
    check_traces(traces);  // what a reader lets through, a project takes
    if (traces.empty()) return;
    const std::string written = io::inkml_text(traces);
    const std::vector<stroke::RecordedStroke> again = io::parse_inkml(written, "again.inkml", options);
    promise(again.size() == traces.size(), "what is written is read again");
}

void run_svg(Input input) {
    // Filling a shape with lines of a brush takes milliseconds, masking it microseconds: of eight inputs two are filled
    // with lines, one of them finely, by their length.
    const std::size_t kind = input.size() % 8;
    const io::SvgOptions options{.painting = kind == 0 || kind == 4 ? io::SvgPainting::brush : io::SvgPainting::areas,
                                 .tolerance = kind == 0 ? 2e-5 : 2e-4,
                                 .ink = {.max_samples = kind == 0 ? kMostSamples : 1000}};
    std::vector<stroke::RecordedStroke> traces;
    refusing([&] { traces = io::parse_svg(text_of(input), "input.svg", options); });
    check_traces(traces);
}

void run_brush(Input input) {
    refusing([&] {
        const brush::Preset preset = brush::parse_preset(text_of(input), "input.toml");
        const std::string text = brush::preset_toml(preset);
        promise(brush::preset_toml(brush::parse_preset(text, "again.toml")) == text,
                "a brush that is written is read again");
    });
}

void run_ink(Input input) {
    refusing([&] {
        const ink::Ink ink = ink::parse_ink(text_of(input), "input.toml");
        const std::string text = ink::ink_toml(ink);
        promise(ink::ink_toml(ink::parse_ink(text, "again.toml")) == text, "an ink that is written is read again");
    });
}

void run_substrate(Input input) {
    refusing([&] {
        const std::string text = ink::substrate_toml(ink::parse_substrate(text_of(input), "input.toml"));
        promise(ink::substrate_toml(ink::parse_substrate(text, "again.toml")) == text,
                "a substrate that is written is read again");
    });
}

void run_bias(Input input) {
    refusing([&] {
        const stroke::BiasCorrection bias = stroke::parse_bias(text_of(input), "input.toml");
        stroke::parse_bias(stroke::bias_toml(bias), "again.toml");
    });
}

void run_plan(Input input) {
    refusing([&] { variants::parse_plan(text_of(input), "input.toml", "/"); });
}

void run_task(Input input) {
    refusing([&] {
        const variants::Task task = variants::task_of_json(text_of(input), "input.json");
        promise(variants::task_of_json(variants::json_of(task), "again.json") == task, "a task is read again");
    });
}

void run_trajectory(Input input) {
    refusing([&] {
        for (const stroke::RecordedStroke& s : io::parse_trajectory_csv(text_of(input), "input.csv"))
            promise(!s.flat && !s.samples.empty(), "a stroke of a trajectory has places in space");
    });
}

void run_entry(Input input) {
    refusing([&] {
        const std::string text = stroke::entry_json(stroke::entry_of({}, text_of(input)));
        promise(stroke::entry_json(stroke::entry_of({}, text)) == text, "an entry that is written is read again");
    });
}

void run_image(Input input) {
    // OpenEXR takes and clears 64 MB for each file: of those, one of four is read, by its length.
    constexpr std::uint8_t kExr[] = {0x76, 0x2f, 0x31, 0x01};
    if (input.size() % 8 < 6 && input.size() > 4 && std::equal(kExr, kExr + 4, input.begin())) return;
    refusing([&] {
        const io::Image8 image = io::decode_image8(chars_of(input), "input", std::size_t{1} << 14);
        promise(image.pixels.size() == static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) *
                                           static_cast<std::size_t>(image.channels),
                "a picture has all its pixels");
    });
}

void run_project(Input input) {
    const std::filesystem::path file = empty_folder() / "input.tuft";
    std::filesystem::remove(file.string() + "-journal");
    std::ofstream(file, std::ios::binary | std::ios::trunc)
        .write(reinterpret_cast<const char*>(input.data()), static_cast<std::streamsize>(input.size()));
    refusing([&] {
        const io::Project project = io::Project::open(file);
        project.format();
        project.written_by();
        project.brushes();
        project.inks();
        project.recolours();
        const io::ProjectModel model = project.model();
        const std::vector<stroke::JournalEntry> strokes = project.strokes();
        for (const stroke::JournalEntry& s : strokes) stroke::check_samples(stroke::samples_of(s));
        for (const std::size_t slots : {std::size_t{1}, std::size_t{4}, std::size_t{16}}) project.load_canvases(slots);
    });
}

constexpr Target kTargets[] = {
    {"ply", run_mesh<mesh::read_ply>, 3000, true},
    {"stl", run_mesh<mesh::read_stl>, 3000, true},
    {"obj", run_mesh<mesh::read_obj>, 3000, true},
    {"off", run_mesh<mesh::read_off>, 3000, true},
    {"gltf", run_mesh<io::read_gltf>, 1500, true},
    {"fbx", run_import<kFbx>, 1500, false},
    {"dae", run_import<kDae>, 1500, true},
    {"stp", run_import<kStp>, 300, true},
    {"igs", run_import<kIgs>, 300, true},
    {"scene", run_scene, 2000, false},
    {"3mf", run_mesh<io::read_3mf>, 1500, false},
    {"x3d", run_mesh<io::read_x3d>, 1500, true},
    {"wrl", run_mesh<io::read_vrml>, 1500, true},
    {"svg", run_svg, 1000, true},
    {"inkml", run_inkml, 2000, true},
    {"brush", run_brush, 3000, true},
    {"ink", run_ink, 3000, true},
    {"substrate", run_substrate, 3000, true},
    {"bias", run_bias, 3000, true},
    {"plan", run_plan, 3000, true},
    {"trajectory", run_trajectory, 3000, true},
    {"task", run_task, 3000, true},
    {"entry", run_entry, 3000, true},
    {"project", run_project, 500, false},
    {"image", run_image, 500, false},
    {"paint", run_paint, 10, false},
};

}  // namespace

std::span<const Target> targets() {
    return kTargets;
}

const Target* find_target(const char* name) {
    for (const Target& target : kTargets)
        if (std::strcmp(target.name, name) == 0) return &target;
    return nullptr;
}

}  // namespace tuft::fuzz
