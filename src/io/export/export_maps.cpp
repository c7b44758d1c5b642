#include "io/export/export_maps.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "io/export/export.h"
#include "io/export/export_layers.h"
#include "io/image/icc_profile.h"

namespace fs = std::filesystem;

namespace tuft::io {

ink::AtlasMap<std::uint16_t> encode16(const ink::AtlasMap<float>& linear, ink::ColourSpace space) {
    ink::AtlasMap<std::uint16_t> out{.size = linear.size, .channels = linear.channels, .texels = {}};
    out.texels.reserve(linear.texels.size());
    for (const float v : linear.texels)
        out.texels.push_back(
            static_cast<std::uint16_t>(std::lround(65535 * ink::encode(space, std::clamp(v, 0.0f, 1.0f)))));
    return out;
}

ImageOptions linear_options(ink::ColourSpace space) {
    ImageOptions options;
    options.srgb = false;
    options.half = true;
    if (space == ink::ColourSpace::srgb) return options;
    const ink::ColourSpaceData& data = ink::data_of(space);
    for (const ink::Chromaticity& c : {data.red, data.green, data.blue, data.white})
        options.chromaticities.insert(options.chromaticities.end(), {static_cast<float>(c.x), static_cast<float>(c.y)});
    return options;
}

const std::vector<std::string>& map_names() {
    static const std::vector<std::string> names{"base-colour", "normal", "height", "roughness",
                                                "pigments",    "layers", "palette"};
    return names;
}

void write_map(const fs::path& path, const std::string& name, const stroke::Document& painting,
               const ink::ComposeOptions& compose, const MapOptions& wanted) {
    const ink::Stack stack = painting.appearance().stack();
    const ink::Substrate& substrate = painting.appearance().substrate();
    const stroke::Model& model = painting.model();
    const bool png = path.extension() == ".png";
    ImageOptions data;
    data.srgb = false;
    const auto write = [&](const PixelView& whole, const ImageOptions& options = {}) {
        for (std::uint32_t page = 0; page < model.atlas.pages; ++page)
            write_image(page_path(path, model.atlas, page), page_view(whole, model.atlas, page), options);
    };
    if (name == "palette") {
        if (!painting.palette().canvas()) throw Error("there is nothing on the palette");
        stroke::PalettePicture picture;
        stroke::refresh(picture, painting.palette());
        return write_image(path, view_of(picture.width, picture.height, 3, picture.rgb.data()));
    }
    ImageOptions coloured;
    coloured.srgb = compose.space == ink::ColourSpace::srgb;
    if (wanted.profile || !coloured.srgb) coloured.icc_profile = icc_profile(compose.space);
    if (name == "base-colour" && png && wanted.bits == 16) {
        write(view_of(encode16(ink::compose_linear(stack, model.texels, substrate, compose), compose.space)), coloured);
    } else if (name == "base-colour" && png) {
        if (ink::data_of(compose.space).linear)
            throw Error(path.string(), "linear colours need 16 bits or an .exr file");
        write(view_of(ink::compose_srgb8(stack, model.texels, substrate, compose)), coloured);
    } else if (name == "base-colour") {
        write(view_of(ink::compose_linear(stack, model.texels, substrate, compose)), linear_options(compose.space));
    } else if (name == "layers") {
        write_layers(path, painting, compose);
    } else if (name == "roughness") {
        data.half = true;
        write(view_of(ink::compose_roughness(stack, model.texels, substrate, compose)), data);
    } else if (name == "pigments") {
        const std::vector<ink::Pigment>& pigments = painting.layers().pigments();
        if (pigments.empty() || stack.layers.empty())
            throw Error(path.string(), "nothing is painted: there are no pigments to write");
        const ink::AtlasMap<float> amounts = ink::compose_amounts(stack, model.texels, compose);
        for (int p = 0; p < amounts.channels; ++p)
            data.channel_names.push_back(channel_name(pigments[static_cast<std::size_t>(p)].name));
        write(view_of(amounts), data);
    } else {
        const ink::AtlasMap<float> height = ink::compose_height(stack, model.texels, compose);
        if (name == "normal" && png)
            write(view_of(normal_map16(height, model.atlas.texel_size)), data);
        else if (name == "normal")
            write(view_of(normal_map_float(height, model.atlas.texel_size)), data);
        else if (png)
            write(view_of(height16(height)), data);
        else
            write(view_of(height), data);
    }
}

}  // namespace tuft::io
