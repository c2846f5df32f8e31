#pragma once

#include "trees/device_memory.h"

#include <functional>
#include <memory>

namespace boxwood {

/// A stream of a device, owned, for what is to have a DevicePlace of its own: what is enqueued in
/// it is done in order, beside other streams. It must outlive what has its place.
class DeviceStream {
  public:
    /// Throws DeviceError.
    explicit DeviceStream(int index = 0);
    DeviceStream(const DeviceStream&) = delete;
    DeviceStream& operator=(const DeviceStream&) = delete;
    ~DeviceStream();

    DevicePlace place() const { return place_; }

  private:
    DevicePlace place_;
};

/// What was enqueued in a place's stream, which is none of null, done again by one launch: a CUDA
/// graph. Of little work it saves the launches of its kernels.
class DeviceGraph {
  public:
    /// `enqueue` is called to be recorded, perhaps more than once, and what it enqueues is done by
    /// `launch` alone; it may neither allocate nor wait (DeviceBvh::enqueue_...). Throws
    /// DeviceError, as `launch` does.
    DeviceGraph(DevicePlace place, std::function<void()> enqueue);
    DeviceGraph(DeviceGraph&&) noexcept;
    DeviceGraph& operator=(DeviceGraph&&) noexcept;
    ~DeviceGraph();

    /// Without waiting.
    void launch();

  private:
    struct Recorded;
    DevicePlace place_;
    std::unique_ptr<Recorded> recorded_;
};

} // namespace boxwood
