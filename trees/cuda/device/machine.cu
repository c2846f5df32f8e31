#include "trees/cuda/device/machine.h"

#include <algorithm>
#include <map>
#include <mutex>

namespace boxwood {
namespace {

struct Found {
    std::vector<Device> usable;
    std::string why_none;
};

int attribute(cudaDeviceAttr which, int device) {
    int value = 0;
    cuda::require(cudaDeviceGetAttribute(&value, which, device), "what a device is");
    return value;
}

Device device_at(int index) {
    cudaDeviceProp properties;
    cuda::require(cudaGetDeviceProperties(&properties, index), "what a device is");
    Device device;
    device.index = index;
    device.name = properties.name;
    char bus_id[32] = "";
    cuda::require(cudaDeviceGetPCIBusId(bus_id, sizeof bus_id, index), "where a device is");
    device.bus_id = bus_id;
    device.multiprocessors = static_cast<unsigned>(properties.multiProcessorCount);
    device.memory_bytes = properties.totalGlobalMem;
    device.cache_bytes = static_cast<std::uint64_t>(properties.l2CacheSize);
    device.capability_major = properties.major;
    device.capability_minor = properties.minor;
    device.ecc = properties.ECCEnabled != 0;
    device.max_clock_ghz = attribute(cudaDevAttrClockRate, index) * 1e-6;
    return device;
}

Found find() {
    int driver = 0, runtime = 0, n = 0;
    cuda::require(cudaRuntimeGetVersion(&runtime), "the runtime's version");
    if (cudaDriverGetVersion(&driver) != cudaSuccess)
        driver = 0;
    if (cudaGetDeviceCount(&n) != cudaSuccess)
        n = 0;
    cudaGetLastError(); // what was found out is no error of a later call
    Found found;
    // Within a major version a runtime works with the older drivers, too.
    found.why_none = cuda::why_none(driver, n > 0 ? std::min(driver, runtime) : runtime, n);
    std::string others;
    for (int i = 0; i < n; ++i) {
        Device device = device_at(i);
        device.driver = driver;
        device.runtime = runtime;
        if (cuda::runs_on(BOXWOOD_CUDA_ARCHITECTURES, device.capability_major,
                          device.capability_minor))
            found.usable.push_back(std::move(device));
        else
            others += (others.empty() ? "" : ", ") + device.name + " (" +
                      std::to_string(device.capability_major * 10 + device.capability_minor) + ")";
    }
    if (found.usable.empty() && !others.empty())
        found.why_none = "this program has code for " BOXWOOD_CUDA_ARCHITECTURES
                         " alone, but here is " +
                         others + ": build with -DCMAKE_CUDA_ARCHITECTURES=native";
    return found;
}

} // namespace

std::vector<Device> devices() { return find().usable; }
std::string why_no_device() { return find().why_none; }

namespace cuda {

Chosen::Chosen(int index) {
    if (cudaGetDevice(&before_) == cudaSuccess && choose_device(index) == cudaSuccess)
        return;
    cudaGetLastError(); // it is no error of a later call
    const std::string why = why_no_device();
    throw DeviceError(why.empty() ? "there is no CUDA device " + std::to_string(index)
                                  : "no CUDA device: " + why);
}
Chosen::~Chosen() { choose_device(before_); }

Stream stream_of(DevicePlace place) {
    return {static_cast<cudaStream_t>(place.stream), place.index};
}

namespace {

cudaMemPool_t make_pool(int device) {
    cudaMemPoolProps properties{};
    properties.allocType = cudaMemAllocationTypePinned;
    properties.location.type = cudaMemLocationTypeDevice;
    properties.location.id = device;
    cudaMemPool_t pool{};
    require(cudaMemPoolCreate(&pool, &properties), "a pool of memory");
    std::size_t free = 0, total = 0;
    require(cudaMemGetInfo(&free, &total), "how much memory is free");
    std::uint64_t kept = total / 4;
    require(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &kept),
            "the pool of memory");
    return pool;
}

} // namespace

cudaMemPool_t pool_of(int device) {
    static std::mutex mutex;
    static std::map<int, cudaMemPool_t> pools;
    const std::lock_guard lock(mutex);
    const auto found = pools.find(device);
    return found != pools.end() ? found->second
                                : pools.emplace(device, make_pool(device)).first->second;
}

std::uint64_t free_memory(std::uint64_t enough) {
    int device = 0;
    require(cudaGetDevice(&device), "the current device");
    const cudaMemPool_t pool = pool_of(device);
    std::uint64_t reserved = 0, used = 0;
    require(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrReservedMemCurrent, &reserved),
            "the pool of memory");
    require(cudaMemPoolGetAttribute(pool, cudaMemPoolAttrUsedMemCurrent, &used),
            "the pool of memory");
    const std::uint64_t unused = reserved - used;
    if (unused >= enough)
        return unused;
    std::size_t free = 0, total = 0;
    require(cudaMemGetInfo(&free, &total), "how much memory is free");
    return free + unused;
}

} // namespace cuda
} // namespace boxwood
