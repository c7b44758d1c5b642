#include "variants/gather.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "io/image/image.h"
#include "variants/lettering.h"

namespace fs = std::filesystem;

namespace tuft::variants {
namespace {

constexpr std::size_t kMostOnSheet = 60;
constexpr int kMargin = 10, kLettering = 40;  // pixels round a picture, and under it for its name
constexpr std::size_t kMostPixels = std::size_t{kLargestPicture} * std::size_t{kLargestPicture};

std::string word_of(TaskState state) {
    return state == TaskState::done ? "done" : state == TaskState::failed ? "failed" : "open";
}

std::string csv_field(const std::string& text) {
    if (text.find_first_of(",\"\n") == std::string::npos) return text;
    std::string out = "\"";
    for (const char c : text) out += c == '"' ? std::string("\"\"") : std::string(1, c);
    return out + "\"";
}

void put_picture(render::BrushCanvas& sheet, const io::Image8& picture, const Vec2& corner) {
    const auto x0 = static_cast<int>(corner.x), y0 = static_cast<int>(corner.y);
    const int channels = std::min(3, picture.channels);
    for (int y = 0; y < picture.height && y0 + y < sheet.height; ++y)
        for (int x = 0; x < picture.width && x0 + x < sheet.width; ++x)
            for (int c = 0; c < 3; ++c) {
                const std::size_t from = (static_cast<std::size_t>(y) * picture.width + x) * picture.channels;
                sheet.rgb[(static_cast<std::size_t>(y0 + y) * sheet.width + x0 + x) * 3 + c] =
                    ink::linear_of_code()[picture.pixels[from + std::min(c, channels - 1)]];
            }
}

/// Number and name of a variant in two lines; `at` is the lower left corner of its picture.
void name_picture(render::BrushCanvas& sheet, const Row& row, const Vec2& at, int width) {
    const LetteringOptions options{.size = 11, .width = width - 4.0};
    const std::string text = fmt::format("{} {}", row.index, row.task.name);
    const std::string_view first = first_line(text, options);
    letter(sheet, first, at + Vec2(0, 17), options);
    if (first.size() < text.size())
        letter(sheet, std::string_view(text).substr(first.size() + 1), at + Vec2(0, 33), options);
}

void write_sheet(const Jobs& jobs, const std::vector<const Row*>& rows, const fs::path& file) {
    int width = 1, height = 1;
    for (const Row* row : rows) {
        width = std::max(width, row->task.picture.width);
        height = std::max(height, row->task.picture.height);
    }
    const int n = static_cast<int>(rows.size());
    // About as wide as a screen.
    const int columns = std::clamp(static_cast<int>(std::lround(std::sqrt(1.6 * n * height / width))), 1, n);
    const int lines = (n + columns - 1) / columns, dx = width + kMargin, dy = height + kLettering + kMargin;
    render::BrushCanvas sheet(columns * dx + kMargin, lines * dy + kMargin, Vec3(1));
    for (int i = 0; i < n; ++i) {
        const Vec2 corner(kMargin + (i % columns) * dx, kMargin + (i / columns) * dy);
        put_picture(sheet, io::read_image8(jobs.picture(rows[i]->index), kMostPixels), corner);
        name_picture(sheet, *rows[i], corner + Vec2(2, height), width);
    }
    io::write_image(file, io::view_of(sheet.width, sheet.height, 3, render::to_srgb(sheet).data()));
}

}  // namespace

std::vector<Row> gather(const Jobs& jobs) {
    std::vector<Row> rows(jobs.size());
    for (std::size_t i = 0; i < rows.size(); ++i) {
        Row& row = rows[i];
        row.index = i;
        row.task = jobs.task(i);
        row.state = jobs.state(i);
        if (row.state == TaskState::failed) row.fault = jobs.failure(i);
        if (row.state != TaskState::done) continue;
        try {
            row.figures = jobs.figures(i);
        } catch (const Error&) {
            row.state = TaskState::open;
            row.fault = "its result is damaged";
        }
    }
    return rows;
}

std::string csv_of(const Jobs& jobs, const std::vector<Row>& rows) {
    std::string out =
        "task,hash,name,model,strokes_file,ink,brush,tolerance,sample,state,canvas_hash,ink_area_mm2,ink_mm3,strokes,"
        "dry,mismatches,unconverged,seconds,fault\n";
    for (const Row& r : rows) {
        const Task& t = r.task;
        const Figures& f = r.figures;
        out += fmt::format("{},{},{},{},{},{},{},{},{},{}", r.index, jobs.hash(r.index), csv_field(t.name),
                           csv_field(t.model.file), csv_field(t.strokes), csv_field(t.ink), csv_field(t.brush),
                           csv_field(t.tolerance.name), t.sample, word_of(r.state));
        out += r.state == TaskState::done
                   ? fmt::format(",{},{:.6g},{:.6g},{},{},{},{},{:.3f},\n", f.canvas_hash, f.ink_area_mm2, f.ink_mm3,
                                 f.strokes, f.dry, f.mismatches, f.unconverged, f.seconds)
                   : fmt::format(",,,,,,,,,{}\n", csv_field(r.fault));
    }
    return out;
}

std::string json_of(const Jobs& jobs, const std::vector<Row>& rows) {
    nlohmann::json j{{"name", jobs.name()}, {"variants", nlohmann::json::array()}};
    for (const Row& r : rows) {
        nlohmann::json row{{"task", r.index},
                           {"hash", jobs.hash(r.index)},
                           {"name", r.task.name},
                           {"model", r.task.model.file},
                           {"strokes_file", r.task.strokes},
                           {"ink", r.task.ink},
                           {"brush", r.task.brush},
                           {"tolerance", r.task.tolerance.name},
                           {"sample", r.task.sample},
                           {"state", word_of(r.state)}};
        const Figures& f = r.figures;
        if (r.state == TaskState::done)
            row.update({{"canvas_hash", f.canvas_hash},
                        {"ink_area_mm2", f.ink_area_mm2},
                        {"ink_mm3", f.ink_mm3},
                        {"strokes", f.strokes},
                        {"dry", f.dry},
                        {"mismatches", f.mismatches},
                        {"unconverged", f.unconverged},
                        {"seconds", f.seconds}});
        if (!r.fault.empty()) row["fault"] = r.fault;
        j["variants"].push_back(std::move(row));
    }
    return j.dump(1, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

std::vector<fs::path> write_contact_sheets(const Jobs& jobs, const std::vector<Row>& rows, const ProgressFn& progress) {
    std::vector<const Row*> done;
    for (const Row& row : rows)
        if (row.state == TaskState::done && jobs.has_picture(row.index)) done.push_back(&row);
    const std::size_t n = (done.size() + kMostOnSheet - 1) / kMostOnSheet;
    std::vector<fs::path> files;
    for (std::size_t s = 0; s < n; ++s) {
        report(progress, "contact sheets", static_cast<double>(s) / static_cast<double>(n));
        const auto from = done.begin() + static_cast<std::ptrdiff_t>(s * kMostOnSheet);
        const auto to = done.begin() + static_cast<std::ptrdiff_t>(std::min(done.size(), (s + 1) * kMostOnSheet));
        files.push_back(jobs.folder() / fmt::format("contact-sheet-{:02}.png", s + 1));
        write_sheet(jobs, {from, to}, files.back());
    }
    std::error_code ec;  // of an earlier, larger plan
    for (std::size_t s = n; fs::remove(jobs.folder() / fmt::format("contact-sheet-{:02}.png", s + 1), ec); ++s) {
    }
    return files;
}

}  // namespace tuft::variants
