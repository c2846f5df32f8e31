#pragma once

// How kernels are started and where their arrays are, from one source: by nvcc on a device, by g++
// on the host (on_host.h). A kernel is a `__global__ void` function of plain values and pointers.

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace boxwood::cuda {
inline thread_local std::uint64_t n_launches = 0; ///< by this thread
} // namespace boxwood::cuda

#if defined(__CUDACC__)
#include "trees/cuda/detail/on_device.h"
#else
#include "trees/cuda/on_host.h"

#include "trees/device_memory.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <functional>
#include <new>
#include <string>
#include <vector>
#endif

namespace boxwood::cuda {

#if !defined(__CUDACC__)

/// Work that is done in order.
struct Stream {};

template <class... Parameters, class... Arguments>
void launch(Stream, std::size_t n_blocks, unsigned n_threads, void (*kernel)(Parameters...),
            Arguments... arguments) {
    if (n_blocks == 0)
        return;
    ++n_launches;
    on_host::in_turn([=] {
        on_host::run_grid(static_cast<unsigned>(n_blocks), n_threads,
                          [&] { kernel(arguments...); });
    });
}

/// What no graph can do again is refused while one is recorded.
inline void require_no_recording(Stream, const char* what) {
    if (on_host::is_recording())
        throw DeviceError(std::string("CUDA: a graph cannot record what ") + what);
}

inline void* allocate(std::size_t bytes, Stream stream) {
    require_no_recording(stream, "allocates");
    return on_host::allocate(bytes);
}
inline void release(void* memory, Stream) { on_host::release(memory); }

template <class T> void upload(std::span<const T> from, T* to, Stream stream) {
    require_no_recording(stream, "copies from the host");
    std::ranges::copy(from, to);
}
template <class T> void download(const T* from, std::span<T> to, Stream stream) {
    require_no_recording(stream, "copies to the host");
    std::copy_n(from, to.size(), to.data());
}

inline void fill_bytes(void* to, std::uint8_t byte, std::size_t n, Stream) {
    on_host::in_turn([=] { std::memset(to, byte, n); });
}

/// Until all is done that was started before.
inline void wait(Stream stream) { require_no_recording(stream, "waits"); }

inline void copy(const void* from, void* to, std::size_t bytes, Stream) {
    on_host::in_turn([=] { std::memcpy(to, from, bytes); });
}
/// Memory of the host that a device reaches by itself.
inline void* allocate_pinned(std::size_t bytes) { return ::operator new(bytes); }
inline void release_pinned(void* memory) { ::operator delete(memory); }

/// A moment in a stream.
class Event {
  public:
    void record(Stream) { at_ = std::chrono::steady_clock::now(); }
    /// Waits for both.
    double ns_since(const Event& earlier) const {
        return std::chrono::duration<double, std::nano>(at_ - earlier.at_).count();
    }

  private:
    std::chrono::steady_clock::time_point at_;
};

inline void* make_stream() {
    static int stream; // any that is not null
    return &stream;
}
inline void end_stream(void*) {}

/// What was enqueued in a stream, to be started by one launch.
class Graph {
  public:
    void record(Stream, const std::function<void()>& enqueue) { work_ = on_host::record(enqueue); }
    void launch(Stream) {
        ++n_launches;
        for (const std::function<void()>& one : work_)
            one();
        released_.require_untouched();
    }

  private:
    std::vector<std::function<void()>> work_;
    on_host::Released released_;
};

#endif

/// An array of uninitialised trivial elements in the device's memory.
template <class T> class Array {
  public:
    Array() = default;
    Array(std::size_t size, Stream stream)
        : data_(static_cast<T*>(size > 0 ? allocate(size * sizeof(T), stream) : nullptr)),
          size_(size), stream_(stream) {}
    Array(Array&& other) noexcept { swap(other); }
    Array& operator=(Array&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Array() {
        if (data_)
            release(data_, stream_);
    }
    std::size_t size() const { return size_; }
    T* data() { return data_; }
    const T* data() const { return data_; }

  private:
    void swap(Array& other) {
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(stream_, other.stream_);
    }
    T* data_ = nullptr;
    std::size_t size_ = 0;
    Stream stream_;
};

template <class T> void upload(std::span<const T> from, Array<T>& to, Stream stream) {
    upload(from, to.data(), stream);
}

/// Blocks of n_threads that make at least n threads.
constexpr std::size_t blocks_for(std::size_t n, std::size_t n_threads) {
    return (n + n_threads - 1) / n_threads;
}

} // namespace boxwood::cuda
