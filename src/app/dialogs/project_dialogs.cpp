#include <imgui.h>

#include "app/dialogs/dialogs.h"

/// Questions about where the work is kept.
namespace tuft::app {

void in_use_dialog(Session& s) {
    if (!s.project.in_use || !begin_dialog(s.ui, "Project in use", 480)) {
        if (s.project.in_use) end_dialog(s.ui);
        return;
    }
    Ui& ui = s.ui;
    ui.wrapped(ui.sentence(Message("{}: {} is working on it.", s.project.in_use->project.filename().string(),
                                   io::name_of(s.project.in_use->holder))));
    ui.wrapped(
        ui.tr("Close it there to go on with it here. A view shows what is painted there, stroke by stroke; a copy goes "
              "on by itself."));
    ImGui::Dummy(ImVec2(0, ui.px(4)));
    ui.buttons_at_right({{"Cancel", 100}, {"Look at it", 110}, {"Work on a copy", 140}});
    const bool cancelled = ui.button("Cancel", nullptr, 100);
    ImGui::SameLine();
    const bool view = ui.button("Look at it", "Nothing can be painted; Save as... makes a copy", 110);
    ImGui::SameLine();
    const bool copy = ui.primary_button("Work on a copy", 140);
    end_dialog(s.ui);
    if (copy || view)
        open_in_use(s, copy ? OpenAs::copy : OpenAs::view);
    else if (cancelled)
        s.project.in_use.reset();
}

void unsaved_work_dialog(Session& s) {
    if (!s.project.closing.request || !s.paint_thread || !begin_dialog(s.ui, "Work that is not on disk", 560)) {
        if (s.project.closing.request && s.paint_thread) end_dialog(s.ui);
        return;
    }
    Ui& ui = s.ui;
    const std::size_t n = s.reported.file.unsaved;
    if (n > 0)
        ui.wrapped(ui.sentence(Message(n == 1 ? "{} stroke waits in memory" : "{} strokes wait in memory", n)) + ":");
    else
        ui.wrapped(ui.tr("The last change waits in memory:"));
    ui.wrapped(ui.sentence(s.reported.file.trouble));
    ImGui::Dummy(ImVec2(0, ui.px(4)));
    ui.buttons_at_right({{"Go back", 90}, {"Leave all the same", 140}, {"Save as...", 110}, {"Try again", 110}});
    const bool back = ui.button("Go back", nullptr, 90);
    ImGui::SameLine();
    const bool leave =
        ui.button("Leave all the same", "What can be written goes into a copy that is offered at the next start", 140);
    ImGui::SameLine();
    const bool save = ui.button("Save as...", nullptr, 110);
    ImGui::SameLine();
    const bool again = ui.primary_button("Try again", 110);
    end_dialog(s.ui);
    if (leave) return close_now(s, *s.project.closing.request);
    if (again) s.paint_thread->post(RetrySaving{});
    if (back || save) s.project.closing.request.reset();
    if (save)
        s.dialogs.file.show(FileDialog::Purpose::save,
                            project_name(s.paint_thread.get(), s.reported.file.project) + ".tuft");
}

}  // namespace tuft::app
