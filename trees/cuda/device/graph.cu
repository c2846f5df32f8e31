#include "trees/device_graph.h"

#include "trees/cuda/device/machine.h"

#include <memory>
#include <utility>

namespace boxwood {

DeviceStream::DeviceStream(int index) : place_{index} {
    const cuda::Chosen chosen(index);
    place_.stream = cuda::make_stream();
}
DeviceStream::~DeviceStream() { cuda::end_stream(place_.stream); }

struct DeviceGraph::Recorded {
    cuda::Graph graph;
};

DeviceGraph::DeviceGraph(DevicePlace place, std::function<void()> enqueue)
    : place_(place), recorded_(std::make_unique<Recorded>()) {
    if (!place.stream)
        throw DeviceError("a graph cannot be recorded in the default stream; give DevicePlace a "
                          "DeviceStream's");
    const cuda::Chosen chosen(place.index);
    recorded_->graph.record(cuda::stream_of(place), std::move(enqueue));
}
DeviceGraph::DeviceGraph(DeviceGraph&&) noexcept = default;
DeviceGraph& DeviceGraph::operator=(DeviceGraph&&) noexcept = default;
DeviceGraph::~DeviceGraph() = default;

void DeviceGraph::launch() {
    const cuda::Chosen chosen(place_.index);
    recorded_->graph.launch(cuda::stream_of(place_));
}

} // namespace boxwood
