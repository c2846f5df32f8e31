#pragma once

// The device's side of launch.h; for nvcc alone.

#include <cstddef>
#include <cstdint>
#include <cuda_runtime.h>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace boxwood::cuda {

/// Throws what CUDA says, and of what.
inline void require(cudaError_t status, const char* what) {
    if (status != cudaSuccess)
        throw std::runtime_error(std::string("CUDA: ") + what + ": " + cudaGetErrorString(status));
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
    kernel<<<static_cast<unsigned>(n_blocks), n_threads, 0, stream.handle>>>(arguments...);
    require(cudaGetLastError(), "a kernel does not start");
}

/// An array of uninitialised trivial elements in the device's memory.
template <class T> class Array {
  public:
    Array() = default;
    Array(std::size_t size, Stream stream) : size_(size), stream_(stream) {
        if (size > 0)
            require(cudaMallocAsync(&data_, size * sizeof(T), stream.handle), "memory");
    }
    Array(Array&& other) noexcept { swap(other); }
    Array& operator=(Array&& other) noexcept {
        swap(other);
        return *this;
    }
    ~Array() {
        if (data_)
            cudaFreeAsync(data_, stream_.handle);
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
    require(cudaMemcpyAsync(to.data(), from.data(), from.size_bytes(), cudaMemcpyHostToDevice,
                            stream.handle),
            "upload");
}
template <class T> void download(const T* from, std::span<T> to, Stream stream) {
    require(
        cudaMemcpyAsync(to.data(), from, to.size_bytes(), cudaMemcpyDeviceToHost, stream.handle),
        "download");
}

inline void wait(Stream stream) { require(cudaStreamSynchronize(stream.handle), "a kernel"); }

/// The word's four bytes must be the same.
inline void fill_words(std::uint32_t* to, std::uint32_t word, std::size_t n, Stream stream) {
    require(cudaMemsetAsync(to, static_cast<int>(word & 255), n * sizeof(word), stream.handle),
            "fill");
}

} // namespace boxwood::cuda
