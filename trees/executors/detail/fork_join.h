#pragma once

#ifdef BOXWOOD_THREAD_SANITIZER
#include <sanitizer/tsan_interface.h>
#endif

namespace boxwood::detail {

/// What an executor promises, reported to ThreadSanitizer: what came before the fork is seen by
/// every task, and what the tasks did by whoever waits for them; nothing between two tasks.
/// Debian's libgomp and oneTBB are not instrumented, and the executors' own files are compiled
/// without (or TBB's templates would tell half of it), so it learns of forks and joins here alone.
/// An empty type in all other builds.
class ForkJoin {
  public:
#ifdef BOXWOOD_THREAD_SANITIZER
    ForkJoin() { __tsan_release(&fork_); }
    ~ForkJoin() { __tsan_acquire(&join_); }
    ForkJoin(const ForkJoin&) = delete;
    ForkJoin& operator=(const ForkJoin&) = delete;

    class Task {
      public:
        explicit Task(ForkJoin& of) : of_(of) { __tsan_acquire(&of_.fork_); }
        ~Task() { __tsan_release(&of_.join_); }
        Task(const Task&) = delete;
        Task& operator=(const Task&) = delete;

      private:
        ForkJoin& of_;
    };

  private:
    char fork_ = 0, join_ = 0; ///< two: at one place, each task would seem to wait for those before
#else
    ForkJoin() {} // not = default: no warning of an unused variable
    struct Task {
        explicit Task(ForkJoin&) {}
    };
#endif
};

} // namespace boxwood::detail
