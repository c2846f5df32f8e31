#pragma once

#include "results/results.h"

#include <sys/resource.h>

#include <chrono>
#include <cstdint>
#include <fstream>
#include <string>

namespace boxwood::bench {

/// The eighth number of the first line of /proc/stat, in clock ticks; 0 where there is none.
inline std::uint64_t steal_ticks() {
    std::ifstream stat("/proc/stat");
    std::string cpu;
    std::uint64_t ticks = 0;
    stat >> cpu;
    for (int i = 0; i < 8; ++i)
        if (!(stat >> ticks))
            return 0;
    return ticks;
}

/// What the operating system counts for the whole process, at the moment it is made.
struct Usage {
    std::uint64_t utc_ns =
        static_cast<std::uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                       std::chrono::system_clock::now().time_since_epoch())
                                       .count());
    std::uint64_t steal = steal_ticks();
    rusage process = [] {
        rusage usage{};
        getrusage(RUSAGE_SELF, &usage);
        return usage;
    }();
};

/// What was counted between the two, and the flags that follow from it.
inline void add_usage(results::Sample& sample, const Usage& before, const Usage& after) {
    const auto difference = [](long a, long b) { return static_cast<std::uint64_t>(b - a); };
    sample.t_ns = before.utc_ns;
    sample.nvcsw = difference(before.process.ru_nvcsw, after.process.ru_nvcsw);
    sample.nivcsw = difference(before.process.ru_nivcsw, after.process.ru_nivcsw);
    sample.minflt = difference(before.process.ru_minflt, after.process.ru_minflt);
    if (after.steal > before.steal)
        sample.flags |= results::disturbed_steal;
    if (sample.nivcsw > 0)
        sample.flags |= results::disturbed_switches;
}

} // namespace boxwood::bench
