#include "render/gl/gl_scene.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <unordered_map>
#include <vector>

#include "atlas/texels/texel_map.h"
#include "core/hash.h"
#include "render/gl/gl_shaders.h"

namespace tuft::render {
namespace {

struct Vertex {
    Vec3f position, normal;
    Vec2f uv;
    bool operator==(const Vertex& o) const { return std::memcmp(this, &o, sizeof o) == 0; }
};
struct VertexHash {
    std::size_t operator()(const Vertex& v) const { return hash_bytes(&v, sizeof v); }
};
struct SolidVertex {
    Vec3f position, normal, colour;
};

// Triangles that lie together, to be drawn or left out as one.
struct Cluster {
    Vec3f lo{1e30f}, hi{-1e30f};
    std::uint32_t first = 0, count = 0;  // indices
    float transmission = 0;              // of each of its triangles
};
constexpr std::size_t kClusterTriangles = 192, kMostClusters = 4096;

// Order of the triangles along a Z-shaped curve through space (Morton 1966).
std::vector<std::uint32_t> spatial_order(const mesh::TriangleMesh& mesh) {
    const auto spread = [](std::uint64_t v) {
        v &= 0x3ff;
        v = (v | v << 16) & 0x30000ff;
        v = (v | v << 8) & 0x300f00f;
        v = (v | v << 4) & 0x30c30c3;
        return (v | v << 2) & 0x9249249;
    };
    const Vec3 size = glm::max(mesh.bounds.size(), Vec3(1e-9));
    std::vector<std::pair<std::uint64_t, std::uint32_t>> keys;
    keys.reserve(mesh.n_triangles());
    for (std::uint32_t t = 0; t < mesh.n_triangles(); ++t) {
        const Vec3 p = ((mesh.position(t, 0) + mesh.position(t, 1) + mesh.position(t, 2)) / 3.0 - mesh.bounds.lo) /
                       std::max({size.x, size.y, size.z});
        const auto cell = [](double v) { return static_cast<std::uint64_t>(std::clamp(1023 * v, 0.0, 1023.0)); };
        keys.emplace_back(spread(cell(p.x)) | spread(cell(p.y)) << 1 | spread(cell(p.z)) << 2, t);
    }
    std::sort(keys.begin(), keys.end());
    std::vector<std::uint32_t> order;
    order.reserve(keys.size());
    for (const auto& [key, t] : keys) order.push_back(t);
    return order;
}

glm::mat4 view_projection(const GlCamera& c) {
    const float aspect = static_cast<float>(c.width) / static_cast<float>(std::max(1, c.height));
    const auto near = static_cast<float>(c.near), far = static_cast<float>(c.far);
    const auto half = static_cast<float>(0.5 * c.parallel_height);
    const glm::mat4 projection = half > 0 ? glm::ortho(-half * aspect, half * aspect, -half, half, near, far)
                                          : glm::perspective(static_cast<float>(c.field_of_view), aspect, near, far);
    return projection * glm::lookAt(Vec3f(c.eye), Vec3f(c.eye + c.forward), Vec3f(c.up));
}

void set_vector(GLuint program, const char* name, const Vec3f& v) {
    glUniform3fv(glGetUniformLocation(program, name), 1, glm::value_ptr(v));
}

void set_view(GLuint program, const GlCamera& c, const GlLight& l) {
    glUseProgram(program);
    const glm::mat4 m = view_projection(c);
    glUniformMatrix4fv(glGetUniformLocation(program, "u_view_projection"), 1, GL_FALSE, glm::value_ptr(m));
    set_vector(program, "u_eye", Vec3f(c.eye));
    set_vector(program, "u_to_eye", c.parallel_height > 0 ? Vec3f(-c.forward) : Vec3f(0));
    set_vector(program, "u_key", l.key);
    set_vector(program, "u_fill", l.fill);
    set_vector(program, "u_key_light", l.key_light);
    set_vector(program, "u_fill_light", l.fill_light);
    set_vector(program, "u_ground", l.ground);
    set_vector(program, "u_sky", l.sky);
}

void attribute(GLuint index, int count, std::size_t stride, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, count, GL_FLOAT, GL_FALSE, static_cast<GLsizei>(stride),
                          reinterpret_cast<const void*>(offset));
}

template <class T>
void fill_buffer(GLenum kind, GLuint buffer, const std::vector<T>& values, GLenum usage) {
    glBindBuffer(kind, buffer);
    glBufferData(kind, static_cast<GLsizeiptr>(values.size() * sizeof(T)), values.data(), usage);
}

}  // namespace

