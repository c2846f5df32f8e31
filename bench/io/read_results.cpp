#include "bench/io/read_results.h"

#include <fmt/format.h>

#include <cstdio>

namespace boxwood::bench {

results::Results read_results(const std::filesystem::path& file, results::Required required) {
    results::Results results = results::read(file, required);
    if (!results.is_sealed)
        fmt::print(
            stderr,
            "boxwood: warning: '{}' was changed after it was written (its seal is gone): what "
            "it says need not be what was measured\n",
            file.string());
    return results;
}

} // namespace boxwood::bench
