#pragma once

#include <span>
#include <vector>

#include "stroke/journal/journal.h"

/// A journal as traces, for files that other work can be made from.
namespace tuft::stroke {

struct JournalTraces {
    std::vector<Trace> traces;  ///< with names of layers and masks, and settings
    std::size_t left_out = 0;   ///< entries that traces cannot say: changes of layers and masks
};

/// The entries in their order without the hidden ones. A stroke becomes its trace; what is done
/// with a brush, and a fill, becomes a trace without samples that has it `before`. Painted on the
/// same model in the same atlas they leave the same texels, as long as each layer is added on top
/// when it is first painted on, and masks have been made.
JournalTraces traces_of(std::span<const Stroke> entries);

}  // namespace tuft::stroke
