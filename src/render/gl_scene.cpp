#include "render/gl_scene.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <string>
#include <vector>

#include "core/error.h"
#include "render/gl_shaders.h"

namespace tuft::render {
namespace {

struct Vertex {
    Vec3f position, normal;
    Vec2f uv;
};
struct SolidVertex {
    Vec3f position, normal, colour;
};

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
    throw Error("shader " + name + " does not compile: " + log);
}

glm::mat4 view_projection(const GlCamera& c) {
    const glm::mat4 projection = glm::perspective(
        static_cast<float>(c.field_of_view), static_cast<float>(c.width) / static_cast<float>(std::max(1, c.height)),
        static_cast<float>(c.near), static_cast<float>(c.far));
    const glm::mat4 view = glm::lookAt(Vec3f(c.eye), Vec3f(c.eye + c.forward), Vec3f(c.up));
    return projection * view;
}

void set_camera(GLuint program, const GlCamera& c) {
    const glm::mat4 m = view_projection(c);
    glUniformMatrix4fv(glGetUniformLocation(program, "u_view_projection"), 1, GL_FALSE, glm::value_ptr(m));
    const Vec3f eye(c.eye);
    glUniform3fv(glGetUniformLocation(program, "u_eye"), 1, glm::value_ptr(eye));
    const glm::mat3 lights{Vec3f(c.right), Vec3f(c.up), Vec3f(c.forward)};
    glUniformMatrix3fv(glGetUniformLocation(program, "u_light_frame"), 1, GL_FALSE, glm::value_ptr(lights));
}

void attribute(GLuint index, int count, std::size_t stride, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                          reinterpret_cast<const void*>(offset));
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
    throw Error("shader program " + std::string(name) + " does not link: " + log);
}

struct GlScene::State {
    GLuint mesh_program = 0, solid_program = 0;
    GLuint mesh_array = 0, mesh_buffer = 0, solid_array = 0, solid_buffer = 0, solid_index = 0;
    GLuint texture = 0;
    GLsizei n_corners = 0;
    int atlas_size = 0;
};

GlScene::GlScene() : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.mesh_program = make_program("mesh/mesh");
    s.solid_program = make_program("brush/brush");
    glGenVertexArrays(1, &s.mesh_array);
    glGenBuffers(1, &s.mesh_buffer);
    glGenVertexArrays(1, &s.solid_array);
    glGenBuffers(1, &s.solid_buffer);
    glGenBuffers(1, &s.solid_index);
    glGenTextures(1, &s.texture);
}

GlScene::~GlScene() {
    State& s = *state_;
    glDeleteProgram(s.mesh_program);
    glDeleteProgram(s.solid_program);
    glDeleteVertexArrays(1, &s.mesh_array);
    glDeleteVertexArrays(1, &s.solid_array);
    for (const GLuint buffer : {s.mesh_buffer, s.solid_buffer, s.solid_index}) glDeleteBuffers(1, &buffer);
    glDeleteTextures(1, &s.texture);
}

void GlScene::set_mesh(const mesh::TriangleMesh& mesh, std::span<const Vec2f> corner_uvs) {
    State& s = *state_;
    std::vector<Vertex> vertices;
    vertices.reserve(3 * mesh.n_triangles());
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
        for (std::size_t k = 0; k < 3; ++k)
            vertices.push_back({mesh.positions[mesh.triangles[t][k]], mesh.corner_normals[3 * t + k],
                                corner_uvs.empty() ? Vec2f(0) : corner_uvs[3 * t + k]});
    s.n_corners = static_cast<GLsizei>(vertices.size());
    glBindVertexArray(s.mesh_array);
    glBindBuffer(GL_ARRAY_BUFFER, s.mesh_buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(Vertex)), vertices.data(), GL_STATIC_DRAW);
    attribute(0, 3, sizeof(Vertex), offsetof(Vertex, position));
    attribute(1, 3, sizeof(Vertex), offsetof(Vertex, normal));
    attribute(2, 2, sizeof(Vertex), offsetof(Vertex, uv));
    glBindVertexArray(0);
}

