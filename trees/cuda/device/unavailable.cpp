// What a program has that was built without nvcc.

#include "trees/detail/device_tree.h"
#include "trees/device.h"
#include "trees/device_triangles.h"

namespace boxwood {

std::vector<Device> devices() { return {}; }
std::string why_no_device() {
    return "boxwood was built without CUDA: " BOXWOOD_NO_NVCC "; then configure and build it again";
}

namespace {

[[noreturn]] void none() { throw DeviceError("no CUDA device: " + why_no_device()); }

} // namespace

DeviceRates measure_rates(int) { none(); }

void wait_for(DevicePlace) { none(); }
std::uint64_t launches_so_far() { return 0; }

struct DeviceTimer::Events {};
DeviceTimer::DeviceTimer(DevicePlace) { none(); }
DeviceTimer::~DeviceTimer() = default;
void DeviceTimer::start() {}
double DeviceTimer::stop_ns() { none(); }

DeviceStream::DeviceStream(int) { none(); }
DeviceStream::~DeviceStream() = default;
struct DeviceGraph::Recorded {};
DeviceGraph::DeviceGraph(DevicePlace, std::function<void()>) { none(); }
DeviceGraph::DeviceGraph(DeviceGraph&&) noexcept = default;
DeviceGraph& DeviceGraph::operator=(DeviceGraph&&) noexcept = default;
DeviceGraph::~DeviceGraph() = default;
void DeviceGraph::launch() { none(); }

DevicePairAnswers<Answer> triangles_touch(const DeviceTriangles&, const DeviceTriangles&,
                                          DeviceSpan<const Pair>, DeviceAccuracy, DevicePlace) {
    none();
}
DeviceArray<Pair> touching_pairs(const DeviceTriangles&, const DeviceTriangles&,
                                 DeviceSpan<const Pair>, DeviceAccuracy, DevicePlace) {
    none();
}
DevicePairAnswers<DistanceBounds> triangle_distances(const DeviceTriangles&, const DeviceTriangles&,
                                                     DeviceSpan<const Pair>, DeviceAccuracy,
                                                     DevicePlace) {
    none();
}

namespace detail {

DeviceMemory::DeviceMemory(std::size_t bytes, DevicePlace) {
    if (bytes > 0)
        none();
}
DeviceMemory::~DeviceMemory() = default;
void DeviceMemory::write(const void*, std::size_t) {}
void DeviceMemory::read(void*, std::size_t) const {}

std::unique_ptr<DeviceTree> make_device_tree(const DeviceBvhOptions&) { none(); }
std::unique_ptr<DeviceMesh> make_device_mesh(const DeviceMeshBvhOptions&) { none(); }
std::unique_ptr<DeviceWorldsTree> make_device_worlds(std::span<const std::uint32_t>,
                                                     const DevicePlace&) {
    none();
}

} // namespace detail
} // namespace boxwood
