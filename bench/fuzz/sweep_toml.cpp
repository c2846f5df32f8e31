/// Sweep files: refused, or a config.

#include "bench/fuzz/fuzz.h"
#include "bench/io/bad_input.h"
#include "bench/plan/config.h"

namespace boxwood::fuzz {

void sweep_toml(Bytes bytes) {
    try {
        bench::parse_config(text_of(bytes), "fuzz.toml");
    } catch (const bench::BadInput&) {
    }
}

} // namespace boxwood::fuzz
