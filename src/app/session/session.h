#pragma once

#include <memory>

#include "app/paint/paint_thread.h"
#include "app/state/arm_state.h"
#include "app/state/brush_settings.h"
#include "app/state/colour_state.h"
#include "app/state/dialog_state.h"
#include "app/state/journal_state.h"
#include "app/state/layer_state.h"
#include "app/state/mask_state.h"
#include "app/state/panel_layout.h"
#include "app/state/part_state.h"
#include "app/state/project_state.h"
#include "app/state/tool_state.h"
#include "app/view/view_state.h"
#include "app/widgets/preferences.h"
#include "app/widgets/status_message.h"
#include "app/widgets/ui.h"

/// \file
/// The state of the window. Window thread.
namespace tuft::app {

/// All state of the window, as plain data in parts. Panels read and change it.
struct Session {
    Ui ui;
    Preferences preferences;
    PanelLayout panels;
    DialogState dialogs;
    StatusMessage status;

    ProjectState project;
    std::unique_ptr<PaintThread> paint_thread;  ///< of the open model; null: none
    PaintStatus reported;                       ///< status of the paint thread at the last poll

    ViewState view;
    ToolState tools;
    BrushSettings brush;
    LayerState layers;
    MaskState masks;
    PartState parts;
    ColourState colours;
    JournalState journal;
    ArmState arm;
};

/// Takes the results of all background threads.
void poll_session(Session& s);
/// Takes the results of the paint thread.
void poll_paint_thread(Session& s);
/// Returns true when nothing runs or waits in the background.
bool is_settled(const Session& s);

}  // namespace tuft::app
