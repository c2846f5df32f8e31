#pragma once

#include "bench/commands/doctor.h"
#include "trees/device.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boxwood::bench {

/// "cuda:0": how the command line calls a device.
std::string device_name(const Device& device);
/// "NVIDIA H100 PCIe: 114 multiprocessors, 79.1 GiB, sm_90, driver 13.0, runtime 13.0"
std::string device_summary(const Device& device);

/// The index of the device of that name, "cuda" the first. Throws BadInput, with a suggestion or
/// why there is none.
int chosen_device(std::string_view name, std::span<const Device> there,
                  const std::string& why_none);

/// What nvidia-smi says of each device, a line each: bus id, clock and highest clock in MHz,
/// persistence mode; and of the processes on them: bus id, process id, MiB.
struct DeviceUse {
    std::string clocks, processes;
};
DeviceUse device_use();

/// What of the devices spoils timings.
std::vector<Finding> examine_devices(std::span<const Device> there, const std::string& why_none,
                                     const DeviceUse& use);

} // namespace boxwood::bench
