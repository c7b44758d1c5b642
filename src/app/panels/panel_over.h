#pragma once

#include "app/view/view_state.h"
#include "app/widgets/ui.h"

/// \file
/// Panels over the view: where they stand, and what they have in common. Window thread.
namespace tuft::app {

/// A panel over the view. It keeps a margin to the view's edges, is no larger than what is left, and takes no keyboard
/// when it appears.
struct PanelOver {
    const char* name = "";       ///< its identity; its title where it has a bar, with an entry in the catalogues
    float across = 0, down = 0;  ///< place in the room: 0 left or top, 0.5 in the middle, 1 right or bottom
    float width = 0;             ///< pixels; 0: as wide as its content
    float height = 0;            ///< pixels; 0: as high as its content
    float alpha = 0.95f;         ///< opacity of its background
    bool has_bar = false;        ///< a bar with its title that rolls it up
    bool moves = false;          ///< it can be dragged, as far as it stays in the view
    bool below = false;          ///< the others come over it
    bool takes_input = true;     ///< else the cursor is on what is under it
    bool* shown = nullptr;       ///< its bar has a button that resets this
};

/// Margin round panels over the view, pixels at a scale of 1; the handles of the side panels fit into it.
inline constexpr float kPanelMargin = 12;

/// Begins a panel; end it with ImGui::End. Returns false where its content is not seen. `area`: of the view, pixels.
bool begin_panel_over(const Ui& ui, const Area& area, const PanelOver& panel);

}  // namespace tuft::app
