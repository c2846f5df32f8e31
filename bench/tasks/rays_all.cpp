/// For each ray every triangle that it meets, as pairs (ray, triangle).

#include "bench/tasks/detail/pair_answers.h"
#include "bench/tasks/detail/ray_classes.h"
#include "bench/tasks/detail/ray_task.h"
#include "bench/truth/rays_all_truth.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"

namespace boxwood::bench {
namespace {

/// The pairs of the hits, each chunk by itself: the chunks in order at the end.
class HitPairs final : public HitSink {
  public:
    void begin(std::size_t chunks, bool) override {
        if (parts_.size() < chunks)
            parts_.resize(chunks);
        for (std::vector<Pair>& part : parts_)
            part.clear();
    }
    bool take(std::size_t chunk, std::uint32_t ray, std::span<const RayHit> hits) override {
        for (const RayHit& hit : hits)
            parts_[chunk].push_back({ray, hit.triangle});
        return true;
    }
    void end() override {}

    void append_to(std::vector<Pair>& pairs) const {
        for (const std::vector<Pair>& part : parts_)
            pairs.insert(pairs.end(), part.begin(), part.end());
    }

  private:
    std::vector<std::vector<Pair>> parts_;
};

class AllHits final : public RayContender {
  public:
    using RayContender::RayContender;
    void query(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        layout_->rays_all(scene_.rays, kernel_, triangles_, *executor_, sink_);
        sink_.append_to(pairs);
    }

  private:
    HitPairs sink_;
};

class RaysAll final : public PairAnswers<RayTask> {
  public:
    std::string_view name() const override { return "rays_all"; }
    std::string title() const override { return "all hits"; }
    std::string_view summary() const override {
        return "for each ray every triangle that it meets";
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_all_hits_truth(scene, threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::vector<NamedCount> counts{{"hits", answers.size()}};
        append_work(counts, work, true);
        return counts;
    }

  protected:
    Way way(const Choice& choice) const override {
        const KernelInfo& kernel = entry_named(choice.kernel, ray_kernels(), "ray kernel");
        return {"rays_all",     choice.kernel,
                kernel.promise, maker<AllHits>(choice.kernel),
                Query::rays,    ray_class::of_ours({ray_class::batches}, choice.kernel)};
    }
};

} // namespace

const Task& rays_all_task() {
    static const RaysAll task;
    return task;
}

} // namespace boxwood::bench
