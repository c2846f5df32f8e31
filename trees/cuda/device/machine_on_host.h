#pragma once

#include "trees/cuda/on_host.h"

namespace boxwood::cuda {

/// For as long as this lives the host's model has no more than this free.
class FreeMemory {
  public:
    explicit FreeMemory(std::uint64_t bytes) { on_host::set_free_memory(bytes); }
    FreeMemory(const FreeMemory&) = delete;
    FreeMemory& operator=(const FreeMemory&) = delete;
    ~FreeMemory() { on_host::set_free_memory(std::uint64_t{1} << 36); }
};

} // namespace boxwood::cuda
