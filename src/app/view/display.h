#pragma once

#include <memory>
#include <string>

#include "app/input/events.h"
#include "core/message.h"

/// \file
/// Output of the program. Window thread.
namespace tuft::app {

/// A window, or a picture in memory. Owns the OpenGL context, which is current on the thread that created it.
class Display {
  public:
    virtual ~Display() = default;
    /// Appends the events since the last call; waits up to `wait` seconds for one.
    virtual void poll(EventQueue& events, double wait) = 0;
    virtual void present() = 0;
    /// Returns a fault since the last call for the status bar; else "".
    virtual Message take_fault() { return {}; }
    /// Returns false where nobody looks: then only frames whose pixels are read need to be drawn.
    virtual bool seen() const { return true; }
    virtual bool closed() const = 0;
    virtual void cancel_close() {}  ///< resets `closed`
    /// Returns true when the graphics driver was reset and all its memory is lost.
    virtual bool lost() const;
    /// Creates a new OpenGL context, current on this thread, and destroys the old one.
    virtual void renew() = 0;
    virtual void set_title(const std::string&) {}
    virtual void resize(int width, int height) = 0;
    virtual int width() const = 0;
    virtual int height() const = 0;
    virtual unsigned framebuffer() const { return 0; }
    virtual float scale() const { return 1; }  ///< of text, on displays with small pixels
    double now() const;                        ///< seconds since the start
};

/// Opens a window. Throws `Error` when there is no display or no OpenGL 3.3.
std::unique_ptr<Display> open_window(int width, int height);
/// Opens a framebuffer without a display: EGL on the first graphics card, else in software. Throws `Error`.
std::unique_ptr<Display> open_offscreen(int width, int height);

}  // namespace tuft::app