struct GlScene::State {
    struct Programs {
        GLuint mesh = 0, solid = 0, backdrop = 0, atlas = 0;
    };
    /// Vertices and indices of triangles.
    struct Arrays {
        GLuint array = 0, buffer = 0, index = 0;
    };
    /// Triangles near each other, drawn together. They share the vertices of the mesh.
    struct Clusters {
        GLuint array = 0, index = 0;
        std::vector<std::uint32_t> order;  // of the triangles
        std::vector<Cluster> all;          // opaque ones, then those of glass
        std::size_t n_opaque = 0;
        std::vector<GLuint> queries;       // one per cluster: whether any of it is seen
        std::vector<std::uint8_t> hidden;  // likewise, after the answers
        bool pending = false;              // the answers are still to be read
    };
    Programs programs;
    Arrays mesh, solid;
    std::vector<Vec3f> positions;        // of the vertices in `mesh`
    std::vector<std::uint32_t> indices;  // of all triangles, in the file's order
    Clusters clusters;
    GLuint empty_array = 0, texture = 0, colour_buffer = 0, colour_texture = 0;
    GLsizei n_indices = 0;
    int texture_size = 0;

    /// Gives a program that is in use the atlas, the colours of triangles and what of them it shows.
    void bind_atlas(GLuint program, const DrawOptions& options) const {
        const auto at = [&](const char* name) { return glGetUniformLocation(program, name); };
        glUniform1i(at("u_shading"), static_cast<int>(options.shading));
        glUniform1f(at("u_atlas_size"), static_cast<float>(texture_size));
        glUniform1f(at("u_height_range"), options.height_range);
        glUniform1i(at("u_texture"), 0);
        glUniform1i(at("u_triangle_colours"), 1);
        glActiveTexture(GL_TEXTURE1);
        glBindTexture(GL_TEXTURE_BUFFER, colour_texture);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, texture);
    }
};

GlScene::GlScene() : state_(std::make_unique<State>()) {
    State& s = *state_;
    s.programs.mesh = make_program("mesh/mesh");
    s.programs.solid = make_program("brush/brush");
    s.programs.backdrop = make_program("backdrop/backdrop");
    s.programs.atlas = make_program("atlas/atlas");
    for (GLuint* array : {&s.mesh.array, &s.clusters.array, &s.solid.array, &s.empty_array})
        glGenVertexArrays(1, array);
    for (GLuint* buffer :
         {&s.mesh.buffer, &s.mesh.index, &s.clusters.index, &s.solid.buffer, &s.solid.index, &s.colour_buffer})
        glGenBuffers(1, buffer);
    glGenTextures(1, &s.texture);
    glGenTextures(1, &s.colour_texture);
}

GlScene::~GlScene() {
    State& s = *state_;
    for (const GLuint program : {s.programs.mesh, s.programs.solid, s.programs.backdrop, s.programs.atlas})
        glDeleteProgram(program);
    for (const GLuint array : {s.mesh.array, s.clusters.array, s.solid.array, s.empty_array})
        glDeleteVertexArrays(1, &array);
    for (const GLuint buffer :
         {s.mesh.buffer, s.mesh.index, s.clusters.index, s.solid.buffer, s.solid.index, s.colour_buffer})
        glDeleteBuffers(1, &buffer);
    glDeleteTextures(1, &s.texture);
    glDeleteTextures(1, &s.colour_texture);
    glDeleteQueries(static_cast<GLsizei>(s.clusters.queries.size()), s.clusters.queries.data());
}

