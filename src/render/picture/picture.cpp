#include "render/picture/picture.h"

#include <algorithm>
#include <numbers>

#include "render/picture/picture_series.h"

namespace tuft::render {

Image render_picture(const mesh::TriangleMesh& mesh, const mesh::SurfaceQuery& query, const Appearance& appearance,
                     const PictureOptions& options) {
    PictureSeries series(mesh, query, appearance, options, PictureSeries::Length::one);
    series.draw(appearance);
    return series.take_image();
}

PictureOptions turntable_frame(PictureOptions options, int index, int count) {
    options.view.azimuth -= 2 * std::numbers::pi * index / std::max(count, 1);
    return options;
}

}  // namespace tuft::render
