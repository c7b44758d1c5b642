#pragma once

#include <filesystem>
#include <future>
#include <optional>
#include <string>
#include <vector>

#include "app/document/pictures/pictures.h"
#include "app/widgets/file_list.h"
#include "app/widgets/ui.h"
#include "core/message.h"

/// \file
/// The file dialog. Window thread.
namespace tuft::app {

/// Chooses a file to open, or a name to write to.
class FileDialog {
  public:
    enum class Purpose {
        open,
        save,
        export_model,
        writing,
        revise,
        ink,
        save_ink,
        reference,
        arm_recording,
        decals,
        film,
        glyphs,
        brush,
        copied_picture,
        save_copy
    };

    FileDialog() = default;
    ~FileDialog();  ///< does not wait for a preview that a disk never gives
    FileDialog(const FileDialog&) = delete;
    FileDialog& operator=(const FileDialog&) = delete;

    void show(Purpose purpose, const std::filesystem::path& start);
    bool shown() const { return shown_; }
    void close() { shown_ = false; }
    bool busy() const;  ///< the preview is being read
    Purpose purpose() const { return purpose_; }
    bool reads() const;  ///< true: an existing file is chosen; false: a file to write
    const std::filesystem::path& folder() const { return folder_; }
    /// Draws the dialog. Returns the chosen path, once.
    std::optional<std::filesystem::path> draw(Ui& ui, Pictures& pictures);

    /// Opens again with the last choice and the reason, when writing to `path` failed and `path` was chosen here.
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

    /// Content of the folder and how it is listed.
    struct Listing {
        std::vector<FileEntry> entries;
        FileOrder order = FileOrder::name;
        bool downward = false;
        char filter[128] = "";
    };
    struct NameField {
        char text[512] = "";
        std::string extension;     ///< added to a name without one
        bool take_focus = false;   ///< takes the keyboard in the next frame
        bool select_stem = false;  ///< selects the name up to the dot in the next frame
    };
    struct NewFolder {
        bool shown = false;  ///< the field for its name
        char name[256] = "";
    };
    /// Lines of a drawing, for the preview.
    struct Sketch {
        std::string file;
        std::vector<std::vector<Vec2>> lines;                 ///< `read_sketch`; empty while they are read
        std::future<std::vector<std::vector<Vec2>>> reading;  ///< on a thread of its own
    };

    bool shown_ = false, ask_replace_ = false;
    Purpose purpose_ = Purpose::open;
    std::filesystem::path folder_;
    Listing listing_;
    NameField name_;
    NewFolder new_folder_;
    Sketch sketch_;
    Message fault_;
    std::optional<Chosen> last_;  ///< last choice
};

/// Folders of recently chosen files, newest first.
std::vector<std::filesystem::path> recent_folders();
void remember_folder(const std::filesystem::path& folder);

}  // namespace tuft::app
