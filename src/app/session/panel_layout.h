#pragma once

#include "app/session/help_state.h"

namespace tuft::app {

/// How much room the settings of the tools have: `compact` has smaller brushes and names of inks in one line, `tight`
/// no names under either.
enum class ToolRoom { full, compact, tight };

/// Which panels stand beside the view, and what is unfolded in them.
struct PanelLayout {
    bool show_tools = true, show_journal = true;
    bool journal_fits = true;             ///< beside the model
    bool journal_over_tools = false;      ///< where it does not fit: in place of the tools
    bool show_appearance = false;         ///< in place of the tools: other inks and another material
    ToolRoom tool_room = ToolRoom::full;  ///< that there is for them
    int pen_curve_handle = 1;             ///< of the pen's pressure curve: 0 lower end, 1 middle, 2 upper end
    HelpState help;
};

}  // namespace tuft::app
