#pragma once

#include "results/schema.h"

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace boxwood::results::detail {

/// A call into HDF5 failed: what was being done, and the innermost cause that HDF5 gives.
class Hdf5Error : public std::runtime_error {
  public:
    explicit Hdf5Error(std::string_view doing);
};

/// Passes on what an HDF5 call returned; throws Hdf5Error if that says failure (below zero).
template <class Status> Status checked(Status status, std::string_view doing) {
    if (status < 0)
        throw Hdf5Error(doing);
    return status;
}

/// Owns an HDF5 identifier. Throws Hdf5Error if it is not valid.
class Handle {
  public:
    Handle(hid_t id, herr_t (*closer)(hid_t), std::string_view doing)
        : id_(checked(id, doing)), close_(closer) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;
    ~Handle() {
        if (id_ >= 0)
            close_(id_);
    }
    /// Throws Hdf5Error if closing fails, as a destructor cannot.
    void close(std::string_view doing) { checked(close_(std::exchange(id_, -1)), doing); }
    operator hid_t() const { return id_; } // NOLINT: the C API takes identifiers

  private:
    hid_t id_;
    herr_t (*close_)(hid_t);
};

/// Our type of a column of numbers.
Handle number_type(Stored stored, std::string_view doing);
/// Scalar text: UTF-8 of variable length.
Handle text_type();
/// UTF-8 of `width` bytes, padded with zero bytes.
Handle string_type(std::size_t width);

/// HDF5 prints no errors of its own while this lives.
class Silence {
  public:
    Silence();
    ~Silence();
    Silence(const Silence&) = delete;
    Silence& operator=(const Silence&) = delete;

  private:
    H5E_auto2_t print_ = nullptr;
    void* data_ = nullptr;
};

} // namespace boxwood::results::detail
