#include "bench/io/read_results.h"

#include "bench/io/say.h"

#include <fmt/format.h>

namespace boxwood::bench {

results::Results read_results(const std::filesystem::path& file, results::Required required) {
    results::Results results = results::read(file, required);
    if (!results.is_sealed)
        say(fmt::format("boxwood: warning: '{}' was changed after it was written (its seal is "
                        "gone): what it says need not be what was measured\n",
                        file.string()));
    return results;
}

} // namespace boxwood::bench
