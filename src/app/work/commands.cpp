#include "app/work/commands.h"

#include "core/overloaded.h"

namespace tuft::app {

bool changes_work(const Command& command) {
    return std::visit(
        Overloaded{[](const BeginStroke&) { return true; }, [](const PaintDrawing&) { return true; },
                   [](const PaintText&) { return true; }, [](const ActOnBrush&) { return true; },
                   [](const TendInk&) { return true; }, [](const UndoStroke&) { return true; },
                   [](const RedoStroke&) { return true; }, [](const EditStrokes&) { return true; },
                   [](const AttachToProject&) { return true; }, [](const DetachFromProject&) { return true; },
                   [](const TakeSnapshot&) { return true; }, [](const RenameSnapshot&) { return true; },
                   [](const RestoreSnapshot&) { return true; }, [](const FillModel&) { return true; },
                   [](const ChangeLayers&) { return true; }, [](const ChangeMasks&) { return true; },
                   [](const ChangeParts&) { return true; }, [](const auto&) { return false; }},
        command);
}

}  // namespace tuft::app
