#include "trees/cuda/device/machine.h"

#include <memory>

namespace boxwood {
namespace detail {

DeviceMemory::DeviceMemory(std::size_t bytes, DevicePlace place) : place_(place) {
    if (bytes == 0)
        return;
    const cuda::Chosen chosen(place.index);
    cuda::require_memory("an array", bytes);
    data_ = cuda::allocate(bytes, cuda::stream_of(place));
}
DeviceMemory::~DeviceMemory() {
    if (data_)
        cuda::release(data_, cuda::stream_of(place_));
}

void DeviceMemory::write(const void* from, std::size_t bytes) {
    if (bytes == 0)
        return;
    const cuda::Chosen chosen(place_.index);
    const cuda::Stream stream = cuda::stream_of(place_);
    cuda::upload(std::span(static_cast<const std::byte*>(from), bytes),
                 static_cast<std::byte*>(data_), stream);
    cuda::wait(stream);
}
void DeviceMemory::read(void* to, std::size_t bytes) const {
    if (bytes == 0)
        return;
    const cuda::Chosen chosen(place_.index);
    const cuda::Stream stream = cuda::stream_of(place_);
    cuda::download(static_cast<const std::byte*>(data_),
                   std::span(static_cast<std::byte*>(to), bytes), stream);
    cuda::wait(stream);
}

} // namespace detail

void wait_for(DevicePlace place) {
    const cuda::Chosen chosen(place.index);
    cuda::wait(cuda::stream_of(place));
}

std::uint64_t launches_so_far() { return cuda::n_launches; }

struct DeviceTimer::Events {
    cuda::Event start, stop;
};

DeviceTimer::DeviceTimer(DevicePlace place) : place_(place) {
    const cuda::Chosen chosen(place.index);
    events_ = std::make_unique<Events>();
}
DeviceTimer::~DeviceTimer() = default;

void DeviceTimer::start() {
    const cuda::Chosen chosen(place_.index);
    events_->start.record(cuda::stream_of(place_));
}
double DeviceTimer::stop_ns() {
    const cuda::Chosen chosen(place_.index);
    events_->stop.record(cuda::stream_of(place_));
    return events_->stop.ns_since(events_->start);
}

} // namespace boxwood
