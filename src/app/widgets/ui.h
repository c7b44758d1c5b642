#pragma once

#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/geometry/types.h"
#include "core/message.h"

struct ImDrawData;
struct ImFont;

/// \file
/// Widgets of the studio on top of Dear ImGui. Window thread.
namespace tuft::app {

enum class Language { english, chinese };
enum class Theme { dark, light };

/// Settings of the interface.
struct UiSettings {
    Language language = Language::english;
    Theme theme = Theme::dark;
    float scale = 1;           ///< factor on all sizes
    bool own_scale = false;    ///< set by the user; else it follows the display
    bool left_handed = false;  ///< tools on the right
};

/// Returns the scale for a window of that size in pixels: the display's `content` scale, and at least the window's size
/// over 1920 × 1080, in steps of 1/4, from 1 to 3.
float scale_for(float content, int width, int height);

/// Returns the best font with Chinese characters among these files; "" when there is none.
std::string find_chinese_font(const std::map<std::string, std::string>& path_by_name);

/// Range and display of a slider.
struct SliderRange {
    double lo = 0, hi = 1;        ///< in the value's unit, lo < hi
    const char* format = "%.2f";  ///< printf format of the shown number
    double unit = 1;              ///< value of a shown 1, > 0: 1e-3 shows metres in millimetres
};

/// Styled widgets with translated texts and hints. A widget is named by its English text. Its position is recorded, so
/// that a script can find it.
class Ui {
  public:
    /// Loads fonts and sets colours. Returns the fault, or an empty message.
    Message prepare(const UiSettings& settings);
    /// Whether a frame shows characters, such as those of a file's name, that `prepare` has not loaded yet; it loads
    /// them the next time. False for those that no font has.
    bool lacks_characters(const ImDrawData& drawn);
    const UiSettings& settings() const { return settings_; }

    /// Returns a text in the chosen language.
    const char* tr(const char* english) const;
    /// Returns the shown name of a brush or an ink: "mixed-medium*1.8" gives "Mixed, medium × 1.8", two digits.
    std::string title(const std::string& name) const;
    /// Returns the text shortened with "..." to at most `width` pixels.
    std::string fitted(const std::string& text, float width) const;
    /// Returns a message in the chosen language.
    std::string sentence(const Message& message) const;
    /// Converts a length at scale 1 to pixels.
    float px(float length) const { return length * settings_.scale; }

    /// Begins a frame: forgets the places of the widgets of the frame before.
    void begin_frame();
    bool enter = false;  ///< Enter was pressed; the dialog's primary button takes it
    bool in_dialog = false;
    bool in_menu = false;  ///< a menu over the rest is drawn now; `find` prefers its widgets
    bool modal = false;    ///< a dialog is open; widgets behind it show no hints
    bool button(const char* label, const char* hint = nullptr, float width = 0, bool enabled = true);
    /// Returns a button's width in pixels: at least `least` at scale 1, and enough for the text.
    float button_width(const char* label, float least) const;
    bool primary_button(const char* label, float width = 0, bool enabled = true);
    bool toggle(const char* label, bool& value, const char* hint = nullptr);
    bool choice(const char* label, bool chosen, const char* hint = nullptr, float width = 0);
    /// A row of a list. A chosen one stays coloured under the cursor. `height`: pixels, 0: of one line.
    bool entry(const char* label, bool chosen, float height = 0);
    /// Returns true when the value changed. It is clamped to the range only then.
    bool slider(const char* label, double& value, const SliderRange& range, const char* hint = nullptr);
    /// As `slider`, with its name in it and `width` pixels wide.
    bool named_slider(const char* label, double& value, const SliderRange& range, const char* hint, float width);
    bool combo(const char* label, std::string& value, const std::vector<std::string>& names, float width = 0);
    bool menu_item(const char* label, const char* shortcut = nullptr, bool chosen = false, bool enabled = true);
    bool begin_menu(const char* label);
    void heading(const char* text);
    /// A heading that a click opens and closes. Returns true when its content is to be drawn. `open`: initial state.
    /// `value`: text at the heading's right end, already translated.
    bool section(const char* title, bool open = true, const char* value = nullptr);
    /// Draws the triangle of such a heading, centred at a position of the window in pixels.
    void fold_arrow(float x, float y, bool open) const;
    std::map<std::string, bool> sections;  ///< open or not, of the sections that were clicked
    bool sections_changed = false;         ///< since it was last reset
    void hint(const char* text);
    void wrapped(const std::string& text);
    /// Small grey text.
    void note(const std::string& text);

    /// Records the position of the last item under a name.
    void mark(const std::string& name);
    /// Records a point of the window, pixels, under a name.
    void mark_at(const std::string& name, float x, float y);
    struct Place {
        double x = 0, y = 0;  ///< pixels, centre
        bool on_top = false;  ///< in a menu over the rest
    };
    /// Returns where the widget of that name was in the last frame; nullptr when it was not drawn.
    const Place* find(const std::string& name) const;
    std::vector<std::string> names() const;

    /// Starts a row of buttons that ends at the right edge: labels, and least widths as for `button`.
    void buttons_at_right(std::initializer_list<std::pair<const char*, float>> buttons) const;

    ImFont* large = nullptr;
    bool has_chinese = false;                    ///< a font of the system has Chinese characters
    unsigned accent = 0, faint = 0, strong = 0;  ///< ImU32 colours of the theme
    unsigned wrong = 0;                          ///< of a text that says what went wrong

  private:
    std::string id(const char* label) const;
    bool bare_slider(const char* label, double& value, const SliderRange& range, float width);
    void style();

    UiSettings settings_;
    std::set<unsigned> characters_;  // that were drawn, besides those of the interface's own texts
    std::map<std::string, Place> places_;
    std::optional<std::array<float, 2>> pressed_;  // place of the item without a hint until the cursor leaves it
};

/// sRGB of the primary button, normal and under the cursor. Its text is white.
inline constexpr float kPrimary[3] = {0.16f, 0.40f, 0.78f}, kPrimaryHovered[3] = {0.17f, 0.43f, 0.82f};

}  // namespace tuft::app
