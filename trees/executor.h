#pragma once

#include "trees/function_ref.h"

#include <concepts>
#include <cstddef>
#include <limits>
#include <memory>
#include <span>
#include <string_view>
#include <type_traits>

namespace boxwood {

/// Where work runs. Algorithms cut their work into chunks by the input alone, never by the number
/// of threads, so that answers and their order are the same on every executor.
class Executor {
  public:
    virtual ~Executor() = default;

    /// Number of threads that may run chunks, at least 1.
    virtual unsigned threads() const = 0;

    /// Calls body(i) once for each i < n and returns when all are done. With one thread the calls
    /// come in order; else in any order and at the same time. An exception from a body is rethrown
    /// here. Denormals are kept in every body, whatever the mode of the caller or of the thread.
    virtual void for_each(std::size_t n, FunctionRef<void(std::size_t)> body) const = 0;
};

/// What may be passed as an executor.
template <class E>
concept ExecutorType = std::derived_from<E, Executor> && !std::is_abstract_v<E>;

/// A registry row. `make(threads)` gives an executor of exactly that many threads.
struct ExecutorEntry {
    std::string_view name, summary;
    std::unique_ptr<Executor> (*make)(unsigned threads);
    unsigned max_threads = std::numeric_limits<unsigned>::max();
};

std::span<const ExecutorEntry> executors();

/// The executor to take for so many threads where none is named: serial, else tbb, or openmp where
/// Boxwood was built without TBB.
std::string_view default_executor(unsigned threads);

/// The executor by its registered name. Throws std::invalid_argument for an unknown one, and for
/// no threads or more than it can have.
std::unique_ptr<Executor> make_executor(std::string_view name, unsigned threads);

/// One thread, the caller's own.
const Executor& serial();

} // namespace boxwood
