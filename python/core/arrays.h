#pragma once

#include "kernels/arithmetic/float_mode.h"
#include "kernels/primitives/triangle.h"
#include "kernels/primitives/vec3.h"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

/// numpy arrays in and out. What lies in memory as Boxwood wants it is read where it lies; what is
/// found is handed over, not copied.
namespace boxwood::python {

namespace py = pybind11;

/// "(12, 3)"
inline std::string shape_of(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t i = 0; i < array.ndim(); ++i)
        text += (i ? ", " : "") + std::to_string(array.shape(i));
    return text + (array.ndim() == 1 ? ",)" : ")");
}

/// Any array, nested list or buffer of real numbers. Throws TypeError for what is none or has a
/// mask, and ValueError for rows of several lengths.
inline py::array numbers_of(const py::handle& given, const std::string& name) {
    if (py::isinstance<py::array>(given) && py::hasattr(given, "filled"))
        throw py::type_error(name + ": a masked array is not taken; give its filled()");
    py::array array;
    try {
        array = py::module_::import("numpy").attr("asarray")(given);
    } catch (const py::error_already_set& error) {
        if (!error.matches(PyExc_ValueError))
            throw;
        throw py::value_error(name + ": " + std::string(py::str(error.value())));
    }
    if (std::string("fiub").find(array.dtype().kind()) == std::string::npos)
        throw py::type_error(name + ": real numbers are wanted, not an array of " +
                             std::string(py::str(array.dtype())));
    return array;
}

/// Numbers T in rows of `row` (3: vectors; {3, 3}: triangles), one after the other. Contiguous
/// arrays of T are not copied.
template <class T> class Rows {
  public:
    Rows(const py::handle& given, const std::string& name, std::initializer_list<py::ssize_t> row)
        : name_(name) {
        py::array array = numbers_of(given, name);
        if (array.size() == 0 && array.ndim() == 1) { // an empty list
            std::vector<py::ssize_t> shape{0};
            shape.insert(shape.end(), row.begin(), row.end());
            array = array.reshape(shape);
        }
        bool fits = array.ndim() == static_cast<py::ssize_t>(row.size()) + 1;
        std::string wanted = "(n";
        py::ssize_t axis = 1;
        for (const py::ssize_t extent : row) {
            fits = fits && array.shape(axis++) == extent;
            wanted += ", " + std::to_string(extent);
        }
        if (!fits)
            throw py::value_error(name + ": an array of shape " + wanted + ") is wanted, not " +
                                  shape_of(array));
        array_ = Array(std::move(array));
        n_ = static_cast<std::size_t>(array_.shape(0));
        for (const py::ssize_t extent : row)
            columns_ *= static_cast<std::size_t>(extent);
    }

    std::size_t size() const { return n_; }
    const std::string& name() const { return name_; }
    /// As records of the same numbers: Rows<float>(..., {3}).as<Vec3<float>>().
    template <class Record> std::span<const Record> as() const {
        static_assert(sizeof(Record) % sizeof(T) == 0 && alignof(Record) == alignof(T));
        return {reinterpret_cast<const Record*>(array_.data()), n_};
    }
    std::span<const T> numbers() const { return {array_.data(), n_ * columns_}; }

    /// Throws ValueError for the first row with a number for which `is_good` is false.
    template <class Good> void require(const Good& is_good, const std::string& what) const {
        const std::span<const T> all = numbers();
        for (std::size_t i = 0; i < all.size(); ++i)
            if (!is_good(all[i]))
                throw py::value_error(name_ + ": row " + std::to_string(i / columns_) + " " + what);
    }
    void require_finite() const {
        require([](T x) { return std::isfinite(x); },
                std::is_same_v<T, float> ? "has a NaN, an infinity or a number beyond float32"
                                         : "has a NaN or an infinity");
    }

  private:
    static constexpr int aligned = py::detail::npy_api::NPY_ARRAY_ALIGNED_;
    using Array = py::array_t<T, py::array::c_style | py::array::forcecast | aligned>;
    std::string name_;
    Array array_;
    std::size_t n_ = 0, columns_ = 1;
};

/// As the library counts them. Throws ValueError for none and for more than 1024.
inline unsigned threads_of(std::int64_t threads) {
    if (threads < 1 || threads > 1024)
        throw py::value_error("threads: 1 to 1024 are wanted, not " + std::to_string(threads));
    return static_cast<unsigned>(threads);
}

/// Numbers of items, each below `limit`; `columns` 0: shape (n,).
std::vector<std::uint32_t> indices_of(const py::handle& given, const std::string& name,
                                      std::size_t limit, py::ssize_t columns = 0);

/// vertices: (n, 3), rounded to floats; faces: (m, 3), integers below n.
TriangleMesh mesh_of(const py::handle& vertices, const py::handle& faces);

/// A vector's memory, which lives as long as one of its arrays.
template <class T> class Owned {
  public:
    explicit Owned(std::vector<T> found)
        : found_(new std::vector<T>(std::move(found))),
          owner_(found_, [](void* p) { delete static_cast<std::vector<T>*>(p); }) {}

    std::size_t size() const { return found_->size(); }
    const T* data() const { return found_->data(); }

    /// The numbers of a member of each record: shape (n,), or (n, columns).
    template <class Number> py::array column(std::size_t offset, py::ssize_t columns = 0) const {
        std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(size())};
        std::vector<py::ssize_t> strides{sizeof(T)};
        if (columns) {
            shape.push_back(columns);
            strides.push_back(sizeof(Number));
        }
        const auto* const first = reinterpret_cast<const std::byte*>(data()) + offset;
        return py::array_t<Number>(shape, strides, reinterpret_cast<const Number*>(first), owner_);
    }

  private:
    std::vector<T>* found_;
    py::capsule owner_;
};

/// One record or number a row.
template <class Number, class T> py::array array_of(std::vector<T> found, py::ssize_t columns = 0) {
    return Owned<T>(std::move(found)).template column<Number>(0, columns);
}

/// What the library took of all calls so far, for scripts/python_bench.
inline std::atomic<std::int64_t> inside_ns = 0;

/// Work without Python's lock, in which denormals are kept.
template <class Work> auto without_gil(const Work& work) {
    const py::gil_scoped_release release;
    const DenormalFlushing off(false); // some module may have left it on
    struct Clock {
        std::chrono::steady_clock::time_point start = std::chrono::steady_clock::now();
        ~Clock() { inside_ns += (std::chrono::steady_clock::now() - start).count(); }
    } const clock;
    return work();
}

/// The class of boxwood/_answers.py.
py::object named_tuple(const char* name);

} // namespace boxwood::python
