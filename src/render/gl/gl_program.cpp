#include <string>

#include "core/error.h"
#include "render/gl/gl_shaders.h"

namespace tuft::render {
namespace {

GLuint compile(GLenum kind, const std::string& name) {
    const std::string_view text = shader_text(name);
    const char* source = text.data();
    const auto length = static_cast<GLint>(text.size());
    const GLuint shader = glCreateShader(kind);
    glShaderSource(shader, 1, &source, &length);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok) return shader;
    char log[1024] = "";
    glGetShaderInfoLog(shader, sizeof log, nullptr, log);
    throw Error(Message("shader {} does not compile: {}", name, log));
}

}  // namespace

GLuint make_program(std::string_view name) {
    const GLuint vertex = compile(GL_VERTEX_SHADER, std::string(name) + ".vert");
    const GLuint fragment = compile(GL_FRAGMENT_SHADER, std::string(name) + ".frag");
    const GLuint program = glCreateProgram();
    glAttachShader(program, vertex);
    glAttachShader(program, fragment);
    glLinkProgram(program);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    GLint ok = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &ok);
    if (ok) return program;
    char log[1024] = "";
    glGetProgramInfoLog(program, sizeof log, nullptr, log);
    throw Error(Message("shader program {} does not link: {}", std::string(name), log));
}

}  // namespace tuft::render