void GlScene::set_base_colour(const ink::AtlasMap<std::uint8_t>& map) {
    State& s = *state_;
    s.atlas_size = static_cast<int>(map.size);
    glBindTexture(GL_TEXTURE_2D, s.texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_SRGB8, s.atlas_size, s.atlas_size, 0, GL_RGB, GL_UNSIGNED_BYTE, map.texels.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void GlScene::update_tiles(const ink::AtlasMap<std::uint8_t>& map, std::span<const std::uint32_t> tiles, int gutter) {
    State& s = *state_;
    const int per_side = (s.atlas_size + atlas::kTile - 1) / atlas::kTile;
    glBindTexture(GL_TEXTURE_2D, s.texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glPixelStorei(GL_UNPACK_ROW_LENGTH, s.atlas_size);
    for (const std::uint32_t tile : tiles) {
        const int x = static_cast<int>(tile) % per_side * atlas::kTile, y = static_cast<int>(tile) / per_side * atlas::kTile;
        const int x0 = std::max(0, x - gutter), y0 = std::max(0, y - gutter);
        const int x1 = std::min(s.atlas_size, x + atlas::kTile + gutter), y1 = std::min(s.atlas_size, y + atlas::kTile + gutter);
        const std::size_t first = 3 * (static_cast<std::size_t>(y0) * map.size + static_cast<std::size_t>(x0));
        glTexSubImage2D(GL_TEXTURE_2D, 0, x0, y0, x1 - x0, y1 - y0, GL_RGB, GL_UNSIGNED_BYTE, &map.texels[first]);
    }
    glPixelStorei(GL_UNPACK_ROW_LENGTH, 0);
}

void GlScene::clear(const GlCamera& c) {
    glViewport(0, 0, c.width, c.height);
    glClearColor(0.235f, 0.242f, 0.255f, 1);
    glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
}

void GlScene::draw_model(const GlCamera& c, Shading shading, float roughness) {
    State& s = *state_;
    glEnable(GL_DEPTH_TEST);
    glUseProgram(s.mesh_program);
    set_camera(s.mesh_program, c);
    glUniform1i(glGetUniformLocation(s.mesh_program, "u_shading"), static_cast<int>(shading));
    glUniform1f(glGetUniformLocation(s.mesh_program, "u_roughness"), roughness);
    glUniform1f(glGetUniformLocation(s.mesh_program, "u_atlas_size"), static_cast<float>(s.atlas_size));
    glUniform1i(glGetUniformLocation(s.mesh_program, "u_base_colour"), 0);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, s.texture);
    glBindVertexArray(s.mesh_array);
    glDrawArrays(GL_TRIANGLES, 0, s.n_corners);
    glBindVertexArray(0);
}

void GlScene::draw_solid(const GlCamera& c, const GlSolid& solid, float opacity) {
    State& s = *state_;
    if (solid.triangles.empty()) return;
    std::vector<SolidVertex> vertices(solid.positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
        vertices[i] = {solid.positions[i], solid.normals[i], solid.colours[i]};
    glUseProgram(s.solid_program);
    set_camera(s.solid_program, c);
    glUniform1f(glGetUniformLocation(s.solid_program, "u_opacity"), opacity);
    glEnable(GL_DEPTH_TEST);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    glBindVertexArray(s.solid_array);
    glBindBuffer(GL_ARRAY_BUFFER, s.solid_buffer);
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(vertices.size() * sizeof(SolidVertex)), vertices.data(), GL_STREAM_DRAW);
    attribute(0, 3, sizeof(SolidVertex), offsetof(SolidVertex, position));
    attribute(1, 3, sizeof(SolidVertex), offsetof(SolidVertex, normal));
    attribute(2, 3, sizeof(SolidVertex), offsetof(SolidVertex, colour));
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, s.solid_index);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, static_cast<GLsizeiptr>(solid.triangles.size() * sizeof(std::uint32_t)),
                 solid.triangles.data(), GL_STREAM_DRAW);
    glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(solid.triangles.size()), GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
    glDisable(GL_BLEND);
}

}  // namespace tuft::render
