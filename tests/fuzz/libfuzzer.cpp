#include <cstddef>
#include <cstdint>

#include "promise.h"
#include "targets.h"

/// What the address sanitizer does beside its checks cost up to a third of the time (fbx, dae): it walks thirty frames
/// at each allocation and freeing, and holds 256 MB of freed memory back. `ASAN_OPTIONS` goes before.
extern "C" const char* __asan_default_options() {
    return "malloc_context_size=4:quarantine_size_mb=32:thread_local_quarantine_size_kb=256";
}

/// The entry of libFuzzer (LLVM, "libFuzzer: a library for coverage-guided fuzz testing"); one
/// program per target.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const tuft::fuzz::Target* const target = tuft::fuzz::find_target(TUFT_FUZZ_TARGET);
    tuft::fuzz::promise(target != nullptr, "the program is called after a target");
    target->run({data, size});
    return 0;
}
