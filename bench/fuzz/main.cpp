/// libFuzzer's entry to the target BOXWOOD_FUZZ_NAME.

#include "bench/fuzz/fuzz.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    boxwood::fuzz::BOXWOOD_FUZZ_NAME({data, size});
    return 0;
}