void GlScene::set_mesh(const mesh::TriangleMesh& mesh, std::span<const Vec2f> corner_uvs) {
    State& s = *state_;
    std::vector<Vertex> vertices;
    std::vector<std::uint32_t> indices;
    std::unordered_map<Vertex, std::uint32_t, VertexHash> known;
    indices.reserve(3 * mesh.n_triangles());
    known.reserve(mesh.n_vertices() * 2);
    for (std::size_t t = 0; t < mesh.n_triangles(); ++t)
        for (std::size_t k = 0; k < 3; ++k) {
            const Vertex v{mesh.positions[mesh.triangles[t][k]], mesh.corner_normals[3 * t + k],
                           corner_uvs.empty() ? Vec2f(0) : corner_uvs[3 * t + k]};
            const auto [at, is_new] = known.try_emplace(v, static_cast<std::uint32_t>(vertices.size()));
            if (is_new) vertices.push_back(v);
            indices.push_back(at->second);
        }
    fill_buffer(GL_ARRAY_BUFFER, s.mesh.buffer, vertices, GL_STATIC_DRAW);
    s.positions.clear();
    s.positions.reserve(vertices.size());
    for (const Vertex& v : vertices) s.positions.push_back(v.position);
    s.indices = std::move(indices);
    s.clusters.order = spatial_order(mesh);
    set_parts({}, {});
}

void GlScene::set_parts(std::span<const std::uint8_t> hidden, std::span<const float> transmission) {
    State& s = *state_;
    const auto passes = [&](std::uint32_t t) { return transmission.empty() ? 0.0f : transmission[t]; };
    std::vector<std::uint32_t> numbered = s.indices, sorted;
    // A triangle without extent is not drawn, and the others keep their numbers.
    for (std::size_t t = 0; t < hidden.size(); ++t)
        if (hidden[t]) numbered[3 * t + 1] = numbered[3 * t + 2] = numbered[3 * t];
    sorted.reserve(s.indices.size());
    s.clusters.all.clear();
    glDeleteQueries(static_cast<GLsizei>(s.clusters.queries.size()), s.clusters.queries.data());
    s.clusters.queries.clear();
    const std::size_t n_triangles = s.indices.size() / 3;
    const std::size_t most = std::max(kClusterTriangles, n_triangles / kMostClusters + 1);
    for (const bool glass : {false, true}) {
        s.clusters.n_opaque = s.clusters.all.size();
        for (const std::uint32_t t : s.clusters.order) {
            const float part = passes(t);
            if ((part > 0) != glass || (!hidden.empty() && hidden[t])) continue;
            const bool goes_on = s.clusters.all.size() > (glass ? s.clusters.n_opaque : 0) &&
                                 s.clusters.all.back().count < 3 * most && s.clusters.all.back().transmission == part;
            if (!goes_on)
                s.clusters.all.push_back({.first = static_cast<std::uint32_t>(sorted.size()), .transmission = part});
            Cluster& cluster = s.clusters.all.back();
            for (std::size_t k = 0; k < 3; ++k) {
                const std::uint32_t v = s.indices[3 * t + k];
                cluster.lo = glm::min(cluster.lo, s.positions[v]);
                cluster.hi = glm::max(cluster.hi, s.positions[v]);
                sorted.push_back(v);
            }
            cluster.count += 3;
        }
    }
    s.n_indices = static_cast<GLsizei>(numbered.size());
    // The same triangles twice: in the file's order, by which they are numbered, and in clusters.
    const auto make_array = [&](GLuint array, GLuint index, const std::vector<std::uint32_t>& values) {
        glBindVertexArray(array);
        glBindBuffer(GL_ARRAY_BUFFER, s.mesh.buffer);
        fill_buffer(GL_ELEMENT_ARRAY_BUFFER, index, values, GL_STATIC_DRAW);
        attribute(0, 3, sizeof(Vertex), offsetof(Vertex, position));
        attribute(1, 3, sizeof(Vertex), offsetof(Vertex, normal));
        attribute(2, 2, sizeof(Vertex), offsetof(Vertex, uv));
        glBindVertexArray(0);
    };
    make_array(s.mesh.array, s.mesh.index, numbered);
    make_array(s.clusters.array, s.clusters.index, sorted);
}

bool GlScene::has_glass() const {
    return state_->clusters.n_opaque < state_->clusters.all.size();
}

