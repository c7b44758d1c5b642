#pragma once

#include <memory>

#include "app/paint/paint_thread.h"
#include "app/session/arm_state.h"
#include "app/session/brush_settings.h"
#include "app/session/colour_state.h"
#include "app/session/dialog_state.h"
#include "app/session/journal_state.h"
#include "app/session/layer_state.h"
#include "app/session/mask_state.h"
#include "app/session/panel_layout.h"
#include "app/session/part_state.h"
#include "app/session/project_state.h"
#include "app/session/tool_state.h"
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
