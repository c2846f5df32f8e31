#include "bench/machine/quiet.h"

#include "results/results.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <limits>
#include <numeric>
#include <sstream>
#include <string>
#include <thread>

namespace boxwood::bench {

std::optional<CpuTicks> cpu_ticks_of(std::string_view proc_stat) {
    std::istringstream words{std::string(proc_stat)};
    std::string name;
    std::array<std::uint64_t, 8> ticks{}; // user nice system idle iowait irq softirq steal
    if (!(words >> name) || name != "cpu")
        return std::nullopt;
    for (std::uint64_t& value : ticks)
        if (!(words >> value))
            return std::nullopt;
    const std::uint64_t all = std::accumulate(ticks.begin(), ticks.end(), std::uint64_t{0});
    return CpuTicks{all - ticks[3] - ticks[4], all};
}

double busy_cores(std::chrono::milliseconds watched) {
    const auto now = [] {
        std::ifstream stat("/proc/stat");
        std::string line;
        std::getline(stat, line);
        return cpu_ticks_of(line);
    };
    const std::optional<CpuTicks> before = now();
    std::this_thread::sleep_for(watched);
    const std::optional<CpuTicks> after = now();
    if (!before || !after || after->all <= before->all)
        return std::numeric_limits<double>::quiet_NaN();
    return static_cast<double>(sysconf(_SC_NPROCESSORS_ONLN)) *
           static_cast<double>(after->busy - before->busy) /
           static_cast<double>(after->all - before->all);
}

QuietWait::QuietWait(double limit_s, std::function<double()> watch)
    : limit_s_(limit_s), watch_(std::move(watch)) {}

double QuietWait::wait(const std::function<bool(double)>& busy) {
    double cores = watch_();
    while (cores > results::quiet_cores && waited_s_ < limit_s_ && busy(cores)) {
        const double pause_s = std::min(1., limit_s_ - waited_s_);
        std::this_thread::sleep_for(std::chrono::duration<double>(pause_s));
        waited_s_ += pause_s;
        cores = watch_();
    }
    return cores;
}

} // namespace boxwood::bench
