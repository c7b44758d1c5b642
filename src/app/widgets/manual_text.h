#pragma once

#include <span>
#include <string>

#include "app/input/keys.h"
#include "app/widgets/ui.h"

/// The built-in manual: short pages, in English; those in Chinese are in the catalogue (app/text).
namespace tuft::app {

/// A page; paragraphs end with a line break, points begin with "* ". {undo} and the like stand for the key of an
/// action, by its word in the settings.
struct ManualPage {
    const char *title, *text;
};
std::span<const ManualPage> manual_pages();

/// The page's text with the keys that are set now.
std::string manual_text(const ManualPage& page, Language language, const KeyTable& keys);

}  // namespace tuft::app
