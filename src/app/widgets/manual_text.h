#pragma once

#include <span>
#include <string>

#include "app/input/keys.h"
#include "app/widgets/ui.h"

/// \file
/// Text of the built-in manual in English. The Chinese translation is in the catalogue (app/text). Any thread.
namespace tuft::app {

/// A page. Paragraphs end with a line break, list items begin with "* ". {undo} and the like stand for the key of an
/// action, by its word in the settings file.
struct ManualPage {
    const char *title, *text;
};
std::span<const ManualPage> manual_pages();

/// Returns a page's text in a language, with the present keys filled in.
std::string manual_text(const ManualPage& page, Language language, const KeyTable& keys);

}  // namespace tuft::app
