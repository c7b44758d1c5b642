#pragma once

#include <memory>
#include <string>

#include "app/input/events.h"
#include "core/message.h"

namespace tuft::app {

/// Where the program shows itself: a window, or a picture in memory. Owns the OpenGL
/// context, which is current on the thread that made it.
class Display {
  public:
    virtual ~Display() = default;
    /// Takes what happened since the last call, waiting up to `wait` seconds for something.
    virtual void poll(EventQueue& events, double wait) = 0;
    virtual void present() = 0;
    /// What went wrong since the last call and is worth a message, "" if nothing.
    virtual Message take_trouble() { return {}; }
    virtual bool closed() const = 0;
    virtual void stay_open() {}  ///< after `closed`: it is not any more
    /// The graphics driver was reset: everything in its memory is gone.
    virtual bool lost() const;
    /// Makes a new OpenGL context, current on this thread, in place of the old one.
    virtual void renew() = 0;
    virtual void set_title(const std::string&) {}
    virtual void resize(int width, int height) = 0;
    virtual int width() const = 0;
    virtual int height() const = 0;
    virtual unsigned framebuffer() const { return 0; }
    virtual float scale() const { return 1; }  ///< of text, for displays with small pixels
    double now() const;                        ///< seconds since the start
};

/// Throws `Error` when there is no display or no OpenGL 3.3.
std::unique_ptr<Display> open_window(int width, int height);
/// The same without a display (EGL without a surface; else a window that is not shown).
std::unique_ptr<Display> open_offscreen(int width, int height);

}  // namespace tuft::app
