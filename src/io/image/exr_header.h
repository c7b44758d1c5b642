#pragma once

#include <cstddef>
#include <span>

#include "core/message.h"

/// \file
/// Check of EXR files before OpenEXR decodes them. Called by image.h.
namespace tuft::io {

/// Returns why the header of an EXR file (OpenEXR, "File Layout", version 2) must not be decoded. Empty where it is
/// sound. Checked are the sizes for which OpenEXR allocates memory before it reads the content: the size of each
/// attribute against the remaining bytes, each data window against `max_pixels`. Cost: linear in the header.
Message exr_header_fault(std::span<const char> file, std::size_t max_pixels);

}  // namespace tuft::io
