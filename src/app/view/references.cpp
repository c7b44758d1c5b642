#include "app/view/references.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/hash.h"
#include "io/image/image.h"
#include "stroke/journal/journal.h"

namespace fs = std::filesystem;

namespace tuft::app {

io::Attachment to_attachment(const ReferenceImage& r) {
    const nlohmann::json about{{"name", r.name},   {"x", r.at.x},          {"y", r.at.y},
                               {"width", r.width}, {"opacity", r.opacity}, {"shown", r.shown}};
    return {r.id, about.dump(), r.bytes};
}

ReferenceImage from_attachment(const io::Attachment& attachment) {
    ReferenceImage r{.id = attachment.name, .name = attachment.name, .bytes = attachment.bytes};
    try {
        const nlohmann::json j = nlohmann::json::parse(attachment.about);
        const auto number = [&](const char* key, double lo, double hi, double otherwise) {
            const double value = j.value(key, otherwise);
            return std::isfinite(value) ? std::clamp(value, lo, hi) : otherwise;
        };
        r.name = j.value("name", r.name);
        r.at = {number("x", -0.9, 0.98, r.at.x), number("y", -0.9, 0.98, r.at.y)};
        r.width = number("width", kLeastReference, kMostReference, r.width);
        r.opacity = number("opacity", 0.05, 1, r.opacity);
        r.shown = j.value("shown", true);
    } catch (const nlohmann::json::exception&) {
        // It comes where a new one would.
    }
    return r;
}

ReferenceImage read_reference(const fs::path& file) {
    std::error_code ec;
    if (!fs::is_regular_file(file, ec)) throw Error(file.string(), "is not there, or is no file");
    const std::uintmax_t size = fs::file_size(file, ec);
    if (ec || size > kMostReferenceBytes)
        throw Error(file.string(),
                    Message("is larger than {} MB; scale the image down to pin it", kMostReferenceBytes >> 20));
    std::ifstream in(file, std::ios::binary);
    ReferenceImage r{.name = stroke::group_name(file)};
    r.bytes.assign(std::istreambuf_iterator<char>(in), {});
    if (!in && !in.eof()) throw Error(file.string(), "cannot be read");
    const io::Image8 image = io::decode_image8(r.bytes, file.string(), std::size_t{1} << 26);
    r.pixels_across = image.width;
    r.pixels_down = image.height;
    char id[20];
    std::snprintf(id, sizeof id, "%016llx",
                  static_cast<unsigned long long>(hash_bytes(r.bytes.data(), r.bytes.size())));
    r.id = id;
    return r;
}

}  // namespace tuft::app
