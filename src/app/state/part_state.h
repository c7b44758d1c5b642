#pragma once

#include <set>
#include <string>

/// \file
/// The list of the model's parts. Window thread.
namespace tuft::app {

/// What is chosen in the list of parts.
struct PartState {
    std::set<std::string> chosen;  ///< names; buttons and the substrate act on them
    std::string anchor;            ///< chosen by the last click without Shift
};

}  // namespace tuft::app
