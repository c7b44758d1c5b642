#pragma once

/// \file
/// Fingerprint of the sources that measure a tip lag. The build writes it (hash_sources.cmake); tip_lag.cpp puts it
/// into its keys.
namespace tuft::stroke {

/// Hexadecimal SHA-256 of the sources of core, mesh/read and brush and of `stroke/placement`.
extern const char* const kTipLagCode;

}  // namespace tuft::stroke
