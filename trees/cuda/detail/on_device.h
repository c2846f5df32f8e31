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
};

template <class... Parameters, class... Arguments>
void launch(Stream stream, std::size_t n_blocks, unsigned n_threads, void (*kernel)(Parameters...),
            Arguments... arguments) {
    if (n_blocks == 0)
        return;
    ++n_launches;
    kernel<<<static_cast<unsigned>(n_blocks), n_threads, 0, stream.handle>>>(arguments...);
    require(cudaGetLastError(), "a kernel does not start");
}

inline void* allocate(std::size_t bytes, Stream stream) {
    void* memory = nullptr;
    const cudaError_t status = cudaMallocAsync(&memory, bytes, stream.handle);
    if (status == cudaErrorMemoryAllocation) {
        std::size_t free = 0, total = 0;
        cudaGetLastError(); // it is no error of a later call
        cudaMemGetInfo(&free, &total);
        throw DeviceOutOfMemory("an array", bytes, free);
    }
    require(status, "memory");
    return memory;
}
inline void release(void* memory, Stream stream) { cudaFreeAsync(memory, stream.handle); }

template <class T> void upload(std::span<const T> from, T* to, Stream stream) {
    require(
        cudaMemcpyAsync(to, from.data(), from.size_bytes(), cudaMemcpyHostToDevice, stream.handle),
        "upload");
}
template <class T> void download(const T* from, std::span<T> to, Stream stream) {
    require(
        cudaMemcpyAsync(to.data(), from, to.size_bytes(), cudaMemcpyDeviceToHost, stream.handle),
        "download");
}

inline void wait(Stream stream) { require(cudaStreamSynchronize(stream.handle), "a kernel"); }

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

/// The word's four bytes must be the same.
inline void fill_words(std::uint32_t* to, std::uint32_t word, std::size_t n, Stream stream) {
    require(cudaMemsetAsync(to, static_cast<int>(word & 255), n * sizeof(word), stream.handle),
            "fill");
}

} // namespace boxwood::cuda
