#include "bench/io/output_of.h"

#include <cstdio>
#include <memory>

namespace boxwood::bench {

std::string output_of(const std::string& command) {
    struct Close {
        void operator()(std::FILE* pipe) const { pclose(pipe); }
    };
    const std::unique_ptr<std::FILE, Close> pipe(popen(command.c_str(), "r"));
    std::string text;
    char part[4096];
    for (std::size_t got = 1; pipe && got != 0;) {
        got = std::fread(part, 1, sizeof part, pipe.get());
        text.append(part, got);
    }
    return text;
}

} // namespace boxwood::bench
