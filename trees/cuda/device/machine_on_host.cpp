#include "trees/cuda/device/machine.h"

namespace boxwood {

std::vector<Device> devices() {
    Device model;
    model.name = "the host's model of a device";
    model.multiprocessors = 1;
    model.memory_bytes = on_host::free_memory();
    return {model};
}
std::string why_no_device() { return ""; }

namespace cuda {

Chosen::Chosen(int index) {
    if (index != 0)
        throw DeviceError("there is no CUDA device " + std::to_string(index));
}
Chosen::~Chosen() = default;

Stream stream_of(DevicePlace) { return {}; }
std::uint64_t free_memory(std::uint64_t) { return on_host::free_memory(); }

} // namespace cuda
} // namespace boxwood
