#include "io/export/export_layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <pugixml.hpp>
#include <set>
#include <sstream>

#include "core/error.h"
#include "core/files/files.h"
#include "core/system/parallel.h"
#include "io/export/export.h"
#include "io/export/export_maps.h"
#include "io/image/icc_profile.h"
#include "io/image/image.h"
#include "io/package/zip_writer.h"

namespace fs = std::filesystem;

namespace tuft::io {
namespace {

/// A layer with what is below it.
struct Level {
    const stroke::Layer* layer = nullptr;
    bool shown = true;
    ink::LayerView view;
};

std::vector<Level> levels_of(const stroke::Document& painting) {
    const std::vector<stroke::LayerTexels> shown = painting.appearance().shown_layers();
    std::vector<Level> levels;
    for (const stroke::LayerTexels& texels : painting.layers().canvases()) {
        const stroke::Layer& layer = painting.layers().layer(texels.layer);
        const bool is = std::ranges::find(shown, texels.layer, &stroke::LayerTexels::layer) != shown.end();
        levels.push_back({&layer, is, {texels.canvas, static_cast<float>(layer.opacity), layer.blend}});
    }
    return levels;
}

bool multiplies(const Level& level) {
    return level.view.blend != ink::Blend::normal;
}

/// Colour and alpha of one texel, 0–1.
struct Texel {
    std::array<float, 3> colour{};
    float alpha = 0;
};

/// The least alpha with which a colour in [0, 1] over `below` gives `with`; `part` is what a reader multiplies alpha
/// by.
template <class Colour>
Texel texel_over(const Colour& below, const Colour& with, float part) {
    Texel t;
    for (std::size_t c = 0; c < 3; ++c) {
        const float d = with[c] - below[c], room = d > 0 ? 1 - below[c] : below[c];
        if (d != 0) t.alpha = std::max(t.alpha, room > 0 ? std::abs(d) / room : 1.0f);
    }
    t.alpha = std::min(t.alpha / part, 1.0f);
    return t;
}

/// The same for with = below (1 − α + α c).
template <class Colour>
Texel texel_multiplied(const Colour& below, const Colour& with, float part) {
    Texel t;
    for (std::size_t c = 0; c < 3; ++c)
        if (below[c] > 0) t.alpha = std::max(t.alpha, 1 - with[c] / below[c]);
    t.alpha = std::clamp(t.alpha / part, 0.0f, 1.0f);
    return t;
}

std::uint8_t code_of(float v) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(v, 0.0f, 1.0f)));
}

/// The picture of a layer in 8 bits. Alpha is rounded up and the colour found for it, so that the mean code stays.
ink::AtlasMap<std::uint8_t> layer_picture(const ink::AtlasMap<std::uint8_t>& below,
                                          const ink::AtlasMap<std::uint8_t>& with, const Level& level) {
    const std::size_t n = std::size_t{below.size} * below.size;
    ink::AtlasMap<std::uint8_t> out{below.size, 4, std::vector<std::uint8_t>(4 * n, 0)};
    const bool multiply = multiplies(level);
    const float part = level.view.opacity;
    parallel_for(n, 1 << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint8_t *b8 = &below.texels[3 * i], *w8 = &with.texels[3 * i];
            if (std::equal(b8, b8 + 3, w8)) continue;
            std::array<float, 3> b, w;
            for (std::size_t c = 0; c < 3; ++c) {
                b[c] = static_cast<float>(b8[c]) / 255;
                w[c] = static_cast<float>(w8[c]) / 255;
            }
            const Texel t = multiply ? texel_multiplied(b, w, part) : texel_over(b, w, part);
            const auto alpha = static_cast<std::uint8_t>(std::ceil(255 * t.alpha - 1e-4f));
            if (alpha == 0) continue;
            const float a = part * static_cast<float>(alpha) / 255;
            for (std::size_t c = 0; c < 3; ++c) {
                const float over = b[c] + (w[c] - b[c]) / a;
                const float filter = b[c] > 0 ? 1 - (1 - w[c] / b[c]) / a : 1;
                out.texels[4 * i + c] = code_of(multiply ? filter : over);
            }
            out.texels[4 * i + 3] = alpha;
        }
    });
    return out;
}

ink::AtlasMap<std::uint8_t> opaque(const ink::AtlasMap<std::uint8_t>& rgb) {
    ink::AtlasMap<std::uint8_t> out{rgb.size, 4, {}};
    out.texels.reserve(rgb.texels.size() / 3 * 4);
    for (std::size_t i = 0; i < rgb.texels.size(); i += 3)
        out.texels.insert(out.texels.end(), {rgb.texels[i], rgb.texels[i + 1], rgb.texels[i + 2], 255});
    return out;
}

