#pragma once

#include <memory>

#include "app/paint/paint_thread.h"
#include "app/session/brush_settings.h"
#include "app/session/colour_state.h"
#include "app/session/dialog_state.h"
#include "app/session/journal_state.h"
#include "app/session/layer_state.h"
#include "app/session/mask_state.h"
#include "app/session/panel_layout.h"
#include "app/session/project_state.h"
#include "app/session/tool_state.h"
#include "app/view/view_state.h"
#include "app/widgets/preferences.h"
#include "app/widgets/status_message.h"
#include "app/widgets/ui.h"

namespace tuft::app {

/// Everything the window knows, as plain data in parts; panels read and change them.
struct Session {
    Ui ui;
    Preferences preferences;
    PanelLayout panels;
    DialogState dialogs;
    StatusMessage status;

    ProjectState project;
    std::unique_ptr<PaintThread> paint_thread;  ///< of the open model; null: none is
    PaintStatus reported;                       ///< by it at the last look

    ViewState view;
    ToolState tools;
    BrushSettings brush;
    LayerState layers;
    MaskState masks;
    ColourState colours;
    JournalState journal;
};

/// Takes over what threads have finished.
void poll_session(Session& s);
/// The paint thread's part of that.
void poll_paint_thread(Session& s);
/// Nothing runs in the background and nothing waits.
bool is_settled(const Session& s);

}  // namespace tuft::app
