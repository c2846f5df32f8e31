#pragma once

#include "trees/device_memory.h"

namespace boxwood::bench {

/// The device of the bench: the first there is, which the file names.
DevicePlace bench_place();

} // namespace boxwood::bench
