#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/document/autosave.h"
#include "app/view/texture.h"
#include "core/message.h"
#include "stroke/document/document.h"
#include "stroke/document/fit.h"

namespace tuft::app {

/// An open model with all that is painted on it.
struct PaintWork {
    std::unique_ptr<stroke::Model> model;
    std::unique_ptr<stroke::Document> document;
    std::unique_ptr<Texture> texture;
    render::MapPixels pixels;  ///< what the texture shows at the start, for the graphics card
    Autosave autosave;
    std::string source;
    FileFrame frame;                                 ///< of the model file
    std::vector<stroke::StrokeMismatch> mismatches;  ///< of a revised model: strokes that do not fit it
    std::vector<Message> fit;                        ///< and how all of them lie on it, for people
    std::filesystem::path spare;                     ///< a file for work that cannot be saved in its own at the end
    Message note;                                    ///< for the person who opened it
};

}  // namespace tuft::app
