#pragma once

#include <array>
#include <initializer_list>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "core/geometry/types.h"
#include "core/message.h"

struct ImFont;

namespace tuft::app {

enum class Language { english, chinese };
enum class Theme { dark, light };

struct UiSettings {
    Language language = Language::english;
    Theme theme = Theme::dark;
    float scale = 1;           ///< of all sizes
    bool own_scale = false;    ///< chosen by the person; else it follows the display
    bool left_handed = false;  ///< tools on the right
};

/// The scale for a picture of that size on a display that asks for `content`: what it asks for, and at least as much
/// as the picture is larger than 1920 × 1080, in quarters, 1 to 3.
float scale_for(float content, int width, int height);

/// A font with Chinese characters among these files, the best one first; "" when there is none.
std::string find_chinese_font(const std::map<std::string, std::string>& path_by_name);

/// Widgets in the house's look, with translated texts and hints. They are named by their
/// English text; where each was drawn is kept, so that a script can find it.
class Ui {
  public:
    /// Makes fonts and colours. Returns what could not be had, empty if nothing.
    Message prepare(const UiSettings& settings);
    const UiSettings& settings() const { return settings_; }

    /// The text in the chosen language.
    const char* tr(const char* english) const;
    /// Name of a brush or an ink for people: "mixed-medium*1.8" as "Mixed, medium × 1.8", the factor with two digits.
    std::string title(const std::string& name) const;
    /// The text, with "..." for its end where it is wider than so many pixels.
    std::string fitted(const std::string& text, float width) const;
    /// A message, in the language of the interface.
    std::string sentence(const Message& message) const;
    /// Pixels of a length given for a scale of 1.
    float px(float length) const { return length * settings_.scale; }

    void begin_frame();
    bool enter = false;  ///< Enter was pressed: the primary button of the dialog takes it
    bool in_dialog = false;
    bool in_menu = false;  ///< what is drawn now is a menu over the rest: its names go before those below
    bool modal = false;    ///< a dialog is open: what lies behind it says nothing
    bool button(const char* label, const char* hint = nullptr, float width = 0, bool enabled = true);
    /// Pixels of a button's width: at least `least` at a scale of 1, and as much as the text needs.
    float button_width(const char* label, float least) const;
    bool primary_button(const char* label, float width = 0, bool enabled = true);
    bool toggle(const char* label, bool& value, const char* hint = nullptr);
    bool choice(const char* label, bool chosen, const char* hint = nullptr, float width = 0);
    bool slider(const char* label, double& value, double lo, double hi, const char* format, const char* hint = nullptr,
                double unit = 1);
    /// A slider with its name in it, so many pixels wide.
    bool named_slider(const char* label, double& value, double lo, double hi, const char* format, const char* hint,
                      double unit, float width);
    bool combo(const char* label, std::string& value, const std::vector<std::string>& names, float width = 0);
    bool menu_item(const char* label, const char* shortcut = nullptr, bool chosen = false, bool enabled = true);
    bool begin_menu(const char* label);
    void heading(const char* text);
    /// A heading that a click folds and unfolds; true when what is under it is to be drawn. `open`: as shipped;
    /// `value`: what is chosen there, already in the chosen language, at the heading's right end.
    bool section(const char* title, bool open = true, const char* value = nullptr);
    /// The triangle of such a heading with its middle at a place of the window, pixels.
    void fold_arrow(float x, float y, bool open) const;
    std::map<std::string, bool> sections;  ///< open or not, of those that were clicked
    bool sections_changed = false;         ///< since the last look
    void hint(const char* text);
    void wrapped(const std::string& text);
    /// Small grey text.
    void note(const std::string& text);

    /// Remembers where the last item is, under a name.
    void mark(const std::string& name);
    struct Place {
        double x = 0, y = 0;  ///< pixels, centre
        bool on_top = false;  ///< in a menu that lies over the rest
    };
    /// Where the widget of that name was in the last frame; nullptr: it was not drawn.
    const Place* find(const std::string& name) const;
    std::vector<std::string> names() const;

    /// Starts a row of buttons that ends at the right edge: labels, and least widths as for `button`.
    void buttons_at_right(std::initializer_list<std::pair<const char*, float>> buttons) const;

    ImFont* large = nullptr;
    bool has_chinese = false;                    ///< a font of the system has Chinese characters
    unsigned accent = 0, faint = 0, strong = 0;  ///< ImU32 colours of the theme

  private:
    std::string id(const char* label) const;
    bool bare_slider(const char* label, double& value, double lo, double hi, const char* format, double unit,
                     float width);
    void style();

    UiSettings settings_;
    std::map<std::string, Place> places_;
};

/// sRGB of the primary button, at rest and under the cursor; its text is white.
inline constexpr float kPrimary[3] = {0.16f, 0.40f, 0.78f}, kPrimaryHovered[3] = {0.17f, 0.43f, 0.82f};

}  // namespace tuft::app
