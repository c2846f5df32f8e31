#include "kernels/arithmetic/float_mode.h"
#include "trees/executor.h"
#include "trees/executors/detail/fork_join.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <optional>

namespace boxwood {
using namespace detail;
namespace {

class Tbb final : public Executor {
  public:
    explicit Tbb(unsigned threads) : threads_(threads), arena_(static_cast<int>(threads)) {
        // TBB starts no more workers than there are cores unless asked to.
        if (static_cast<int>(threads) > tbb::info::default_concurrency())
            more_workers_.emplace(tbb::global_control::max_allowed_parallelism, threads);
    }
    unsigned threads() const override { return threads_; }

    void for_each(std::size_t n, FunctionRef<void(std::size_t)> body) const override {
        if (threads_ == 1 || n <= 1) {
            serial().for_each(n, body);
            return;
        }
        ForkJoin fork_join;
        arena_.execute([&] {
            tbb::parallel_for(
                tbb::blocked_range<std::size_t>(0, n, 1),
                [&](const tbb::blocked_range<std::size_t>& range) {
                    const ForkJoin::Task task(fork_join);
                    const DenormalFlushing off(false);
                    for (std::size_t i = range.begin(); i < range.end(); ++i)
                        body(i);
                },
                tbb::simple_partitioner{});
        });
    }

  private:
    unsigned threads_;
    std::optional<tbb::global_control> more_workers_;
    mutable tbb::task_arena arena_;
};

} // namespace

ExecutorEntry tbb_executor() {
    return {"tbb", "oneTBB tasks in an arena of their own, work stealing",
            [](unsigned threads) -> std::unique_ptr<Executor> {
                return std::make_unique<Tbb>(threads);
            }};
}

} // namespace boxwood