/// At most 256 pixels along a side: means of squares of texels.
Image8 thumbnail_of(const PixelView& picture) {
    const int step = (picture.width + 255) / 256, side = picture.width / step;
    Image8 out{side, side, 4, std::vector<std::uint8_t>(static_cast<std::size_t>(side) * side * 4)};
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            for (int c = 0; c < 4; ++c) {
                int sum = 0;
                for (int j = 0; j < step; ++j)
                    for (int i = 0; i < step; ++i)
                        sum += *(static_cast<const std::uint8_t*>(picture.first) + (y * step + j) * picture.row_bytes +
                                 4 * (x * step + i) + c);
                out.pixels[(static_cast<std::size_t>(y) * side + static_cast<std::size_t>(x)) * 4 +
                           static_cast<std::size_t>(c)] = static_cast<std::uint8_t>(sum / (step * step));
            }
    return out;
}

/// One page of an OpenRaster file while it is made; layers come from the lowest up.
class RasterPage {
  public:
    RasterPage(const atlas::Atlas& atlas, std::uint32_t page, ink::ColourSpace space) : atlas_(atlas), page_(page) {
        zip_.add("mimetype", std::string("image/openraster"), ZipWriter::Method::stored);
        options_.icc_profile = icc_profile(space);
        const std::string side = std::to_string(atlas.page_size());
        image_ = xml_.append_child("image");
        image_.append_attribute("version") = "0.0.6";
        image_.append_attribute("w") = side.c_str();
        image_.append_attribute("h") = side.c_str();
        stack_ = image_.append_child("stack");
    }

    void add(const ink::AtlasMap<std::uint8_t>& rgba, const std::string& name, float opacity, bool visible,
             bool multiply) {
        const std::string source = fmt::format("data/layer{:03}.png", count_++);
        zip_.add(source, png(rgba), ZipWriter::Method::stored);
        pugi::xml_node node = stack_.prepend_child("layer");  // the topmost comes first
        node.append_attribute("name") = name.c_str();
        node.append_attribute("src") = source.c_str();
        node.append_attribute("x") = "0";
        node.append_attribute("y") = "0";
        node.append_attribute("opacity") = fmt::format("{:.6g}", opacity).c_str();
        node.append_attribute("visibility") = visible ? "visible" : "hidden";
        node.append_attribute("composite-op") = multiply ? "svg:multiply" : "svg:src-over";
    }
    void write(const fs::path& path, const ink::AtlasMap<std::uint8_t>& merged) {
        std::ostringstream text;
        xml_.save(text, " ");
        zip_.add("stack.xml", text.str());
        zip_.add("mergedimage.png", png(merged), ZipWriter::Method::stored);
        const Image8 thumbnail = thumbnail_of(page_view(view_of(merged), atlas_, page_));
        zip_.add("Thumbnails/thumbnail.png", png_bytes(view_of(thumbnail), options_), ZipWriter::Method::stored);
        const std::vector<std::uint8_t> bytes = zip_.finish();
        write_file(page_path(path, atlas_, page_), bytes.data(), bytes.size());
    }

  private:
    std::vector<unsigned char> png(const ink::AtlasMap<std::uint8_t>& rgba) const {
        return png_bytes(page_view(view_of(rgba), atlas_, page_), options_);
    }

    const atlas::Atlas& atlas_;
    std::uint32_t page_;
    ZipWriter zip_;
    ImageOptions options_;
    pugi::xml_document xml_;
    pugi::xml_node image_, stack_;
    int count_ = 0;
};

void write_raster(const fs::path& path, const stroke::Document& painting, const ink::ComposeOptions& compose) {
    if (ink::data_of(compose.space).linear)
        throw Error(path.string(), "OpenRaster has 8 bits, too few for linear colours: take srgb or display-p3");
    const stroke::Model& model = painting.model();
    const ink::Substrate& substrate = painting.appearance().substrate();
    ink::Stack stack{std::vector<ink::LayerView>{}};
    stack.base_colour = painting.appearance().stack().base_colour;
    const auto picture = [&] { return ink::compose_srgb8(stack, model.texels, substrate, compose); };
    ink::AtlasMap<std::uint8_t> below = picture();
    std::vector<std::unique_ptr<RasterPage>> pages;
    for (std::uint32_t page = 0; page < model.atlas.pages; ++page) {
        pages.push_back(std::make_unique<RasterPage>(model.atlas, page, compose.space));
        pages.back()->add(opaque(below), substrate.name, 1, true, false);
    }
    for (const Level& level : levels_of(painting)) {
        // A layer of no opacity is pictured as it would be seen.
        Level pictured = level;
        if (!(level.view.opacity > 0)) pictured.view.opacity = 1;
        stack.layers.push_back(pictured.view);
        ink::AtlasMap<std::uint8_t> with = picture();
        const ink::AtlasMap<std::uint8_t> own = layer_picture(below, with, pictured);
        for (const auto& page : pages)
            page->add(own, level.layer->name, level.view.opacity, level.shown, multiplies(level));
        if (level.shown)
            below = std::move(with);
        else
            stack.layers.pop_back();
    }
    const ink::AtlasMap<std::uint8_t> merged = opaque(below);
    for (std::uint32_t page = 0; page < model.atlas.pages; ++page) pages[page]->write(path, merged);
}

