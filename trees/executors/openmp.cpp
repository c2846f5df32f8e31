#include "kernels/arithmetic/float_mode.h"
#include "trees/executor.h"
#include "trees/executors/detail/fork_join.h"

#include <exception>
#include <mutex>

namespace boxwood {
using namespace detail;
namespace {

class OpenMp final : public Executor {
  public:
    explicit OpenMp(unsigned threads) : threads_(threads) {}
    unsigned threads() const override { return threads_; }

    void for_each(std::size_t n, FunctionRef<void(std::size_t)> body) const override {
        if (threads_ == 1 || n <= 1) {
            serial().for_each(n, body);
            return;
        }
        // An exception must not leave an OpenMP region: the first one is carried out by hand.
        std::exception_ptr error;
        std::mutex mutex;
        ForkJoin fork_join;
#pragma omp parallel for schedule(dynamic, 1) num_threads(static_cast <int>(threads_))
        for (std::size_t i = 0; i < n; ++i) {
            const ForkJoin::Task task(fork_join);
            const DenormalFlushing off(false);
            try {
                body(i);
            } catch (...) {
                const std::lock_guard lock(mutex);
                if (!error)
                    error = std::current_exception();
            }
        }
        if (error)
            std::rethrow_exception(error);
    }

  private:
    unsigned threads_;
};

} // namespace

ExecutorEntry openmp_executor() {
    return {"openmp", "OpenMP threads, chunks handed out dynamically",
            [](unsigned threads) -> std::unique_ptr<Executor> {
                return std::make_unique<OpenMp>(threads);
            }};
}

} // namespace boxwood
