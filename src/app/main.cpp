#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl3.h>
#include <imgui.h>

#include <cstdio>
#include <cstring>
#include <exception>

#include "app/studio.h"

namespace {

tuft::app::Studio* g_studio = nullptr;

void on_drop(GLFWwindow*, int count, const char** paths) {
    if (g_studio && count > 0) g_studio->open(paths[0]);
}

int fail(const char* what) {
    std::fprintf(stderr, "tuft-studio: %s\n", what);
    return 1;
}

int run(const char* path) {
    if (!glfwInit()) return fail("no display could be opened; set DISPLAY, or use 'tuft' without a window");
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 3);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 3);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_OPENGL_FORWARD_COMPAT, GLFW_TRUE);
    glfwWindowHint(GLFW_SAMPLES, 4);
    GLFWwindow* window = glfwCreateWindow(1280, 720, "tuft studio", nullptr, nullptr);
    if (!window) {
        glfwTerminate();
        return fail("no window with OpenGL 3.3 could be opened; a newer graphics driver is needed");
    }
    glfwMakeContextCurrent(window);
    glfwSwapInterval(1);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;
    ImGui::StyleColorsDark();
    ImGui::GetStyle().WindowRounding = 4;
    ImGui_ImplGlfw_InitForOpenGL(window, true);
    ImGui_ImplOpenGL3_Init("#version 330");
    int status = 0;
    try {
        tuft::app::Studio studio(window);
        g_studio = &studio;
        glfwSetDropCallback(window, on_drop);
        if (path) studio.open(path);
        while (!glfwWindowShouldClose(window)) {
            glfwPollEvents();
            ImGui_ImplOpenGL3_NewFrame();
            ImGui_ImplGlfw_NewFrame();
            ImGui::NewFrame();
            studio.frame();
            ImGui::Render();
            ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
            glfwSwapBuffers(window);
        }
        g_studio = nullptr;
    } catch (const std::exception& error) {
        status = fail(error.what());
    }
    ImGui_ImplOpenGL3_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window);
    glfwTerminate();
    return status;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1 && (!std::strcmp(argv[1], "--help") || !std::strcmp(argv[1], "-h"))) {
        std::puts("Usage: tuft-studio [MODEL|PROJECT]\nDecorate a 3D model with ink and a bending brush.");
        return 0;
    }
    if (argc > 1 && !std::strcmp(argv[1], "--version")) {
        std::puts("tuft-studio " TUFT_VERSION);
        return 0;
    }
    if (argc > 2 || (argc == 2 && argv[1][0] == '-')) {
        std::fprintf(stderr, "tuft-studio: unknown option '%s' (see --help)\n", argv[argc - 1]);
        return 2;
    }
    return run(argc > 1 ? argv[1] : nullptr);
}
