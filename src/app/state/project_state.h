#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/document/pictures/pictures.h"
#include "app/document/pictures/state_folder.h"
#include "app/paint/opening.h"
#include "core/message.h"

/// \file
/// Opening, closing and recovery. Window thread.
namespace tuft::app {

/// A revised model replaces the one that the strokes were painted on.
struct Revision {
    std::filesystem::path source;                    ///< project whose strokes the model being opened gets
    std::filesystem::path previous;                  ///< project whose strokes the open model got
    std::vector<stroke::StrokeMismatch> mismatches;  ///< strokes that no longer fit
    std::vector<Message> fit;                        ///< how all strokes fit it, sentences
};

/// Work that an earlier run did not save.
struct Recovery {
    SessionNote note;  ///< of this run
    std::vector<LostWork> lost;
    bool confirm_delete = false;  ///< deleting the first of them is to be confirmed
};

/// What to do once unsaved work is saved or given up.
struct CloseRequest {
    enum class Then { quit, close, open } then = Then::quit;
    std::filesystem::path file;  ///< to open
};

/// State of closing.
struct Closing {
    std::optional<CloseRequest> request;  ///< waits for the user's answer while some work is in memory only
    Message failure;                      ///< where work went that could not be saved; empty: all was saved
    bool quit = false;
};

/// Choices while no model is open.
struct StartPage {
    std::vector<std::filesystem::path> samples, recent;
    Pictures pictures;
};

/// State of opening and closing.
struct ProjectState {
    Opening opening;
    std::optional<Inspected> inspected;  ///< waits for the user's confirmation
    OpenOptions options;                 ///< of the next model
    bool is_sample = false;              ///< a shipped model is being opened, without questions
    std::optional<InUse> in_use;         ///< a project that another program holds; the user is asked
    Revision revision;
    Recovery recovery;
    Closing closing;
    StartPage start_page;
};

}  // namespace tuft::app
