#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/document/pictures.h"
#include "app/widgets/file_list.h"
#include "app/widgets/ui.h"

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
    void return_with(const std::filesystem::path& path, const std::string& fault);

  private:
    struct Chosen {
        std::filesystem::path path;
        Purpose purpose = Purpose::open;
    };
    void read_folder();
    void go(const std::filesystem::path& folder);
    void choose_name(const std::string& name);
    void refuse(const std::string& why);
    void make_folder(Ui& ui);
    bool suits(const std::filesystem::path& file) const;
    std::optional<std::filesystem::path> accept();
    void draw_places(Ui& ui);
    void draw_top(Ui& ui);
    bool draw_list(Ui& ui, float width);
    void draw_preview(Ui& ui, Pictures& pictures, float width);
    bool draw_name(Ui& ui);
    void load_sketch();

    bool shown_ = false, ask_replace_ = false;
    Purpose purpose_ = Purpose::open;
    std::filesystem::path folder_;
    std::vector<FileEntry> entries_;
    FileOrder order_ = FileOrder::name;
    bool downward_ = false;
    std::string fault_;
    std::string extension_;  ///< that a name without one gets
    char name_[512] = "", filter_[128] = "", new_folder_[256] = "";
    bool asks_folder_ = false;  ///< a name for a new folder
    bool take_focus_ = false,
         select_stem_ = false;    ///< the name field is to have the keyboard; its name up to the dot is to be selected
    std::optional<Chosen> last_;  ///< what was chosen last
    std::string sketched_;        ///< file whose lines are shown
    std::vector<std::vector<Vec2>> sketch_;  ///< in [0, 1], y down
};

/// Folders that files were chosen in, the newest first.
std::vector<std::filesystem::path> recent_folders();
void remember_folder(const std::filesystem::path& folder);

}  // namespace tuft::app
