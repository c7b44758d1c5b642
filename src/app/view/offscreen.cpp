#include <epoxy/egl.h>
#include <epoxy/gl.h>

#include <array>
#include <chrono>
#include <string_view>
#include <thread>

#include "app/view/display.h"
#include "core/error.h"
#include "render/gl/gl_target.h"

namespace tuft::app {

double Display::now() const {
    static const auto start = std::chrono::steady_clock::now();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

bool Display::lost() const {
    return epoxy_has_gl_extension("GL_ARB_robustness") && glGetGraphicsResetStatusARB() != GL_NO_ERROR;
}

namespace {

bool opens(EGLDisplay display) {
    return display != EGL_NO_DISPLAY && eglInitialize(display, nullptr, nullptr) && eglBindAPI(EGL_OPENGL_API);
}

/// The first graphics card that opens, or EGL_NO_DISPLAY. A driver of a card's maker, such as NVIDIA's, has no
/// surfaceless platform: its cards are found by EGL_EXT_device_enumeration.
EGLDisplay open_card() {
    if (!epoxy_has_egl_extension(EGL_NO_DISPLAY, "EGL_EXT_device_enumeration")) return EGL_NO_DISPLAY;
    std::array<EGLDeviceEXT, 16> cards{};
    EGLint count = 0;
    if (!eglQueryDevicesEXT(EGLint(cards.size()), cards.data(), &count)) return EGL_NO_DISPLAY;
    for (EGLint i = 0; i < count; ++i) {
        const char* extensions = eglQueryDeviceStringEXT(cards[i], EGL_EXTENSIONS);
        if (extensions && std::string_view(extensions).find("EGL_MESA_device_software") != std::string_view::npos)
            continue;
        const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, cards[i], nullptr);
        if (opens(display)) return display;
    }
    return EGL_NO_DISPLAY;
}

EGLDisplay open_without_surface() {
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (opens(display)) return display;
    throw Error("no OpenGL without a display on this machine");
}

class Offscreen : public Display {
  public:
    Offscreen(int width, int height) : width_(width), height_(height) {
        display_ = open_card();
        if (display_ == EGL_NO_DISPLAY) display_ = open_without_surface();
        make_context();
    }
    void renew() override {
        target_.reset();
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
        make_context();
    }
    void make_context() {
        const EGLint attributes[] = {
            EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 3, EGL_CONTEXT_OPENGL_PROFILE_MASK,
            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
        context_ = eglCreateContext(display_, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, attributes);
        if (context_ == EGL_NO_CONTEXT || !eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_)) {
            eglTerminate(display_);
            throw Error("no OpenGL 3.3 without a display on this machine");
        }
        target_ = std::make_unique<render::GlTarget>();
        target_->resize(width_, height_, 0);
    }
    ~Offscreen() override {
        target_.reset();
        eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display_, context_);
        eglTerminate(display_);
    }
    void poll(EventQueue&, double wait) override {
        if (wait > 0) std::this_thread::sleep_for(std::chrono::duration<double>(std::min(wait, 0.02)));
    }
    void present() override { glFinish(); }
    bool seen() const override { return false; }
    bool closed() const override { return false; }
    void resize(int width, int height) override {
        width_ = width;
        height_ = height;
        target_->resize(width_, height_, 0);
    }
    int width() const override { return width_; }
    int height() const override { return height_; }
    unsigned framebuffer() const override { return target_->framebuffer(); }

  private:
    int width_, height_;
    EGLDisplay display_ = EGL_NO_DISPLAY;
    EGLContext context_ = EGL_NO_CONTEXT;
    std::unique_ptr<render::GlTarget> target_;
};

}  // namespace

std::unique_ptr<Display> open_offscreen(int width, int height) {
    return std::make_unique<Offscreen>(width, height);
}

}  // namespace tuft::app
