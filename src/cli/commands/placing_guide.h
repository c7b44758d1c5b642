#pragma once

#include <filesystem>
#include <vector>

#include "cli/steps/steps.h"
#include "decal/sheet.h"

/// \file
/// Where each piece of a decal sheet goes: pictures of the model and the cut lines on it. Called by `tuft decals`.
namespace tuft::cli {

/// What a guide shows. The references must outlive it.
struct GuideRequest {
    const OpenProject& project;
    const stroke::Document& painting;
    const decal::Sheet& sheet;
};

/// Writes the guide into `folder` and creates the folder where it is missing. `piece-NN.png` shows the model straight
/// on to one piece, with its cut line, number and arrow; those of the other pieces are fainter. `overview.png` shows
/// the model, of twelve views, from where most is seen of the pieces' cut lines, each piece counted alike; the usual
/// view where no other shows 5 % more. `lines.obj` has the cut lines and arrows as polylines on the surface, in unit
/// and axes of the model's file, to be projected or drawn on the clay. Returns the paths. Throws `Error`; then nothing
/// is written.
std::vector<std::filesystem::path> write_placing_guide(const std::filesystem::path& folder, const GuideRequest& request,
                                                       Console& console);

}  // namespace tuft::cli
