#pragma once

#include "bench/tasks/detail/point_classes.h"
#include "bench/tasks/detail/tree_contender.h"
#include "bench/tasks/detail/tree_task.h"
#include "bench/truth/point_truth.h"
#include "trees/executors/chunks.h"

namespace boxwood::bench {

/// How many queries a call takes: names of the key `calls`.
enum class Calls : std::uint8_t {
    batch, ///< all of them
    single
};

/// One tree that answers queries of many points or regions. `run` answers; work, if given, is
/// counted, on the executor serial().
class PointContender : public TreeContender {
  public:
    PointContender(const Job& job, BuildFunction build, const LayoutEntry& layout, Calls calls)
        : TreeContender(job, std::move(build), layout), calls_(calls) {}

    void query(Answers& answers) override { run(answers, *executor_, nullptr); }
    std::optional<Work> counted_query(Answers& answers) override {
        Work work;
        run(answers, serial(), &work);
        return work;
    }

  protected:
    virtual void run(Answers& answers, const Executor& executor, Work* work) = 0;

    /// So many calls of a thread at a time, if there are several.
    static std::size_t chunks_of(std::size_t n, const Executor& executor) {
        constexpr std::size_t calls = 256;
        return executor.threads() == 1 ? 1 : (n + calls - 1) / calls;
    }
    /// call(chunk, i) for each of n queries, chunks at the same time.
    template <class Call>
    static void one_by_one(std::size_t n, const Executor& executor, const Call& call) {
        const std::size_t chunks = chunks_of(n, executor);
        executor.for_each(chunks, [&](std::size_t chunk) {
            const ChunkRange range(n, chunks, chunk);
            for (std::size_t i = range.begin; i < range.end; ++i)
                call(chunk, i);
        });
    }

    Calls calls_;
};

/// One that answers with pairs of a query and an item.
class PointPairsContender : public PointContender {
  public:
    using PointContender::PointContender;

  protected:
    virtual std::size_t n_queries() const = 0;
    /// The pairs of n queries from one on, which the sink is given numbered from 0.
    virtual void find(std::size_t first, std::size_t n, const Executor& executor, PairSink& sink,
                      Work* work) const = 0;

  private:
    void run(Answers& answers, const Executor& executor, Work* work) override;

    PairsInto pairs_;
    std::vector<std::vector<Pair>> parts_; ///< of single calls, by chunk
};

/// A task about the points of a scene, or its regions, with the keys n_points and calls.
class PointTask : public TreeTask {
  public:
    explicit PointTask(PointQuery query) : query_(query) {}

    std::vector<std::string_view> keys() const override;
    std::optional<std::string> missing(const Scene& scene) const override;
    std::uint64_t n_queries(const Scene& scene) const override;
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_point_truth(scene, query_, threads);
    }

  protected:
    std::vector<SceneSpec> with_queries(const BlockReader& block,
                                        const SceneSpec& scene) const override;
    std::vector<Choice> variants(const BlockReader& block, const Choice& choice) const override;

    static Calls calls_of(const Choice& choice);
    /// The way of a C(job, build, layout, calls).
    template <class C>
    static Way way_of(const Choice& choice, std::string_view of_batches,
                      std::string_view of_single_calls, Query query) {
        const Calls calls = calls_of(choice);
        const bool is_batch = calls == Calls::batch;
        Way way{.traversal = is_batch ? of_batches : of_single_calls, .make = maker<C>(calls)};
        way.query = query;
        way.classes = {is_batch ? point_class::batches : point_class::single};
        return way;
    }

  private:
    PointQuery query_;
};

} // namespace boxwood::bench
