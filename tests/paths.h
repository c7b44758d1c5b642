#pragma once

#include <string>

/// \file
/// Where the sources, the reference data and the programs under test are, as absolute paths. They are compiled
/// into one generated source, so that no other test source depends on the folder it is built in.
std::string source_folder();   ///< top of the source tree
std::string test_data();       ///< tests/data
std::string tuft_program();    ///< empty where the test does not run it
std::string studio_program();  ///< likewise
