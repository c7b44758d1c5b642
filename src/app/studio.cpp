#include "app/studio.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "brush/skin.h"
#include "core/files.h"

namespace fs = std::filesystem;

namespace tuft::app {
namespace {

constexpr float kPanelWidth = 270;
const Vec3f kHair{0.055f, 0.045f, 0.04f}, kFerrule{0.30f, 0.20f, 0.10f};

bool combo(const char* label, std::string& value, const std::vector<std::string>& names) {
    bool changed = false;
    if (ImGui::BeginCombo(label, value.c_str())) {
        for (const std::string& name : names)
            if (ImGui::Selectable(name.c_str(), name == value)) {
                value = name;
                changed = true;
            }
        ImGui::EndCombo();
    }
    return changed;
}

// A tube round the holder's axis, from the ferrule's mouth upwards.
void add_holder(render::GlSolid& solid, const Vec3& mouth, const Vec3& up, double radius, double length) {
    constexpr int sides = 20;
    const Frame f = make_frame(mouth, up);
    const auto base = static_cast<std::uint32_t>(solid.positions.size());
    for (int ring = 0; ring < 2; ++ring)
        for (int i = 0; i < sides; ++i) {
            const double a = 6.283185307179586 * i / sides;
            const Vec3 out = std::cos(a) * f.t + std::sin(a) * f.b;
            solid.positions.push_back(Vec3f(mouth + radius * out + (ring * length) * up));
            solid.normals.push_back(Vec3f(out));
            solid.colours.push_back(kFerrule);
        }
    for (std::uint32_t i = 0; i < sides; ++i) {
        const std::uint32_t j = (i + 1) % sides;
        for (const std::uint32_t v : {i, j, sides + j, i, sides + j, sides + i})
            solid.triangles.push_back(base + v);
    }
}

}  // namespace

Studio::Studio(GLFWwindow* window)
    : window_(window),
      scene_(std::make_unique<render::GlScene>()),
      brushes_(brush::list_presets()),
      inks_(ink::list_inks()) {
    std::error_code ec;
    for (const auto& entry : fs::directory_iterator(data_folder() / "models", ec))
        if (entry.path().extension() == ".ply") samples_.push_back(entry.path().string());
    std::sort(samples_.begin(), samples_.end());
}

Studio::~Studio() = default;

void Studio::open(const fs::path& path) { document_.open(path, open_options_); }

render::GlCamera Studio::camera() const {
    return orbit_.camera(width_, height_, document_.model() ? document_.model()->mesh->bounds : Box{{-1, -1, -1}, {1, 1, 1}});
}

void Studio::welcome() {
    ImGui::SetNextWindowPos(ImVec2(0.5f * static_cast<float>(width_), 0.5f * static_cast<float>(height_)),
                            ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(ImVec2(460, 0));
    ImGui::Begin("tuft studio", nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove);
    ImGui::TextWrapped("Drop a model or a project on this window, type its path, or start with a sample.");
    ImGui::Spacing();
    ImGui::SetNextItemWidth(350);
    const bool entered = ImGui::InputTextWithHint("##path", "path of a .ply, .obj, .stl, .glb or .tuft file", path_text_,
                                                  sizeof path_text_, ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if ((ImGui::Button("Open", ImVec2(80, 0)) || entered) && path_text_[0]) open(path_text_);
    static const std::vector<std::string> units{"um", "mm", "cm", "m", "in", "ft"};
    ImGui::SetNextItemWidth(90);
    combo("unit of the model", open_options_.unit, units);
    ImGui::Separator();
    for (const std::string& sample : samples_)
        if (ImGui::Selectable(fs::path(sample).stem().string().c_str())) open(sample);
    if (!document_.message.empty()) {
        ImGui::Separator();
        ImGui::TextWrapped("%s", document_.message.c_str());
    }
    ImGui::End();
}

void Studio::opening_panel() {
    const auto [phase, fraction] = document_.opening_progress();
    ImGui::SetNextWindowPos(ImVec2(0.5f * static_cast<float>(width_), 0.5f * static_cast<float>(height_)),
                            ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(ImVec2(360, 0));
    ImGui::Begin("Opening", nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoMove);
    ImGui::Text("%s", phase.c_str());
    ImGui::ProgressBar(static_cast<float>(fraction), ImVec2(-1, 0));
    if (ImGui::Button("Cancel")) document_.cancel_opening();
    ImGui::End();
}

void Studio::tool_panel() {
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(kPanelWidth, static_cast<float>(height_) - 26));
    ImGui::Begin("Tools", nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse);
    ImGui::PushItemWidth(150);
    combo("brush", brush_, brushes_);
    combo("ink", ink_, inks_);
    const auto slider = [](const char* label, double& value, double lo, double hi, const char* format) {
        auto v = static_cast<float>(value);
        if (ImGui::SliderFloat(label, &v, static_cast<float>(lo), static_cast<float>(hi), format)) value = v;
    };
    slider("pressure", hand_settings_.pressure, 0.02, 1, "%.2f");
    slider("speed lightens", hand_settings_.speed_effect, 0, 1, "%.2f");
    slider("smoothing", hand_settings_.smoothing, 0, 0.2, "%.3f s");
    ImGui::Separator();
    int shading = static_cast<int>(shading_);
    ImGui::RadioButton("light", &shading, 0);
    ImGui::SameLine();
    ImGui::RadioButton("flat", &shading, 1);
    ImGui::SameLine();
    ImGui::RadioButton("texels", &shading, 2);
    shading_ = static_cast<render::Shading>(shading);
    if (ImGui::Button("Frame all")) orbit_.frame(document_.model()->mesh->bounds, static_cast<double>(width_) / std::max(1, height_));
    ImGui::Separator();
    if (ImGui::Button("Undo")) document_.undo();
    ImGui::SameLine();
    if (ImGui::Button("Redo")) document_.redo();
    ImGui::Separator();
    ImGui::SetNextItemWidth(-1);
    ImGui::InputTextWithHint("##file", "file to write", path_text_, sizeof path_text_);
    if (ImGui::Button("Save as") && path_text_[0]) document_.save_as(path_text_);
    ImGui::SameLine();
    if (ImGui::Button("Export") && path_text_[0]) document_.export_model(path_text_);
    ImGui::PopItemWidth();
    ImGui::Separator();
    journal_panel();
    ImGui::End();
}

void Studio::journal_panel() {
    const auto& strokes = document_.painting()->journal().strokes();
    ImGui::Text("%zu strokes", strokes.size());
    ImGui::BeginChild("journal");
    for (auto it = strokes.rbegin(); it != strokes.rend(); ++it)
        ImGui::Text("%llu  %s, %s", static_cast<unsigned long long>(it->id), it->trace.brush.c_str(), it->trace.ink.c_str());
    ImGui::EndChild();
}

void Studio::status_bar() {
    ImGui::SetNextWindowPos(ImVec2(0, static_cast<float>(height_) - 26));
    ImGui::SetNextWindowSize(ImVec2(static_cast<float>(width_), 26));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(8, 4));
    ImGui::Begin("status", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove);
    const brush::TuftState* tuft = document_.painting() ? document_.painting()->tuft() : nullptr;
    if (tuft && tuft->touching)
        ImGui::Text("force %.3f N   moment %.2f mNm", tuft->normal_force, tuft->root_moment * 1e3);
    else
        ImGui::Text("%s", document_.message.empty() ? "left: paint   middle: turn   shift+middle: pan   wheel: zoom   ctrl+Z: undo"
                                                    : document_.message.c_str());
    ImGui::End();
    ImGui::PopStyleVar();
}

void Studio::view_input() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantCaptureMouse) return;
    const ImVec2 d = io.MouseDelta;
    const bool turn = ImGui::IsMouseDown(ImGuiMouseButton_Middle) ||
                      (ImGui::IsMouseDown(ImGuiMouseButton_Right) && !io.KeyShift);
    if (turn && !io.KeyShift) orbit_.turn(d.x, d.y);
    else if (ImGui::IsMouseDown(ImGuiMouseButton_Middle) || ImGui::IsMouseDown(ImGuiMouseButton_Right)) orbit_.pan(d.x, d.y, height_);
    if (io.MouseWheel != 0) orbit_.zoom(io.MouseWheel);
}

