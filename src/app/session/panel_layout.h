#pragma once

#include "app/session/help_state.h"

/// \file
/// Layout of the panels. Window thread.
namespace tuft::app {

/// Which panels are shown, and which of their sections are open.
struct PanelLayout {
    bool show_tools = true, show_journal = true;
    bool journal_fits = true;           ///< there is space for the journal beside the model
    bool journal_over_tools = false;    ///< without that space: the journal replaces the tools
    bool show_appearance = false;       ///< in place of the tools: recolouring and substrate
    bool show_pointer_details = false;  ///< all settings of the pointer
    int pen_curve_handle = 1;           ///< selected handle of the pen curve: 0 lower end, 1 middle, 2 upper end
    HelpState help;
};

}  // namespace tuft::app