void GlScene::set_triangle_colours(std::span<const std::array<std::uint8_t, 4>> colours) {
    State& s = *state_;
    glBindBuffer(GL_TEXTURE_BUFFER, s.colour_buffer);
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(colours.size_bytes()), colours.data(), GL_STATIC_DRAW);
    glBindTexture(GL_TEXTURE_BUFFER, s.colour_texture);
    glTexBuffer(GL_TEXTURE_BUFFER, GL_RGBA8, s.colour_buffer);
}

void GlScene::set_texture(const MapPixels& map) {
    State& s = *state_;
    s.texture_size = static_cast<int>(map.size);
    glBindTexture(GL_TEXTURE_2D, s.texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int level = 0; level < kTextureLevels; ++level) {
        const int size = s.texture_size >> level;
        glTexImage2D(GL_TEXTURE_2D, level, GL_SRGB8_ALPHA8, size, size, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                     map.levels[static_cast<std::size_t>(level)].data());
    }
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, kTextureLevels - 1);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
}

void GlScene::update_tiles(std::span<const TilePixels> tiles) {
    State& s = *state_;
    const int per_side = s.texture_size / atlas::kTile;
    glBindTexture(GL_TEXTURE_2D, s.texture);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (const TilePixels& tile : tiles) {
        const int column = static_cast<int>(tile.tile) % per_side, row = static_cast<int>(tile.tile) / per_side;
        for (int level = 0; level < kTextureLevels; ++level) {
            const int side = atlas::kTile >> level;
            glTexSubImage2D(GL_TEXTURE_2D, level, column * side, row * side, side, side, GL_RGBA, GL_UNSIGNED_BYTE,
                            &tile.rgba[static_cast<std::size_t>(TilePixels::kStart[static_cast<std::size_t>(level)])]);
        }
    }
}

struct GlScene::VisibleCluster {
    double nearest = 0;  // metres from the eye
    std::uint32_t cluster = 0;

    auto operator<=>(const VisibleCluster&) const = default;
};

// Clusters that reach into a part of the picture, the nearest first: always in the same order.
std::vector<GlScene::VisibleCluster> GlScene::clusters_in(const GlCamera& c, const PixelRect& part) const {
    const std::vector<Cluster>& clusters = state_->clusters.all;
    std::vector<VisibleCluster> seen;
    for (std::uint32_t i = 0; i < clusters.size(); ++i) {
        const Cluster& cluster = clusters[i];
        double x0 = 1e30, y0 = 1e30, x1 = -1e30, y1 = -1e30, nearest = 1e30;
        for (int k = 0; k < 8; ++k) {
            const Vec3 p =
                picture_point(c, Vec3(k & 1 ? cluster.hi.x : cluster.lo.x, k & 2 ? cluster.hi.y : cluster.lo.y,
                                      k & 4 ? cluster.hi.z : cluster.lo.z));
            nearest = std::min(nearest, p.z);
            x0 = std::min(x0, p.x), x1 = std::max(x1, p.x), y0 = std::min(y0, p.y), y1 = std::max(y1, p.y);
        }
        const bool before_eye = c.parallel_height <= 0 && nearest <= c.near;
        if (before_eye || (x1 >= part.x && x0 <= part.x + part.width && c.height - y0 >= part.y &&
                           c.height - y1 <= part.y + part.height))
            seen.push_back({nearest, i});
    }
    std::sort(seen.begin(), seen.end());
    return seen;
}

namespace {

// Mesa's software driver is not exact to the sample at the border of what is cut: it draws up to a
// few pixels more or less. So more is drawn than is asked for; outside it stays as it was.
constexpr int kBlock = 8;

const void* start_of(const Cluster& cluster) {
    return reinterpret_cast<const void*>(cluster.first * sizeof(std::uint32_t));
}

void end_model() {
    glBindVertexArray(0);
    glDepthFunc(GL_LESS);
    glDisable(GL_CLIP_DISTANCE0);
    glDisable(GL_SCISSOR_TEST);
}

}  // namespace