void Studio::paint_input(double time) {
    stroke::Painting* painting = document_.painting();
    const ImGuiIO& io = ImGui::GetIO();
    const bool held = ImGui::IsMouseDown(ImGuiMouseButton_Left);
    if (!hand_ && held && !io.WantCaptureMouse && ImGui::IsMouseClicked(ImGuiMouseButton_Left)) {
        document_.begin(brush_, ink_);
        hand_.emplace(*document_.model()->query, painting->brush(brush_), hand_settings_);
        stroke_start_ = time;
    }
    if (!hand_) return;
    if (held) {
        const render::GlCamera c = camera();
        document_.extend(hand_->move(c.eye, ray_through(c, io.MousePos.x, io.MousePos.y), time - stroke_start_));
    } else {
        document_.extend(hand_->lift(time - stroke_start_));
        document_.end();
        hand_.reset();
    }
}

void Studio::shortcuts() {
    const ImGuiIO& io = ImGui::GetIO();
    if (io.WantTextInput || hand_) return;
    const bool z = ImGui::IsKeyPressed(GLFW_KEY_Z);
    if (io.KeyCtrl && z && io.KeyShift) document_.redo();
    else if (io.KeyCtrl && z) document_.undo();
    else if (io.KeyCtrl && ImGui::IsKeyPressed(GLFW_KEY_Y)) document_.redo();
    else if (ImGui::IsKeyPressed(GLFW_KEY_HOME))
        orbit_.frame(document_.model()->mesh->bounds, static_cast<double>(width_) / std::max(1, height_));
}

