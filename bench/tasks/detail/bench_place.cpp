#include "bench/tasks/detail/bench_place.h"

#include "trees/device.h"

#include <vector>

namespace boxwood::bench {

DevicePlace bench_place() {
    static const std::vector<Device> there = devices();
    return {.index = there.empty() ? 0 : there.front().index};
}

} // namespace boxwood::bench
