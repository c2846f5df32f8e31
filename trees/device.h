#pragma once

#include "trees/device_bvh.h"
#include "trees/device_graph.h"
#include "trees/device_memory.h"
#include "trees/device_mesh_bvh.h"
#include "trees/device_triangles.h"
#include "trees/device_worlds.h"

#include <cstdint>
#include <string>
#include <vector>

/// The same trees on a CUDA device, with the same answers. A program that includes this needs no
/// CUDA: where Boxwood was compiled without nvcc, or there is no device, devices() is empty.
namespace boxwood {

/// A CUDA device that this program can use.
struct Device {
    int index = 0; ///< as CUDA counts them
    std::string name, bus_id;
    unsigned multiprocessors = 0;
    std::uint64_t memory_bytes = 0, cache_bytes = 0; ///< the cache that all of it shares
    int capability_major = 0, capability_minor = 0;
    int driver = 0, runtime = 0; ///< as CUDA has them: 13020 is 13.2
    bool ecc = false;
    double max_clock_ghz = 0;
};

/// What a device's memory and bus give at this moment, the best of several tries: GB/s (1e9 bytes)
/// of 64 MiB, less where less is free.
struct DeviceRates {
    double copy = 0;                 ///< within its memory, read and written
    double upload = 0, download = 0; ///< from and to pinned memory of the host
    double upload_pageable = 0, download_pageable = 0;
    double launch_ns = 0; ///< of one kernel of many that do nearly nothing
};
/// Takes some ten milliseconds. Throws DeviceError.
DeviceRates measure_rates(int index);

/// Those there are, and if there are none why: no nvcc when this was compiled, no driver, a driver
/// older than the runtime, no device, or code for other devices alone.
std::vector<Device> devices();
std::string why_no_device();

} // namespace boxwood
