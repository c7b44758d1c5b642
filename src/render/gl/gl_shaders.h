#pragma once

#include <epoxy/gl.h>

#include <string_view>

/// \file
/// Access to the built-in shaders. Internal to `render/gl`.
namespace tuft::render {

/// Text of a file of shaders/ ("mesh/mesh.vert"), built in; empty for an unknown name.
std::string_view shader_text(std::string_view name);

/// Compiles and links NAME.vert and NAME.frag. Throws `Error` with the driver's message.
GLuint make_program(std::string_view name);

}  // namespace tuft::render
