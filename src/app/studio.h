#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/document.h"
#include "app/mouse_hand.h"
#include "app/viewport.h"
#include "render/gl_scene.h"

struct GLFWwindow;

namespace tuft::app {

/// The window's content: panels, tools and the view of the model.
class Studio {
  public:
    explicit Studio(GLFWwindow* window);
    ~Studio();

    void open(const std::filesystem::path& path);
    /// One turn of the loop: input, simulation, panels, picture.
    void frame();

  private:
    void welcome();
    void tool_panel();
    void journal_panel();
    void opening_panel();
    void status_bar();
    void view_input();
    void paint_input(double time);
    void shortcuts();
    void upload_changes();
    render::GlSolid tuft_solid() const;
    render::GlCamera camera() const;

    GLFWwindow* window_;
    Document document_;
    std::unique_ptr<render::GlScene> scene_;
    ink::AtlasMap<std::uint8_t> colour_;
    Orbit orbit_;
    render::Shading shading_ = render::Shading::lit;
    HandSettings hand_settings_;
    std::optional<MouseHand> hand_;
    double stroke_start_ = 0;
    std::vector<std::string> brushes_, inks_, samples_;
    std::string brush_ = "wolf-medium", ink_ = "carbon";
    Document::Options open_options_;
    int width_ = 0, height_ = 0;
    char path_text_[1024] = "";
};

}  // namespace tuft::app
