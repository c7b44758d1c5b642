#pragma once

#include "core/message.h"

namespace pugi {
struct xml_parse_result;
}

/// \file
/// Why pugixml could not read a text, as a message that has a translation.
namespace tuft::io {

/// Returns what is wrong with an XML file.
Message xml_fault(const pugi::xml_parse_result& result);

}  // namespace tuft::io
