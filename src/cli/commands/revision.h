#pragma once

#include <optional>
#include <vector>

#include "cli/arguments/arguments.h"
#include "cli/steps/steps.h"
#include "stroke/document/fit.h"

/// \file
/// Strokes of a project on a revised model: which follow it, how they fit, and what moved. Called by `tuft replay`.
namespace tuft::cli {

/// The strokes of a project on their way to the model that they are painted on.
struct RevisedStrokes {
    stroke::ModelChange change;                  ///< of the model; none where the model is the project's own
    std::vector<stroke::JournalEntry> former;    ///< as the project has them
    std::vector<stroke::JournalEntry> followed;  ///< as they are painted
    std::vector<Message> notes;                  ///< on masks whose parts are gone
};

/// Returns the surface that a project was painted on. `painting` is on the model of `replay_model`.
const mesh::SurfaceQuery& former_surface(const Replay& arguments, const OpenProject& project,
                                         const stroke::Document& painting);

/// Returns the strokes of a project with brush and ink of the arguments, moved as `--follow` and `--pull-back` say.
/// Without `--model` they stay. Throws `Error` for an unknown preset and for a model that is too small for the strokes.
RevisedStrokes replay_strokes(const Replay& arguments, const OpenProject& project, stroke::Document& painting);

/// How the strokes lie on a revised model; which touch nothing where the model is the same.
struct Fit {
    std::vector<stroke::StrokeFit> fits;
    std::vector<stroke::StrokeMismatch> mismatches;
    stroke::FitTotal total;
};

/// Compares a replay on a revised model with the project; without one, only finds strokes that touch nothing.
Fit find_fit(const Replay& arguments, const RevisedStrokes& strokes, stroke::Document& painting,
             const mesh::SurfaceQuery& former, const std::vector<stroke::StrokeReport>& reports);

/// Says on the console what moved, what followed and what no longer fits.
void note_fit(const Replay& arguments, const RevisedStrokes& strokes, const Fit& fit, Console& console);

/// All of the fit but the mismatches.
nlohmann::json to_json(const RevisedStrokes& strokes, const Fit& fit);

/// Writes `arguments.moved`, a picture of the painting on the revised model. Surface that lies elsewhere than on the
/// former model, after its motion and that of its part, is coloured by the distance; the ink's path of strokes that no
/// longer fit is red, with the number of the stroke.
void write_revision_picture(const Replay& arguments, const RevisedStrokes& strokes, const Fit& fit,
                            const stroke::Document& painting, const mesh::SurfaceQuery& former, Console& console);

}  // namespace tuft::cli
