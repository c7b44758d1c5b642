#pragma once

#include <cstddef>
#include <span>

#include "core/message.h"

namespace tuft::io {

/// Why the header of an EXR file (OpenEXR, "File Layout", version 2) is not to be decoded; empty where it is sound.
/// Looked at are the sizes that OpenEXR takes memory for before it reads what they are the sizes of: of each attribute
/// against the bytes that are left, of each data window against `max_pixels`. Cost: linear in the header.
Message exr_header_fault(std::span<const char> file, std::size_t max_pixels);

}  // namespace tuft::io
