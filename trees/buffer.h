#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <type_traits>
#include <utility>

namespace boxwood {

/// Memory aligned to cache lines, and on huge pages where it fills several. Throws std::bad_alloc.
/// Up to 256 MiB of large blocks that were freed are kept for the next; the system may take their
/// pages back.
void* allocate_lines(std::size_t bytes);
void free_lines(void* memory);

/// An owned array of trivial elements, aligned to a cache line and left uninitialised: a builder
/// writes every element once, so clearing them first would double the memory traffic.
template <class T> class Buffer {
    static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_destructible_v<T>);
    static_assert(alignof(T) <= 64);
    struct Free {
        void operator()(T* p) const { free_lines(p); }
    };

  public:
    Buffer() = default;
    explicit Buffer(std::size_t size)
        : data_(size ? static_cast<T*>(allocate_lines(size * sizeof(T))) : nullptr), size_(size) {}
    Buffer(Buffer&& other) noexcept
        : data_(std::move(other.data_)), size_(std::exchange(other.size_, 0)) {}
    Buffer& operator=(Buffer&& other) noexcept {
        data_ = std::move(other.data_);
        size_ = std::exchange(other.size_, 0);
        return *this;
    }

    std::size_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    std::size_t bytes() const { return size_ * sizeof(T); }
    T* data() { return data_.get(); }
    const T* data() const { return data_.get(); }
    T& operator[](std::size_t i) { return data_.get()[i]; }
    const T& operator[](std::size_t i) const { return data_.get()[i]; }
    T* begin() { return data(); }
    T* end() { return data() + size_; }
    const T* begin() const { return data(); }
    const T* end() const { return data() + size_; }
    std::span<T> span() { return {data(), size_}; }
    std::span<const T> span() const { return {data(), size_}; }

    /// Forgets all but the first `size` elements; the memory stays.
    void shrink(std::size_t size) { size_ = size < size_ ? size : size_; }

  private:
    std::unique_ptr<T[], Free> data_;
    std::size_t size_ = 0;
};

} // namespace boxwood
