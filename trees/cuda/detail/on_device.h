#pragma once

// The device's side of launch.h; for nvcc alone.

#include "trees/device_memory.h"

#include <cstddef>
#include <cstdint>
#include <cuda_runtime.h>
#include <functional>
#include <span>
#include <string>
#include <utility>

namespace boxwood::cuda {

/// Throws what CUDA says, and of what.
inline void require(cudaError_t status, const char* what) {
    if (status != cudaSuccess)
        throw DeviceError(std::string("CUDA: ") + what + ": " + cudaGetErrorString(status));
}

/// Work that is done in order.
struct Stream {
    cudaStream_t handle = nullptr;
    int device = 0; ///< whose default stream null is
};

/// Sets the device of this thread's calls, and only if it is another: that makes a context there.
inline cudaError_t choose_device(int index) {
    int now = 0;
    const cudaError_t status = cudaGetDevice(&now);
    return status != cudaSuccess || now == index ? status : cudaSetDevice(index);
}

template <class... Parameters, class... Arguments>
void launch(Stream stream, std::size_t n_blocks, unsigned n_threads, void (*kernel)(Parameters...),
            Arguments... arguments) {
    if (n_blocks == 0)
        return;
    ++n_launches;
    kernel<<<static_cast<unsigned>(n_blocks), n_threads, 0, stream.handle>>>(arguments...);
    require(cudaGetLastError(), "a kernel does not start");
}

/// What no graph can do again is refused while one is recorded.
inline void require_no_recording(Stream stream, const char* what) {
    cudaStreamCaptureStatus capture{};
    require(cudaStreamIsCapturing(stream.handle, &capture), "a stream");
    if (capture != cudaStreamCaptureStatusNone)
        throw DeviceError(std::string("CUDA: a graph cannot record what ") + what);
}

/// Of memory that this library gave back, up to a quarter of the device's; made when first asked
/// for.
cudaMemPool_t pool_of(int device);

inline void* allocate(std::size_t bytes, Stream stream) {
    require_no_recording(stream, "allocates");
    void* memory = nullptr;
    const cudaError_t status =
        cudaMallocFromPoolAsync(&memory, bytes, pool_of(stream.device), stream.handle);
    if (status == cudaErrorMemoryAllocation) {
        std::size_t free = 0, total = 0;
        cudaGetLastError(); // it is no error of a later call
        cudaMemGetInfo(&free, &total);
        throw DeviceOutOfMemory("an array", bytes, free);
    }
    require(status, "memory");
    return memory;
}
/// Without a word if it cannot: the process's last error was thrown before, or it ends.
inline void release(void* memory, Stream stream) {
    int before = 0;
    if (cudaGetDevice(&before) != cudaSuccess || choose_device(stream.device) != cudaSuccess)
        return;
    cudaFreeAsync(memory, stream.handle);
    choose_device(before);
}

template <class T> void upload(std::span<const T> from, T* to, Stream stream) {
    require_no_recording(stream, "copies from the host");
    require(
        cudaMemcpyAsync(to, from.data(), from.size_bytes(), cudaMemcpyHostToDevice, stream.handle),
        "upload");
}
template <class T> void download(const T* from, std::span<T> to, Stream stream) {
    require_no_recording(stream, "copies to the host");
    require(
        cudaMemcpyAsync(to.data(), from, to.size_bytes(), cudaMemcpyDeviceToHost, stream.handle),
        "download");
}

inline void wait(Stream stream) {
    require_no_recording(stream, "waits");
    require(cudaStreamSynchronize(stream.handle), "a kernel");
}

inline void copy(const void* from, void* to, std::size_t bytes, Stream stream) {
    require(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDeviceToDevice, stream.handle), "copy");
}
/// Memory of the host that a device reaches by itself.
inline void* allocate_pinned(std::size_t bytes) {
    void* memory = nullptr;
    require(cudaMallocHost(&memory, bytes), "pinned memory");
    return memory;
}
inline void release_pinned(void* memory) { cudaFreeHost(memory); }

/// A moment in a stream.
class Event {
  public:
    Event() { require(cudaEventCreate(&event_), "an event"); }
    Event(const Event&) = delete;
    Event& operator=(const Event&) = delete;
    ~Event() { cudaEventDestroy(event_); }
    void record(Stream stream) { require(cudaEventRecord(event_, stream.handle), "an event"); }
    /// Waits for both.
    double ns_since(const Event& earlier) const {
        float ms = 0;
        require(cudaEventSynchronize(event_), "a kernel");
        require(cudaEventElapsedTime(&ms, earlier.event_, event_), "an event");
        return static_cast<double>(ms) * 1e6;
    }

  private:
    cudaEvent_t event_ = nullptr;
};

inline void* make_stream() {
    cudaStream_t made = nullptr;
    require(cudaStreamCreateWithFlags(&made, cudaStreamNonBlocking), "a stream");
    return made;
}
inline void end_stream(void* stream) { cudaStreamDestroy(static_cast<cudaStream_t>(stream)); }

/// What was enqueued in a stream, to be started by one launch.
class Graph {
  public:
    Graph() = default;
    Graph(const Graph&) = delete;
    Graph& operator=(const Graph&) = delete;
    ~Graph() {
        if (made_)
            cudaGraphExecDestroy(made_);
    }
    void record(Stream stream, const std::function<void()>& enqueue) {
        require(cudaStreamBeginCapture(stream.handle, cudaStreamCaptureModeThreadLocal), "a graph");
        cudaGraph_t graph = nullptr;
        try {
            enqueue();
        } catch (...) {
            cudaStreamEndCapture(stream.handle, &graph);
            if (graph)
                cudaGraphDestroy(graph);
            cudaGetLastError(); // it is no error of a later call
            throw;
        }
        require(cudaStreamEndCapture(stream.handle, &graph), "a graph");
        const cudaError_t status = cudaGraphInstantiate(&made_, graph, 0);
        cudaGraphDestroy(graph);
        require(status, "a graph");
    }
    void launch(Stream stream) {
        ++n_launches;
        require(cudaGraphLaunch(made_, stream.handle), "a graph");
    }

  private:
    cudaGraphExec_t made_ = nullptr;
};

inline void fill_bytes(void* to, std::uint8_t byte, std::size_t n, Stream stream) {
    require(cudaMemsetAsync(to, byte, n, stream.handle), "fill");
}

} // namespace boxwood::cuda
