/// libFuzzer's entry to the target BOXWOOD_FUZZ_NAME.

#include "bench/fuzz/fuzz.h"

/// Assimp's reader of STL leaks where it gives up.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp.so\n"; }

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    boxwood::fuzz::BOXWOOD_FUZZ_NAME({data, size});
    return 0;
}
