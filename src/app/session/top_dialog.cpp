#include "app/session/top_dialog.h"

#include <utility>

namespace tuft::app {

bool is_dialog_open(const Session& s) {
    const ProjectState& p = s.project;
    const DialogState& d = s.dialogs;
    return p.inspected || p.opening.running() || (!p.recovery.lost.empty() && !s.paint_thread) || p.in_use ||
           p.closing.request || d.show_export || d.show_decals || d.show_film || d.show_settings || d.show_keys ||
           d.show_about || d.show_mismatches || d.file.shown() || s.panels.help.manual;
}

bool close_top_dialog(Session& s) {
    DialogState& d = s.dialogs;
    ProjectState& p = s.project;
    if (d.file.shown())
        d.file.close();
    else if (s.panels.help.manual)
        s.panels.help.manual = false;
    else if (d.key_to_assign)
        d.key_to_assign.reset();
    else if (d.show_keys)
        d.show_keys = false;
    else if (d.show_about)
        d.show_about = false;
    else if (d.show_mismatches)
        d.show_mismatches = false;
    else if (s.journal.move_on_drag)
        s.journal.move_on_drag = false, s.journal.from.reset(), s.journal.to.reset();
    else if (d.show_settings)
        d.show_settings = false;
    else if (s.panels.show_appearance)
        s.panels.show_appearance = false;
    else if (d.show_export)
        d.show_export = false;
    else if (d.show_decals)
        d.show_decals = false;
    else if (d.show_film)
        d.show_film = false;
    else if (p.opening.running())
        p.opening.cancel();
    else if (p.closing.request)
        p.closing.request.reset();
    else if (p.in_use)
        p.in_use.reset();
    else if (p.inspected)
        p.inspected.reset();
    else if (p.recovery.confirm_delete)
        p.recovery.confirm_delete = false;
    else if (!p.recovery.lost.empty() && !s.paint_thread)
        p.recovery.lost.erase(p.recovery.lost.begin());  // later
    else if (!s.journal.snapshots.compared.empty())
        compare_with(s.journal.snapshots, s.view.atlas, s.paint_thread.get(), "");
    else if (!s.journal.selected.empty())
        select_entries(s.journal, s.paint_thread.get(), {});
    else
        return false;
    return true;
}

bool close_top_panel(Session& s) {
    if (!s.paint_thread) return false;
    for (bool* shown : {&s.panels.show_brushes, &s.colours.choice.shown, &s.arm.shown, &s.colours.palette.shown})
        if (std::exchange(*shown, false)) return true;
    return false;
}

}  // namespace tuft::app