void Studio::upload_changes() {
    stroke::Painting& p = *document_.painting();
    const std::vector<std::uint32_t> slots = p.take_dirty();
    if (slots.empty()) return;
    ink::refresh_srgb8(colour_, slots, p.canvas(), document_.model()->texels, p.substrate());
    std::vector<std::uint32_t> tiles;
    for (const std::uint32_t slot : slots) tiles.push_back(document_.model()->texels.tile_of_slot[slot]);
    scene_->update_tiles(colour_, tiles, static_cast<int>(document_.model()->atlas.gutter));
}

render::GlSolid Studio::tuft_solid() const {
    render::GlSolid solid;
    const stroke::Painting* painting = const_cast<Document&>(document_).painting();
    const brush::TuftState* tuft = painting ? painting->tuft() : nullptr;
    if (!tuft || tuft->branches.empty()) return solid;
    const brush::Skin skin = brush::make_skin(*tuft);
    for (std::size_t i = 0; i < skin.positions.size(); ++i) {
        solid.positions.push_back(Vec3f(skin.positions[i]));
        solid.normals.push_back(Vec3f(skin.normals[i]));
        solid.colours.push_back(kHair);
    }
    solid.triangles = skin.triangles;
    const brush::Section& root = tuft->branches.front().sections.back();
    const double radius = std::max(root.a, root.b);
    add_holder(solid, root.centre, -root.tangent, 1.05 * radius, 12 * radius);
    return solid;
}

void Studio::frame() {
    glfwGetFramebufferSize(window_, &width_, &height_);
    if (document_.poll()) {
        const stroke::Model& m = *document_.model();
        scene_->set_mesh(*m.mesh, m.atlas.corner_uvs);
        colour_ = ink::compose_srgb8(document_.painting()->canvas(), m.texels, document_.painting()->substrate());
        document_.painting()->take_dirty();
        scene_->set_base_colour(colour_);
        orbit_ = Orbit{};
        orbit_.frame(m.mesh->bounds, static_cast<double>(width_) / std::max(1, height_));
        hand_.reset();
    }
    const bool ready = document_.painting() != nullptr;
    if (ready && !document_.opening()) {
        view_input();
        paint_input(glfwGetTime());
        shortcuts();
        upload_changes();
    }
    const render::GlCamera c = camera();
    scene_->clear(c);
    if (ready) {
        scene_->draw_model(c, shading_, document_.painting()->substrate().roughness);
        scene_->draw_solid(c, tuft_solid(), 0.85f);
        tool_panel();
        status_bar();
    } else if (!document_.opening()) {
        welcome();
    }
    if (document_.opening()) opening_panel();
}

}  // namespace tuft::app
