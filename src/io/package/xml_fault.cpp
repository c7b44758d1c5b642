#include "io/package/xml_fault.h"

#include <pugixml.hpp>
#include <string>

#include "core/files/library_fault.h"

namespace tuft::io {

Message xml_fault(const pugi::xml_parse_result& result) {
    switch (result.status) {
        case pugi::status_unrecognized_tag:
            return Message("an element begins with no name");
        case pugi::status_bad_pi:
            return Message("a declaration or processing instruction is damaged");
        case pugi::status_bad_comment:
            return Message("a comment is not closed");
        case pugi::status_bad_cdata:
            return Message("a CDATA section is not closed");
        case pugi::status_bad_doctype:
            return Message("the document type is damaged");
        case pugi::status_bad_pcdata:
            return Message("a text is damaged");
        case pugi::status_bad_start_element:
            return Message("the start of an element is damaged");
        case pugi::status_bad_attribute:
            return Message("an attribute is damaged");
        case pugi::status_bad_end_element:
            return Message("the end of an element is damaged");
        case pugi::status_end_element_mismatch:
            return Message("an element ends that was not begun");
        case pugi::status_no_document_element:
            return Message("there is no element in it");
        case pugi::status_out_of_memory:
            return Message("out of memory");
        default:
            return library_fault(result.description());
    }
}

}  // namespace tuft::io
