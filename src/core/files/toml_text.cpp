#include "core/files/toml_text.h"

#include "core/error.h"
#include "core/files/library_fault.h"
#include "core/text/nesting.h"

namespace tuft {

toml::table parse_toml(std::string_view text, const std::string& source) {
    check_toml_nesting(text, source);
    try {
        return toml::parse(text);
    } catch (const toml::parse_error& fault) {
        throw Error(source, static_cast<long>(fault.source().begin.line), toml_fault(fault.description()));
    }
}

}  // namespace tuft
