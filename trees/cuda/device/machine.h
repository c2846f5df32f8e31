#pragma once

// What launch.h does not know of the machine: machine.cu of a device, device/machine_on_host.cpp
// of the host's model of one.

#include "trees/cuda/launch.h"
#include "trees/device.h"

namespace boxwood::cuda {

/// Where the calls of this thread go, for as long as it lives; then to where they went before,
/// which makes a context there if there was none. Throws DeviceError if there is no such device.
class Chosen {
  public:
    explicit Chosen(int index);
    Chosen(const Chosen&) = delete;
    Chosen& operator=(const Chosen&) = delete;
    ~Chosen();

  private:
    int before_ = 0;
};

Stream stream_of(DevicePlace place);

/// Bytes that can be had on the chosen device; once there are `enough`, no more are looked for,
/// which takes the driver long.
std::uint64_t free_memory(std::uint64_t enough = ~std::uint64_t{0});
/// Throws DeviceOutOfMemory{needed, free} if they cannot.
inline void require_memory(const char* what, std::uint64_t needed) {
    const std::uint64_t free = free_memory(needed);
    if (needed > free)
        throw DeviceOutOfMemory(what, needed, free);
}

/// Why no device can be used; versions as CUDA has them, a driver of 0 is none.
std::string why_none(int driver, int runtime, int n_devices);
/// Whether code for these architectures, as "80-real,90-virtual", runs on such a device.
bool runs_on(std::string_view architectures, int major, int minor);

} // namespace boxwood::cuda