void GlScene::draw_backdrop(const GlCamera& c, const Vec3f& low, const Vec3f& high) {
    State& s = *state_;
    glViewport(0, 0, c.width, c.height);
    glDisable(GL_SCISSOR_TEST);
    glClear(GL_DEPTH_BUFFER_BIT);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    glUseProgram(s.programs.backdrop);
    set_vector(s.programs.backdrop, "u_low", low);
    set_vector(s.programs.backdrop, "u_high", high);
    glBindVertexArray(s.empty_array);
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
}

void GlScene::begin_model(const GlCamera& c, const GlLight& light, const DrawOptions& options) {
    State& s = *state_;
    glViewport(0, 0, c.width, c.height);
    glEnable(GL_DEPTH_TEST);
    glDepthFunc(GL_LEQUAL);  // of surfaces in the same place the last one stays, now and when it is drawn again
    if (options.section != Vec4f(0)) glEnable(GL_CLIP_DISTANCE0);
    set_view(s.programs.mesh, c, light);
    const auto at = [&](const char* name) { return glGetUniformLocation(s.programs.mesh, name); };
    glUniform1f(at("u_roughness"), options.roughness);
    glUniform1f(at("u_relief"), light.relief);
    glUniform4fv(at("u_section"), 1, glm::value_ptr(options.section));
    glUniform1f(at("u_transmission"), 0);
    s.bind_atlas(s.programs.mesh, options);
    glBindVertexArray(options.shading == Shading::triangles ? s.mesh.array : s.clusters.array);
}

// Nothing of it hides what is drawn after it.
void GlScene::draw_glass(std::span<const VisibleCluster> seen, const DrawOptions& options) {
    const State& s = *state_;
    const bool lit = options.shading == Shading::glaze || options.shading == Shading::clay;
    const GLint at = glGetUniformLocation(s.programs.mesh, "u_transmission");
    if (lit) {
        glEnable(GL_BLEND);
        glBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE, GL_ONE_MINUS_SRC_ALPHA);
        glDepthMask(GL_FALSE);
    }
    for (auto one = seen.rbegin(); one != seen.rend(); ++one) {
        if (one->cluster < s.clusters.n_opaque) continue;
        const Cluster& cluster = s.clusters.all[one->cluster];
        if (lit) glUniform1f(at, cluster.transmission);
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(cluster.count), GL_UNSIGNED_INT, start_of(cluster));
    }
    glDepthMask(GL_TRUE);
    glDisable(GL_BLEND);
}

void GlScene::draw_model(const GlCamera& c, const GlLight& light, const DrawOptions& options, bool still) {
    State& s = *state_;
    begin_model(c, light, options);
    s.clusters.pending = false;
    s.clusters.hidden.assign(s.clusters.all.size(), 0);
    if (options.shading == Shading::triangles) {
        glDrawElements(GL_TRIANGLES, s.n_indices, GL_UNSIGNED_INT, nullptr);
    } else {
        const std::vector<VisibleCluster> seen = clusters_in(c, {0, 0, c.width, c.height});
        s.clusters.pending = still;
        if (still && s.clusters.queries.empty()) {
            s.clusters.queries.resize(s.clusters.all.size());
            glGenQueries(static_cast<GLsizei>(s.clusters.queries.size()), s.clusters.queries.data());
        }
        if (still) s.clusters.hidden.assign(s.clusters.all.size(), 1);
        for (const VisibleCluster& one : seen) {
            if (one.cluster >= s.clusters.n_opaque) continue;
            const Cluster& cluster = s.clusters.all[one.cluster];
            // What is nearer is drawn already: where not a sample is seen now, none will be.
            if (still)
                glBeginQuery(GL_ANY_SAMPLES_PASSED, s.clusters.queries[one.cluster]),
                    s.clusters.hidden[one.cluster] = 0;
            glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(cluster.count), GL_UNSIGNED_INT, start_of(cluster));
            if (still) glEndQuery(GL_ANY_SAMPLES_PASSED);
        }
        if (has_glass()) draw_glass(seen, options);
    }
    end_model();
}

