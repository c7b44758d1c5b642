#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/document/pictures.h"
#include "app/widgets/file_list.h"
#include "app/widgets/ui.h"
#include "core/message.h"

namespace tuft::app {

/// Choosing a file to open, or a name to write to.
class FileDialog {
  public:
    enum class Purpose { open, save, export_model, writing, revise, ink, save_ink, reference };

    void show(Purpose purpose, const std::filesystem::path& start);
    bool shown() const { return shown_; }
    void close() { shown_ = false; }
    Purpose purpose() const { return purpose_; }
    bool reads() const;  ///< a file that is there; else one to be written
    const std::filesystem::path& folder() const { return folder_; }
    /// Draws it; a path when one was chosen.
    std::optional<std::filesystem::path> draw(Ui& ui, Pictures& pictures);

    /// Comes back with the name that was chosen last and the reason, where writing to `path` failed and that was
    /// the one chosen here.
    void return_with(const std::filesystem::path& path, const Message& fault);

  private:
    struct Chosen {
        std::filesystem::path path;
        Purpose purpose = Purpose::open;
    };
    void read_folder();
    void go(const std::filesystem::path& folder);
    void choose_name(const std::string& name);
    void refuse(const Message& why);
    void make_folder(Ui& ui);
    bool suits(const std::filesystem::path& file) const;
    std::optional<std::filesystem::path> accept();
    void draw_places(Ui& ui);
    void draw_top(Ui& ui);
    bool draw_list(Ui& ui, float width);
    void draw_preview(Ui& ui, Pictures& pictures, float width);
    bool draw_name(Ui& ui);
    void load_sketch();

    /// What the folder holds, and how it is listed.
    struct Listing {
        std::vector<FileEntry> entries;
        FileOrder order = FileOrder::name;
        bool downward = false;
        char filter[128] = "";
    };
    struct NameField {
        char text[512] = "";
        std::string extension;     ///< that a name without one gets
        bool take_focus = false;   ///< it is to have the keyboard
        bool select_stem = false;  ///< the name up to the dot is to be selected
    };
    struct NewFolder {
        bool asked = false;  ///< for its name
        char name[256] = "";
    };
    /// Lines of a drawing, for its preview.
    struct Sketch {
        std::string file;
        std::vector<std::vector<Vec2>> lines;  ///< in [0, 1], y down
    };

    bool shown_ = false, ask_replace_ = false;
    Purpose purpose_ = Purpose::open;
    std::filesystem::path folder_;
    Listing listing_;
    NameField name_;
    NewFolder new_folder_;
    Sketch sketch_;
    Message fault_;
    std::optional<Chosen> last_;  ///< what was chosen last
};

/// Folders that files were chosen in, the newest first.
std::vector<std::filesystem::path> recent_folders();
void remember_folder(const std::filesystem::path& folder);

}  // namespace tuft::app
