#pragma once

#include <string>
#include <string_view>

/// \file
/// Text of XML files. Called by all writers of SVG, InkML and HTML.
namespace tuft {

/// Returns `text` for use in XML, as the content of an element or an attribute: the characters &, <, > and " as
/// references, control characters, which XML 1.0 does not allow, as spaces. Tabs and line ends stay.
std::string xml_text(std::string_view text);

}  // namespace tuft
