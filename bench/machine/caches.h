#pragma once

#include "bench/machine/machine.h"

#include <cstdint>
#include <vector>

namespace boxwood::bench {

/// Drives all that was used out of the caches: writes memory of twice the last one.
class CacheFlush {
  public:
    explicit CacheFlush(const Machine& machine);
    void operator()();

    /// What a call may take, guessed: at 4 GB/s.
    static double guessed_s(const Machine& machine);

  private:
    std::vector<std::uint64_t> memory_;
};

} // namespace boxwood::bench
