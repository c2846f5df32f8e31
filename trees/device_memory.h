#pragma once

#include "trees/queries/answers.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace boxwood {

/// What CUDA could not do: what, where, and how to fix it. After a fault in a kernel the process
/// can use no device any more.
class DeviceError : public std::runtime_error {
    using std::runtime_error::runtime_error;
};
/// Comes before anything was started that would need the memory.
class DeviceOutOfMemory : public DeviceError {
  public:
    DeviceOutOfMemory(const std::string& what, std::uint64_t needed_, std::uint64_t free_);
    std::uint64_t needed, free; ///< bytes
};

/// Elements in a device's memory, which the host must not read.
template <class T> struct DeviceSpan {
    T* data = nullptr;
    std::size_t size = 0;

    DeviceSpan() = default;
    DeviceSpan(T* data_, std::size_t size_) : data(data_), size(size_) {}
    template <class U>
    requires std::is_same_v<const U, T> DeviceSpan(const DeviceSpan<U>& other)
        : data(other.data), size(other.size) {}
};

/// Which device, and the stream in whose order it works: a cudaStream_t; null is the default
/// stream.
struct DevicePlace {
    int index = 0;
    void* stream = nullptr;
};

/// Until all is done that was enqueued in the place's stream. Throws DeviceError for what failed.
void wait_for(DevicePlace place);

namespace detail {

/// Bytes in a device's memory, owned.
class DeviceMemory {
  public:
    DeviceMemory() = default;
    /// Throws DeviceOutOfMemory.
    DeviceMemory(std::size_t bytes, DevicePlace place);
    DeviceMemory(DeviceMemory&& other) noexcept { *this = std::move(other); }
    DeviceMemory& operator=(DeviceMemory&& other) noexcept {
        std::swap(data_, other.data_);
        std::swap(place_, other.place_);
        return *this;
    }
    ~DeviceMemory();

    void* data() const { return data_; }
    DevicePlace place() const { return place_; }
    /// In the order of the stream; `read` waits for it.
    void write(const void* from, std::size_t bytes);
    void read(void* to, std::size_t bytes) const;

  private:
    void* data_ = nullptr;
    DevicePlace place_;
};

void require_as_many(std::size_t given, std::size_t there);

} // namespace detail

/// How many kernels this thread has started, those within CUB apart.
std::uint64_t launches_so_far();

/// Times by the device's own clock what a place's stream does.
class DeviceTimer {
  public:
    explicit DeviceTimer(DevicePlace place);
    DeviceTimer(const DeviceTimer&) = delete;
    DeviceTimer& operator=(const DeviceTimer&) = delete;
    ~DeviceTimer();

    void start();
    /// Of all that was enqueued since the start; waits until it is done.
    double stop_ns();

  private:
    struct Events;
    DevicePlace place_;
    std::unique_ptr<Events> events_;
};

/// An array in a device's memory, owned: answers that stay there.
template <class T> class DeviceArray {
  public:
    DeviceArray() = default;
    DeviceArray(std::size_t size, DevicePlace place)
        : memory_(size * sizeof(T), place), size_(size) {}
    DeviceArray(std::span<const T> from, DevicePlace place) : DeviceArray(from.size(), place) {
        write(from);
    }
    DeviceArray(DeviceArray&& other) noexcept
        : memory_(std::move(other.memory_)), size_(std::exchange(other.size_, 0)) {}
    DeviceArray& operator=(DeviceArray&& other) noexcept {
        memory_ = std::move(other.memory_);
        size_ = std::exchange(other.size_, 0);
        return *this;
    }

    std::size_t size() const { return size_; }
    std::size_t size_bytes() const { return size_ * sizeof(T); }
    /// Forgets all but the first `size` elements; the memory stays.
    void shrink(std::size_t size) { size_ = size < size_ ? size : size_; }
    DeviceSpan<T> span() { return {static_cast<T*>(memory_.data()), size_}; }
    DeviceSpan<const T> span() const { return {static_cast<const T*>(memory_.data()), size_}; }
    /// As many elements as there are, else std::invalid_argument; they are copied when it comes
    /// back.
    void write(std::span<const T> from) {
        detail::require_as_many(from.size(), size_);
        memory_.write(from.data(), from.size_bytes());
    }
    /// Waits until all is there.
    void read(std::vector<T>& to) const {
        to.resize(size_);
        memory_.read(to.data(), size_ * sizeof(T));
    }
    std::vector<T> to_host() const {
        std::vector<T> to;
        read(to);
        return to;
    }

  private:
    detail::DeviceMemory memory_;
    std::size_t size_ = 0;
};

/// AnswersOf in a device's memory.
template <class T> struct DeviceAnswersOf {
    DeviceArray<std::uint64_t> offsets;
    DeviceArray<T> of;

    AnswersOf<T> to_host() const { return {offsets.to_host(), of.to_host()}; }
};

/// By whom a tree is made on a device.
enum class DeviceBuilder : std::uint8_t {
    hilbert, ///< sixteen wide along a Hilbert curve: for pairs, and for few queries
    lbvh,    ///< by the curve's codes
    hploc    ///< by area: the best trees of these for rays
};

} // namespace boxwood