void GlScene::redraw_model(const GlCamera& c, const GlLight& light, const DrawOptions& options, const PixelRect& part,
                           std::span<const GlBox> changed) {
    State& s = *state_;
    if (s.clusters.pending)
        for (std::size_t i = 0; i < s.clusters.all.size(); ++i) {
            if (s.clusters.hidden[i]) continue;
            GLuint passed = GL_TRUE;
            glGetQueryObjectuiv(s.clusters.queries[i], GL_QUERY_RESULT, &passed);
            s.clusters.hidden[i] = passed == GL_FALSE;
        }
    s.clusters.pending = false;
    begin_model(c, light, options);
    const int x = std::max(0, part.x - kBlock), y = std::max(0, part.y - kBlock);
    glEnable(GL_SCISSOR_TEST);
    glScissor(x, y, part.x + part.width + kBlock - x, part.y + part.height + kBlock - y);
    std::vector<GLsizei> counts;
    std::vector<const void*> starts;
    for (const VisibleCluster& one : clusters_in(c, part)) {
        const Cluster& cluster = s.clusters.all[one.cluster];
        const bool meets = std::ranges::any_of(changed, [&](const GlBox& box) {
            return glm::all(glm::lessThanEqual(box.lo, cluster.hi)) && glm::all(glm::lessThanEqual(cluster.lo, box.hi));
        });
        if (s.clusters.hidden[one.cluster] || !meets) continue;
        counts.push_back(static_cast<GLsizei>(cluster.count));
        starts.push_back(start_of(cluster));
    }
    glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_INT, starts.data(),
                        static_cast<GLsizei>(counts.size()));
    end_model();
}

void GlScene::draw_atlas(const AtlasWindow& window, const DrawOptions& options) {
    State& s = *state_;
    const PixelRect& part = window.part;
    if (part.empty()) return;
    glViewport(part.x, part.y, part.width, part.height);
    glEnable(GL_SCISSOR_TEST);
    glScissor(part.x, part.y, part.width, part.height);
    glClearColor(window.backdrop.x, window.backdrop.y, window.backdrop.z, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_DEPTH_TEST);
    glUseProgram(s.programs.atlas);
    const auto at = [&](const char* name) { return glGetUniformLocation(s.programs.atlas, name); };
    glUniform4f(at("u_window"), static_cast<float>(window.centre.x), static_cast<float>(window.centre.y),
                static_cast<float>(0.5 * part.width / window.pixels_per_side),
                static_cast<float>(0.5 * part.height / window.pixels_per_side));
    s.bind_atlas(s.programs.atlas, options);
    glBindVertexArray(s.mesh.array);
    glDrawElements(GL_TRIANGLES, s.n_indices, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
    glDisable(GL_SCISSOR_TEST);
}

void GlScene::draw_solid(const GlCamera& c, const GlLight& light, const GlSolid& solid, float opacity) {
    State& s = *state_;
    if (solid.triangles.empty() || opacity <= 0) return;
    std::vector<SolidVertex> vertices(solid.positions.size());
    for (std::size_t i = 0; i < vertices.size(); ++i)
        vertices[i] = {solid.positions[i], solid.normals[i], solid.colours[i]};
    glViewport(0, 0, c.width, c.height);
    set_view(s.programs.solid, c, light);
    glUniform1f(glGetUniformLocation(s.programs.solid, "u_opacity"), opacity);
    glEnable(GL_DEPTH_TEST);
    glBindVertexArray(s.solid.array);
    fill_buffer(GL_ARRAY_BUFFER, s.solid.buffer, vertices, GL_STREAM_DRAW);
    attribute(0, 3, sizeof(SolidVertex), offsetof(SolidVertex, position));
    attribute(1, 3, sizeof(SolidVertex), offsetof(SolidVertex, normal));
    attribute(2, 3, sizeof(SolidVertex), offsetof(SolidVertex, colour));
    fill_buffer(GL_ELEMENT_ARRAY_BUFFER, s.solid.index, solid.triangles, GL_STREAM_DRAW);
    const auto draw = [&] {
        glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(solid.triangles.size()), GL_UNSIGNED_INT, nullptr);
    };
    if (opacity < 1) {  // depth first, so that only the front of the tuft is seen through
        glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        draw();
        glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glDepthFunc(GL_LEQUAL);
        glEnable(GL_BLEND);
        glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    }
    draw();
    glDepthFunc(GL_LESS);
    glDisable(GL_BLEND);
    glBindVertexArray(0);
}

}  // namespace tuft::render
