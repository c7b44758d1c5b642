#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/panels/ui.h"

namespace tuft::app {

/// Choosing a file to open, or a name to write to.
class FileDialog {
  public:
    enum class Purpose { open, save, export_model, writing, revise, ink, save_ink };

    void show(Purpose purpose, const std::filesystem::path& start);
    bool shown() const { return shown_; }
    void close() { shown_ = false; }
    Purpose purpose() const { return purpose_; }
    bool reads() const;           ///< a file that is there; else one to be written
    const std::filesystem::path& folder() const { return folder_; }
    /// Draws it; a path when one was chosen.
    std::optional<std::filesystem::path> draw(Ui& ui);

  private:
    struct Entry {
        std::string name;
        bool folder = false;
        std::uintmax_t size = 0;
    };
    void read_folder();
    void go(const std::filesystem::path& folder);
    bool suits(const std::filesystem::path& file) const;
    std::optional<std::filesystem::path> accept(Ui& ui);

    bool shown_ = false, ask_replace_ = false;
    Purpose purpose_ = Purpose::open;
    std::filesystem::path folder_;
    std::vector<Entry> entries_;
    std::string fault_;
    std::string extension_;       ///< that a name without one gets
    char name_[512] = "";
};

}  // namespace tuft::app
