#include "app/document/pictures/pictures.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "app/document/pictures/state_folder.h"
#include "io/image/image.h"
#include "io/model/read_model.h"
#include "io/project/project.h"
#include "mesh/repair/inspect.h"
#include "mesh/repair/repair.h"
#include "render/picture/picture.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr std::size_t kMostPixels = std::size_t{1} << 26;  // of a picture that a small one is made of

// Averages whole boxes of pixels; the picture is cut to the shape wanted.
std::vector<std::uint8_t> shrink(int width, int height, const std::vector<std::uint8_t>& rgb) {
    constexpr int w = Pictures::kWidth, h = Pictures::kHeight;
    const double step = std::min(static_cast<double>(width) / w, static_cast<double>(height) / h);
    const double left = 0.5 * (width - step * w), top = 0.5 * (height - step * h);
    std::vector<std::uint8_t> out(static_cast<std::size_t>(3 * w * h));
    for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) {
            const int x0 = static_cast<int>(left + step * x),
                      x1 = std::max(x0 + 1, static_cast<int>(left + step * (x + 1)));
            const int y0 = static_cast<int>(top + step * y),
                      y1 = std::max(y0 + 1, static_cast<int>(top + step * (y + 1)));
            for (int k = 0; k < 3; ++k) {
                int sum = 0, n = 0;
                for (int j = y0; j < std::min(y1, height); ++j)
                    for (int i = x0; i < std::min(x1, width); ++i, ++n)
                        sum += rgb[static_cast<std::size_t>(3 * (j * width + i) + k)];
                out[static_cast<std::size_t>(3 * (y * w + x) + k)] = static_cast<std::uint8_t>(n ? sum / n : 0);
            }
        }
    return out;
}

}  // namespace

Pictures::Pictures() : thread_([this] { run(); }) {}

Pictures::~Pictures() {
    {
        const std::lock_guard lock(mutex_);
        quit_ = true;
        stop_ = true;
    }
    wake_.notify_all();
    thread_.join();
}

unsigned Pictures::texture(const fs::path& file) {
    const std::lock_guard lock(mutex_);
    Picture& p = pictures_[file.string()];
    if (!p.requested && !stop_) {
        p.requested = true;
        jobs_.push_back({.file = file.string()});
        wake_.notify_all();
    }
    if (p.fresh) {
        p.fresh = false;
        if (!p.texture) glGenTextures(1, &p.texture);
        glBindTexture(GL_TEXTURE_2D, p.texture);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, kWidth, kHeight, 0, GL_RGB, GL_UNSIGNED_BYTE, p.rgb.data());
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    }
    return p.texture;
}

void Pictures::keep(const fs::path& file, int width, int height, std::vector<std::uint8_t> rgb) {
    const std::lock_guard lock(mutex_);
    pictures_[file.string()].requested = true;
    jobs_.push_front({file.string(), width, height, std::move(rgb)});
    wake_.notify_all();
}

void Pictures::pause() {
    const std::lock_guard lock(mutex_);
    stop_ = true;
    for (const Job& job : jobs_)
        if (job.rgb.empty()) pictures_[job.file].requested = false;
    std::erase_if(jobs_, [](const Job& job) { return job.rgb.empty(); });
}

bool Pictures::busy() const {
    const std::lock_guard lock(mutex_);
    return working_ || !jobs_.empty();
}

void Pictures::release() {
    const std::lock_guard lock(mutex_);
    for (auto& [file, picture] : pictures_)
        if (picture.texture) glDeleteTextures(1, &picture.texture);
    pictures_.clear();
}

std::vector<std::uint8_t> Pictures::make(const Job& job) {
    const fs::path kept = picture_path(job.file);
    std::error_code ec;
    if (!job.rgb.empty()) {
        std::vector<std::uint8_t> rgb = shrink(job.width, job.height, job.rgb);
        io::write_image(kept, io::view_of(kWidth, kHeight, 3, rgb.data()));
        return rgb;
    }
    const bool newer = fs::exists(kept, ec) && (fs::path(job.file).extension() == ".tuft" ||
                                                fs::last_write_time(kept, ec) >= fs::last_write_time(job.file, ec));
    if (newer) {
        const io::Image8 image = io::read_image8(kept, std::size_t{1} << 22);
        if (image.channels >= 3 && image.width == kWidth && image.height == kHeight) {
            std::vector<std::uint8_t> rgb;
            for (std::size_t i = 0; i < image.pixels.size(); i += static_cast<std::size_t>(image.channels))
                rgb.insert(rgb.end(), {image.pixels[i], image.pixels[i + 1], image.pixels[i + 2]});
            return rgb;
        }
    }
    if (const std::string e = fs::path(job.file).extension().string();
        e == ".png" || e == ".jpg" || e == ".jpeg" || e == ".tif" || e == ".tiff" || e == ".exr") {
        const io::Image8 image = io::read_image8(job.file, kMostPixels);
        std::vector<std::uint8_t> rgb;
        for (std::size_t i = 0; i < image.pixels.size(); i += static_cast<std::size_t>(image.channels))
            for (int k = 0; k < 3; ++k)
                rgb.push_back(image.pixels[i + static_cast<std::size_t>(image.channels < 3 ? 0 : k)]);
        return shrink(image.width, image.height, rgb);
    }
    const ProgressFn progress = [this](std::string_view, double) { return !stop_.load(); };
    mesh::TriangleMesh mesh;
    if (fs::path(job.file).extension() == ".tuft") {
        mesh = io::Project::open(job.file, {.access = io::Access::read, .progress = progress}).model().mesh;
    } else {
        mesh::RepairOptions repair;
        repair.progress = progress;
        mesh = mesh::build_surface(io::read_model(job.file), repair).mesh;
    }
    const mesh::SurfaceQuery query(mesh);
    render::PictureOptions options;
    options.width = 2 * kWidth;
    options.height = 2 * kHeight;
    options.edge_samples = 8;
    options.light_samples = 8;
    options.view.margin = 0.06;
    options.progress = progress;
    const render::Image image = render::render_picture(mesh, query, {}, options);
    std::vector<std::uint8_t> rgb = shrink(image.width, image.height, image.rgb);
    io::write_image(kept, io::view_of(kWidth, kHeight, 3, rgb.data()));
    return rgb;
}

void Pictures::run() {
    for (;;) {
        Job job;
        {
            std::unique_lock lock(mutex_);
            working_ = false;
            wake_.wait(lock, [this] { return quit_ || !jobs_.empty(); });
            if (quit_ && std::all_of(jobs_.begin(), jobs_.end(), [](const Job& j) { return j.rgb.empty(); })) return;
            job = std::move(jobs_.front());
            jobs_.pop_front();
            if (quit_ && job.rgb.empty()) continue;
            working_ = true;
        }
        std::vector<std::uint8_t> rgb;
        bool again = false;
        try {
            rgb = make(job);
        } catch (const Cancelled&) {
            again = true;
        } catch (const std::exception&) {
            // A file without a picture is shown by its name.
        }
        const std::lock_guard lock(mutex_);
        Picture& p = pictures_[job.file];
        if (again) p.requested = false;
        if (rgb.empty()) continue;
        p.rgb = std::move(rgb);
        p.fresh = true;
    }
}

}  // namespace tuft::app
