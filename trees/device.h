#pragma once

#include "trees/queries/sinks.h"
#include "trees/tree.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// The same trees on a CUDA device, with the same answers. A program that includes this needs no
/// CUDA: where Boxwood was compiled without nvcc, or there is no device, devices() is empty.
namespace boxwood {

/// A CUDA device that this program can use.
struct Device {
    int index = 0; ///< as CUDA counts them
    std::string name, bus_id;
    unsigned multiprocessors = 0;
    std::uint64_t memory_bytes = 0;
    int capability_major = 0, capability_minor = 0;
    int driver = 0, runtime = 0; ///< as CUDA has them: 13020 is 13.2
    bool ecc = false;
    double max_clock_ghz = 0;
};

/// Those there are, and if there are none why: no nvcc when this was compiled, no driver, a driver
/// older than the runtime, no device, or code for other devices alone.
std::vector<Device> devices();
std::string why_no_device();

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

} // namespace detail

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
    /// Forgets all but the first `size` elements; the memory stays.
    void shrink(std::size_t size) { size_ = size < size_ ? size : size_; }
    DeviceSpan<T> span() { return {static_cast<T*>(memory_.data()), size_}; }
    DeviceSpan<const T> span() const { return {static_cast<const T*>(memory_.data()), size_}; }
    /// Of as many elements; they are copied when it comes back.
    void write(std::span<const T> from) { memory_.write(from.data(), from.size_bytes()); }
    /// Waits until all is there.
    std::vector<T> to_host() const {
        std::vector<T> to(size_);
        memory_.read(to.data(), size_ * sizeof(T));
        return to;
    }

  private:
    detail::DeviceMemory memory_;
    std::size_t size_ = 0;
};

enum class DeviceBuilder : std::uint8_t {
    hilbert, ///< sixteen wide along a Hilbert curve: for pairs
    lbvh     ///< binary, by the curve's codes
};

struct DeviceBvhOptions {
    DeviceBuilder builder = DeviceBuilder::hilbert;
    DevicePlace place = {};
};

namespace detail {
class DeviceTree;
}

/// A tree of boxes on a device. What comes in host memory is copied there, and its answer back;
/// what comes as a DeviceSpan lies there already, and so does its answer, which is right for what
/// follows in the place's stream. Answers come in the same order each time, unless said otherwise.
/// Throws DeviceError, DeviceOutOfMemory, InvalidBox for the first bad box, and std::length_error
/// for more than max_items boxes. For one thread at a time.
class DeviceBvh {
  public:
    explicit DeviceBvh(Boxes boxes, const DeviceBvhOptions& options = {});
    /// The boxes stay the caller's, and as they are until the next update.
    explicit DeviceBvh(DeviceSpan<const Box> boxes, const DeviceBvhOptions& options = {});
    DeviceBvh(DeviceBvh&&) noexcept;
    DeviceBvh& operator=(DeviceBvh&&) noexcept;
    ~DeviceBvh();

    std::size_t size() const;
    const DeviceBvhOptions& options() const { return options_; }

    /// The boxes moved: as many as there were are fitted into the tree as it is, else, or by
    /// rebuild, it is made again. After an InvalidBox it is empty.
    void update(Boxes boxes);
    void update(DeviceSpan<const Box> boxes);
    void rebuild(Boxes boxes);
    void rebuild(DeviceSpan<const Box> boxes);

    /// Pairs of items whose boxes overlap. To the host they come in parts where the memory for all
    /// is short.
    std::uint64_t self_pair_count() const;
    std::vector<Pair> self_pairs() const;
    void self_pairs(PairSink& sink) const;
    DeviceArray<Pair> self_pairs_on_device() const;
    /// In any order, by one pass: how many there are. Those beyond the room are left out.
    std::uint64_t self_pairs_into(DeviceSpan<Pair> room) const;
    /// So, with room for somewhat more than the last time, and a second pass if that is too little.
    DeviceArray<Pair> unordered_self_pairs() const;

    /// Pairs of an item here and one of the other tree, which has the same builder and place.
    std::uint64_t pair_count(const DeviceBvh& other) const;
    std::vector<Pair> pairs(const DeviceBvh& other) const;
    void pairs(const DeviceBvh& other, PairSink& sink) const;
    DeviceArray<Pair> pairs_on_device(const DeviceBvh& other) const;

  private:
    DeviceBvhOptions options_;
    DeviceArray<Box> own_; ///< of boxes that came from the host
    std::unique_ptr<detail::DeviceTree> tree_;
    mutable std::uint64_t last_pairs_ = 0;
};

} // namespace boxwood
