#pragma once

/// \file
/// Fingerprint of the sources that prepare a model. The build writes it (hash_sources.cmake); model_cache.cpp puts it
/// into its keys.
namespace tuft::stroke {

/// Hexadecimal SHA-256 of the sources of core, mesh and atlas and of `stroke/surface`.
extern const char* const kPreparationCode;

}  // namespace tuft::stroke
