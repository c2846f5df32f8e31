#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>

namespace boxwood::bench {

/// Clock ticks that all processors have worked, or that the hypervisor took, and all there were,
/// from the text of /proc/stat; nothing if it is not that.
struct CpuTicks {
    std::uint64_t busy = 0, all = 0;
};
std::optional<CpuTicks> cpu_ticks_of(std::string_view proc_stat);

/// How many processors work while this thread sleeps for `watched`; NaN where that is not known.
double busy_cores(std::chrono::milliseconds watched);

/// Waits until no more than results::quiet_cores work, as `watch` has it, but no longer than
/// `limit_s` in all its calls.
class QuietWait {
  public:
    explicit QuietWait(
        double limit_s,
        std::function<double()> watch = [] { return busy_cores(std::chrono::milliseconds(100)); });

    /// Gives what `watch` said last. `busy` is called before each pause of a second, and ends the
    /// waiting if it gives false.
    double wait(const std::function<bool(double cores)>& busy);
    bool may_wait() const { return waited_s_ < limit_s_; }

  private:
    double limit_s_, waited_s_ = 0;
    std::function<double()> watch_;
};

} // namespace boxwood::bench
