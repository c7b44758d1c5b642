#include "render/gl/gl_target.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "core/error.h"

namespace tuft::render {

GlTarget::~GlTarget() {
    clear();
}

void GlTarget::clear() {
    if (!framebuffer_) return;
    glDeleteFramebuffers(1, &framebuffer_);
    glDeleteRenderbuffers(1, &colour_);
    glDeleteRenderbuffers(1, &depth_);
    framebuffer_ = colour_ = depth_ = 0;
}

void GlTarget::resize(int width, int height, int samples) {
    GLint most = 0;
    glGetIntegerv(GL_MAX_SAMPLES, &most);
    samples = samples > 1 ? std::min(samples, static_cast<int>(most)) : 0;
    if (framebuffer_ && width == width_ && height == height_ && samples == samples_) return;
    clear();
    width_ = width;
    height_ = height;
    samples_ = samples;
    glGenFramebuffers(1, &framebuffer_);
    glGenRenderbuffers(1, &colour_);
    glGenRenderbuffers(1, &depth_);
    glBindRenderbuffer(GL_RENDERBUFFER, colour_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width, height);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_);
    glRenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width, height);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
    if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw Error(Message("the graphics driver has no room for a picture of {} x {} pixels", width, height));
}

void GlTarget::bind() {
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
}

void GlTarget::resolve_to(unsigned framebuffer, const PixelRect& r, int dx, int dy) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    glBlitFramebuffer(r.x, r.y, r.x + r.width, r.y + r.height, r.x + dx, r.y + dy, r.x + r.width + dx,
                      r.y + r.height + dy, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
}

void GlTarget::copy_to(GlTarget& target, const PixelRect& r) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, target.framebuffer_);
    glBlitFramebuffer(r.x, r.y, r.x + r.width, r.y + r.height, r.x, r.y, r.x + r.width, r.y + r.height,
                      GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer_);
}

std::vector<std::uint8_t> read_pixels(int x, int y, int width, int height) {
    const auto row = static_cast<std::size_t>(3) * static_cast<std::size_t>(width);
    std::vector<std::uint8_t> pixels(row * static_cast<std::size_t>(height));
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(x, y, width, height, GL_RGB, GL_UNSIGNED_BYTE, pixels.data());
    for (int top = 0, bottom = height - 1; top < bottom; ++top, --bottom)
        std::swap_ranges(pixels.begin() + static_cast<std::ptrdiff_t>(row) * top,
                         pixels.begin() + static_cast<std::ptrdiff_t>(row) * (top + 1),
                         pixels.begin() + static_cast<std::ptrdiff_t>(row) * bottom);
    return pixels;
}

}  // namespace tuft::render
