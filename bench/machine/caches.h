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

  private:
    std::vector<std::uint64_t> memory_;
};

} // namespace boxwood::bench
