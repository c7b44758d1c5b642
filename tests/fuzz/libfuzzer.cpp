#include <cstddef>
#include <cstdint>

#include "promise.h"
#include "targets.h"

/// The entry of libFuzzer (LLVM, "libFuzzer: a library for coverage-guided fuzz testing"); one
/// program per target.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const tuft::fuzz::Target* const target = tuft::fuzz::find_target(TUFT_FUZZ_TARGET);
    tuft::fuzz::promise(target != nullptr, "the program is called after a target");
    target->run({data, size});
    return 0;
}
