// What a program has that was built without nvcc.

#include "bench/stages/device_bodies.h"

namespace boxwood::bench {

std::unique_ptr<DeviceBodies> make_device_bodies(DevicePlace) {
    throw DeviceError("no CUDA device: " + why_no_device());
}

} // namespace boxwood::bench
