#pragma once

#include <string>

#include "app/widgets/ui.h"

/// \file
/// Names that the document or the studio gave, in the language of the interface. Window thread.
namespace tuft::app {

/// Returns a name "WORD N" in the language of the interface, another name as it is. `word`: English, has an entry in
/// the catalogues.
std::string numbered_title(const Ui& ui, const std::string& name, const char* word);
/// Returns the name of a layer in the language of the interface where the document or the studio gave it, else as the
/// person wrote it. "NAME copy" and "NAME copy N" are the title of NAME and the word of the interface for a copy.
std::string layer_title(const Ui& ui, const std::string& name);
/// The same for a mask. "NAME +" and "NAME ×", of two that are joined, are the title of NAME and that sign.
std::string mask_title(const Ui& ui, const std::string& name);

}  // namespace tuft::app
