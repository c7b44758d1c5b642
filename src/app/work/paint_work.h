#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/document/autosave.h"
#include "app/view/texture.h"
#include "core/message.h"
#include "stroke/document/document.h"
#include "stroke/document/fit.h"

/// \file
/// An open model and its painting. Created by `Opening`, then owned by the paint thread.
namespace tuft::app {

/// A model, its document and its file.
struct PaintWork {
    std::unique_ptr<stroke::Model> model;
    std::unique_ptr<stroke::Document> document;
    std::unique_ptr<Texture> texture;
    render::MapPixels pixels;  ///< initial content of the texture, for the graphics card
    Autosave autosave;
    std::string source;                              ///< path of the model file
    FileFrame frame;                                 ///< of the model file
    std::vector<stroke::StrokeMismatch> mismatches;  ///< strokes that do not fit a revised model
    std::vector<Message> fit;                        ///< how all strokes fit it, lines for the user
    std::optional<stroke::ModelMotion> motion;       ///< of a revised model, where it moved as a whole
    std::filesystem::path spare;                     ///< where to save at the end if the project's file fails
    Message note;                                    ///< message for the user after opening
};

}  // namespace tuft::app