/// Appends four channels to every texel of a map.
void append_channels(ink::AtlasMap<float>& to, const std::vector<Texel>& texels) {
    const auto n = static_cast<std::size_t>(to.channels);
    std::vector<float> out;
    out.reserve(texels.size() * (n + 4));
    for (std::size_t i = 0; i < texels.size(); ++i) {
        const auto old = to.texels.begin() + static_cast<std::ptrdiff_t>(n * i);
        out.insert(out.end(), old, old + static_cast<std::ptrdiff_t>(n));
        for (const float c : texels[i].colour) out.push_back(texels[i].alpha * c);
        out.push_back(texels[i].alpha);
    }
    to.texels = std::move(out);
    to.channels += 4;
}

std::vector<Texel> layer_texels(const ink::AtlasMap<float>& below, const ink::AtlasMap<float>& with) {
    std::vector<Texel> texels(std::size_t{below.size} * below.size);
    parallel_for(texels.size(), 1 << 14, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::span<const float, 3> b(&below.texels[3 * i], 3), w(&with.texels[3 * i], 3);
            texels[i] = texel_over(b, w, 1);
            for (std::size_t c = 0; c < 3 && texels[i].alpha > 0; ++c)
                texels[i].colour[c] = std::clamp(b[c] + (w[c] - b[c]) / texels[i].alpha, 0.0f, 1.0f);
        }
    });
    return texels;
}

std::vector<Texel> opaque_texels(const ink::AtlasMap<float>& rgb) {
    std::vector<Texel> texels(std::size_t{rgb.size} * rgb.size);
    for (std::size_t i = 0; i < texels.size(); ++i)
        texels[i] = {{rgb.texels[3 * i], rgb.texels[3 * i + 1], rgb.texels[3 * i + 2]}, 1};
    return texels;
}

void write_exr(const fs::path& path, const stroke::Document& painting, const ink::ComposeOptions& compose) {
    constexpr std::size_t kMostLayers = 15;  // 64 channels are read
    const stroke::Model& model = painting.model();
    const ink::Substrate& substrate = painting.appearance().substrate();
    ink::Stack stack{std::vector<ink::LayerView>{}};
    stack.base_colour = painting.appearance().stack().base_colour;
    const auto picture = [&] { return ink::compose_linear(stack, model.texels, substrate, compose); };
    ImageOptions options = linear_options(compose.space);
    options.channel_names = {"R", "G", "B"};
    std::set<std::string> used;
    const auto name_channels = [&](const std::string& wanted) {
        std::string name = channel_name(wanted);
        while (!used.insert(name).second) name += "-";
        for (const char* c : {".R", ".G", ".B", ".A"}) options.channel_names.push_back(name + c);
    };
    ink::AtlasMap<float> all = ink::compose_linear(painting.appearance().stack(), model.texels, substrate, compose);
    ink::AtlasMap<float> below = picture();
    append_channels(all, opaque_texels(below));
    name_channels(substrate.name);
    for (const Level& level : levels_of(painting)) {
        if (!level.shown) continue;
        if (used.size() >= kMostLayers) throw Error(path.string(), Message("has more than {} layers", kMostLayers));
        stack.layers.push_back(level.view);
        ink::AtlasMap<float> with = picture();
        append_channels(all, layer_texels(below, with));
        name_channels(level.layer->name);
        below = std::move(with);
    }
    for (std::uint32_t page = 0; page < model.atlas.pages; ++page)
        write_image(page_path(path, model.atlas, page), page_view(view_of(all), model.atlas, page), options);
}

}  // namespace

void write_layers(const fs::path& path, const stroke::Document& painting, const ink::ComposeOptions& compose) {
    if (path.extension() == ".ora") return write_raster(path, painting, compose);
    if (path.extension() == ".exr") return write_exr(path, painting, compose);
    throw Error(path.string(), "layers are written as .ora or .exr");
}

}  // namespace tuft::io
