#pragma once

#include <string>
#include <string_view>

/// \file
/// Entities that an XML file declares for itself, such as Illustrator's styles (XML 1.0, 4.2.1). pugixml leaves them as
/// they are. Called by svg.cpp. Any thread.
namespace tuft::io {

/// Returns the text with every reference to an entity of its own DOCTYPE replaced by the entity's value; the same text
/// when it declares none. Comments and CDATA sections stay as they are, as do references to other files' entities.
/// Throws `Error` with `source` for entities that refer to each other without end and for more than 64 MiB of
/// replacements.
std::string expand_entities(std::string_view xml, const std::string& source);

}  // namespace tuft::io
