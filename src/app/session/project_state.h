#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/document/pictures.h"
#include "app/document/state_folder.h"
#include "app/paint/opening.h"
#include "core/message.h"

namespace tuft::app {

/// A revised model takes the place of the one that strokes were painted on.
struct Revision {
    std::filesystem::path source;                    ///< project whose strokes the model being opened gets
    std::filesystem::path previous;                  ///< project that the strokes of the open one came from
    std::vector<stroke::StrokeMismatch> mismatches;  ///< strokes that no longer fit
    std::vector<Message> fit;                        ///< how all strokes lie on it, a sentence each
};

/// Work that an earlier run did not save.
struct Recovery {
    SessionNote note;  ///< of this run
    std::vector<LostWork> lost;
    bool confirm_delete = false;  ///< the first of them: asked once more
};

/// What follows once unsaved work is saved or given up.
struct CloseRequest {
    enum class Then { quit, close, open } then = Then::quit;
    std::filesystem::path file;  ///< to be opened
};

struct Closing {
    std::optional<CloseRequest> request;  ///< waits for an answer, while some work is in memory only
    Message failure;                      ///< what became of work that could not be saved; empty if all was
    bool quit = false;
};

/// What is offered while no model is open.
struct StartPage {
    std::vector<std::filesystem::path> samples, recent;
    Pictures pictures;
};

/// Opening and closing models and projects.
struct ProjectState {
    Opening opening;
    std::optional<Inspected> inspected;  ///< waits for the person's yes
    OpenOptions options;                 ///< of the model that is opened next
    bool is_sample = false;              ///< what is being opened; nothing is asked then
    std::optional<InUse> in_use;         ///< a project that another program has: asked what to do
    Revision revision;
    Recovery recovery;
    Closing closing;
    StartPage start_page;
};

}  // namespace tuft::app
