#include "core/text/xml_text.h"

namespace tuft {

std::string xml_text(std::string_view text) {
    std::string out;
    for (const char c : text) {
        const bool allowed = static_cast<unsigned char>(c) >= ' ' || c == '\t' || c == '\n' || c == '\r';
        if (c == '&')
            out += "&amp;";
        else if (c == '<')
            out += "&lt;";
        else if (c == '>')
            out += "&gt;";
        else if (c == '"')
            out += "&quot;";
        else
            out += allowed ? c : ' ';
    }
    return out;
}

}  // namespace tuft
