#include "variants/tolerance_maps.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/files/files.h"
#include "core/text/units.h"
#include "ink/colour/pigments.h"
#include "io/image/image.h"

namespace fs = std::filesystem;

namespace tuft::variants {
namespace {

constexpr std::size_t kLeastSamples = 2;
constexpr int kMapSize = 3;        // widths of a variant's picture
constexpr int kSmallestMap = 480;  // pixels of its width, at a height of 360: the scale has room

/// A decoration and its samples under one tolerance.
struct Group {
    const Row* planned;
    std::vector<const Row*> samples;
};

bool same_decoration(const Task& a, const Task& b) {
    return a.model == b.model && a.strokes == b.strokes && a.ink == b.ink && a.brush == b.brush;
}

/// The samples follow the task that is painted as planned, tolerance by tolerance.
std::vector<Group> groups_of(const std::vector<Row>& rows) {
    std::vector<Group> groups;
    const Row* planned = nullptr;
    const Tolerance* tolerance = nullptr;
    for (const Row& row : rows) {
        if (row.task.sample == 0) {
            planned = &row;
            tolerance = nullptr;
            continue;
        }
        if (!planned || planned->state != TaskState::done || !same_decoration(planned->task, row.task)) continue;
        if (!tolerance || !(*tolerance == row.task.tolerance)) groups.push_back({planned, {}});
        tolerance = &row.task.tolerance;
        if (row.state == TaskState::done) groups.back().samples.push_back(&row);
    }
    std::erase_if(groups, [](const Group& g) { return g.samples.size() < kLeastSamples; });
    return groups;
}

Vec3f body_of(const std::string& substrate) {
    const ink::Substrate s = ink::load_substrate(substrate);
    return {s.reflectance[0], s.reflectance[1], s.reflectance[2]};
}

void write_map(const fs::path& file, const stroke::Model& model, const MapPicture& picture,
               const ProgressFn& progress) {
    const render::Image image = draw_map(model, picture, progress);
    io::write_image(file, io::view_of(image.width, image.height, 3, image.rgb.data()));
}

/// 1, 2 or 5 times a power of ten that is not below `x`.
double round_up(double x) {
    if (!(x > 0)) return 1;
    const double ten = std::pow(10, std::floor(std::log10(x)));
    for (const double step : {1.0, 2.0, 5.0})
        if (step * ten >= x * (1 - 1e-9)) return step * ten;
    return 10 * ten;
}

std::vector<float> only_where(std::vector<float> values, const std::vector<float>& probability, float factor) {
    for (std::size_t i = 0; i < values.size(); ++i)
        values[i] = probability[i] > 0 ? factor * values[i] : std::numeric_limits<float>::quiet_NaN();
    return values;
}

MapRow draw_group(const Jobs& jobs, const Group& group, std::size_t number, const stroke::Model& model,
                  const ProgressFn& progress) {
    ToleranceMap map(model, jobs.coverage(group.planned->index));
    for (const Row* sample : group.samples) map.add(jobs.coverage(sample->index));
    MapRow row;
    row.planned = group.planned->index;
    row.name = group.planned->task.name + " / " + group.samples.front()->task.tolerance.name;
    row.figures = map.figures();
    const MoveFigures& f = row.figures;
    MapPicture picture;
    picture.body = body_of(group.planned->figures.substrate);
    picture.view_deg = group.planned->figures.view_deg;
    picture.around = map.box();
    const PictureChoice& small = group.planned->task.picture;
    picture.width = std::clamp(kMapSize * small.width, kSmallestMap, kLargestPicture);
    picture.height = std::clamp(kMapSize * small.height, kSmallestMap * 3 / 4, kLargestPicture);
    const std::vector<float> probability = map.probability();
    picture.values = only_where(probability, probability, 100);
    picture.unit = "%";
    picture.highest = 100;
    picture.title = fmt::format("ink in part of {} samples: {}", f.samples, row.name);
    row.ink = jobs.folder() / fmt::format("tolerance-map-{:02}-ink.png", number);
    write_map(row.ink, model, picture, progress);
    std::vector<float> moved = map.displacement();
    const float most = *std::max_element(moved.begin(), moved.end());
    picture.values = only_where(std::move(moved), probability, static_cast<float>(1 / kMillimetre));
    picture.unit = "mm";
    picture.highest = round_up(most / kMillimetre);
    picture.title = fmt::format("moved, rms of {} samples: {}", f.samples, row.name);
    row.moved = jobs.folder() / fmt::format("tolerance-map-{:02}-moved.png", number);
    write_map(row.moved, model, picture, progress);
    return row;
}

std::string csv_of(const std::vector<MapRow>& rows) {
    std::string out =
        "planned_task,decoration,samples,planned_mm2,always_mm2,ever_mm2,overlap,moved_rms_mm,moved_95_mm,moved_most_"
        "mm\n";
    for (const MapRow& r : rows) {
        std::string name = "\"";
        for (const char c : r.name) name += c == '"' ? std::string("\"\"") : std::string(1, c);
        const MoveFigures& f = r.figures;
        out += fmt::format("{},{}\",{},{:.6g},{:.6g},{:.6g},{:.4f},{:.4g},{:.4g},{:.4g}\n", r.planned, name, f.samples,
                           f.planned_mm2, f.always_mm2, f.ever_mm2, f.overlap, f.rms_mm, f.most_95_mm, f.most_mm);
    }
    return out;
}

}  // namespace

std::vector<MapRow> write_tolerance_maps(const Jobs& jobs, const std::vector<Row>& rows, const ModelOf& model_of,
                                         const ProgressFn& progress) {
    std::vector<MapRow> maps;
    for (const Group& group : groups_of(rows))
        maps.push_back(draw_group(jobs, group, maps.size() + 1, model_of(group.planned->task), progress));
    std::error_code ec;  // of an earlier, larger plan
    for (std::size_t n = maps.size() + 1; fs::remove(jobs.folder() / fmt::format("tolerance-map-{:02}-ink.png", n), ec);
         ++n)
        fs::remove(jobs.folder() / fmt::format("tolerance-map-{:02}-moved.png", n), ec);
    if (maps.empty()) return maps;
    const std::string csv = csv_of(maps);
    write_file(jobs.folder() / "tolerance.csv", csv.data(), csv.size());
    return maps;
}

}  // namespace tuft::variants
