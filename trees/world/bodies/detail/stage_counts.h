#pragma once

#include <array>
#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <utility>

namespace boxwood::detail {

/// The stages of a World, in the order in which they run.
enum class Stage : std::uint8_t {
    fit,
    update,
    groups,
    sweep,
    pairs,
    mesh_trees,
    collide,
    distance,
    within,
    contacts,
    first_contact
};
inline constexpr std::size_t stages = 11;
inline constexpr std::array<std::string_view, stages> stage_names{
    "fit",     "update",   "groups", "sweep",    "pairs",        "mesh_trees",
    "collide", "distance", "within", "contacts", "first_contact"};

/// What each stage did, from any number of threads.
class StageCounts {
  public:
    struct Count {
        std::atomic<std::uint64_t> calls = 0, items = 0, ns = 0;
    };

    explicit StageCounts(bool is_timed) : is_timed_(is_timed) {}
    const Count& of(Stage stage) const { return counts_[static_cast<std::size_t>(stage)]; }
    void clear() {
        for (Count& count : counts_)
            count.calls = count.items = count.ns = 0;
    }

    /// One call, whose time is another stage's.
    void note(Stage stage, std::size_t items) {
        Count& count = counts_[static_cast<std::size_t>(stage)];
        count.calls.fetch_add(1, std::memory_order_relaxed);
        count.items.fetch_add(items, std::memory_order_relaxed);
    }

    /// One call of a stage, until it ends. Calls of these counts that the same thread makes within
    /// it are not in its time.
    class Call {
      public:
        Call(StageCounts& counts, Stage stage, std::size_t n = 0)
            : items(n), count_(counts.counts_[static_cast<std::size_t>(stage)]), counts_(counts),
              is_timed_(counts.is_timed_) {
            if (!is_timed_)
                return;
            around_ = std::exchange(innermost, this);
            start_ = std::chrono::steady_clock::now();
        }
        Call(const Call&) = delete;
        Call& operator=(const Call&) = delete;
        ~Call() {
            constexpr auto any = std::memory_order_relaxed;
            count_.calls.fetch_add(1, any);
            count_.items.fetch_add(items, any);
            if (!is_timed_)
                return;
            const std::chrono::nanoseconds all = std::chrono::steady_clock::now() - start_;
            count_.ns.fetch_add(static_cast<std::uint64_t>((all - within_).count()), any);
            innermost = around_;
            if (around_ && &around_->counts_ == &counts_)
                around_->within_ += all;
        }
        std::size_t items;

      private:
        inline static thread_local const Call* innermost = nullptr;

        Count& count_;
        StageCounts& counts_;
        bool is_timed_;
        const Call* around_ = nullptr;
        mutable std::chrono::nanoseconds within_{0}; ///< of calls within it
        std::chrono::steady_clock::time_point start_;
    };

  private:
    bool is_timed_;
    std::array<Count, stages> counts_;
};

} // namespace boxwood::detail
