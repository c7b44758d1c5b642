#pragma once

#include "app/state/help_state.h"

/// \file
/// Layout of the panels. Window thread.
namespace tuft::app {

/// Room for the settings of the tools: `compact` has smaller brushes and names of inks in one line, `tight` no names
/// under either.
enum class ToolDensity { full, compact, tight };

/// Which panels are shown, and which of their sections are open.
struct PanelLayout {
    bool show_tools = true, show_journal = true;
    bool journal_fits = true;                   ///< there is space for the journal beside the model
    bool journal_over_tools = false;            ///< without that space: the journal replaces the tools
    bool show_appearance = false;               ///< in place of the tools: recolouring and substrate
    ToolDensity tool_room = ToolDensity::full;  ///< that there is for them
    bool show_brushes = false;                  ///< the window with all brushes
    char brush_filter[64] = "";                 ///< letters of the names that it lists
    int pen_curve_handle = 1;  ///< selected handle of the pen curve: 0 lower end, 1 middle, 2 upper end
    HelpState help;
};

}  // namespace tuft::app
