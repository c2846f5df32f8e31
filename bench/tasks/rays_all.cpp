/// For each ray every triangle that it meets, as pairs (ray, triangle).

#include "bench/tasks/all_hits.h"
#include "bench/tasks/detail/pair_answers.h"
#include "bench/tasks/detail/ray_classes.h"
#include "bench/tasks/detail/ray_task.h"
#include "bench/tasks/detail/rays_on_device.h"
#include "bench/truth/judging/case_truths.h"
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

class AllHitsOfMesh final : public RayContender {
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

class AllHitsOnDevice final : public RaysOnDevice {
  public:
    using RaysOnDevice::RaysOnDevice;

  private:
    void query_there() override { found_ = mesh_->all_hits(rays()); }
    std::uint64_t download(Answers&) override {
        found_.offsets.read(on_host_.offsets);
        found_.of.read(on_host_.of);
        return found_.offsets.size_bytes() + found_.of.size_bytes();
    }
    void convert(Answers& answers) override {
        std::vector<Pair>& pairs = list_of<Pair>(answers);
        pairs.clear();
        for (std::uint32_t ray = 0; ray + 1 < on_host_.offsets.size(); ++ray)
            for (const RayHit& hit : on_host_[ray])
                pairs.push_back({ray, hit.triangle});
    }

    DeviceAnswersOf<RayHit> found_;
    AnswersOf<RayHit> on_host_;
};

/// The hits of one mesh's rays, numbered from the first of them on.
class AppendHits final : public HitSink {
  public:
    AppendHits(AllHits& to, std::size_t first_ray, std::uint32_t first_triangle)
        : to_(to), first_ray_(static_cast<std::uint32_t>(first_ray)), first_(first_triangle) {}

    void begin(std::size_t, bool) override {}
    bool take(std::size_t, std::uint32_t ray, std::span<const RayHit> hits) override {
        for (RayHit hit : hits) {
            hit.triangle += first_;
            to_.list.push_back({first_ray_ + ray, hit.triangle});
            to_.hits.push_back(hit);
        }
        return true;
    }
    void end() override {}

  private:
    AllHits& to_;
    std::uint32_t first_ray_, first_;
};

class AllHitsOfCases final : public TreesOfCases {
  public:
    AllHitsOfCases(const Job& job, const BuildFunction& build, const LayoutEntry& layout,
                   std::string kernel)
        : TreesOfCases(job, build, layout), kernel_(std::move(kernel)) {}
    void query(Answers& answers) override {
        auto& to = dynamic_cast<AllHits&>(answers);
        to.list.clear();
        to.hits.clear();
        for (const Group& group : groups_) {
            AppendHits sink(to, group.first_ray, group.first);
            group.layout->rays_all(group.rays, kernel_, group.triangles, serial(), sink);
        }
    }

  private:
    std::string kernel_;
};

class RaysAll final : public PairAnswers<RayTask> {
  public:
    std::string_view name() const override { return "rays_all"; }
    std::string title() const override { return "all hits"; }
    std::string_view summary() const override {
        return "for each ray every triangle that it meets";
    }
    std::unique_ptr<Answers> make_answers() const override { return std::make_unique<AllHits>(); }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        if (fits(scene.cases))
            return make_all_hits_of_cases_truth({scene, name(), threads});
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
        const auto make = [of_mesh = maker<AllHitsOfMesh>(choice.kernel),
                           of_cases = maker<AllHitsOfCases>(choice.kernel)](
                              const Job& job, BuildFunction build, const LayoutEntry& layout) {
            const bool has_cases = std::holds_alternative<RayCases>(job.scene->cases);
            return has_cases ? of_cases(job, std::move(build), layout)
                             : of_mesh(job, std::move(build), layout);
        };
        Way way{"rays_all", choice.kernel, kernel.promise,
                make,       Query::rays,   ray_class::of_ours({ray_class::batches}, choice.kernel)};
        const std::optional<DeviceMeshBvhOptions> options = device_options(choice);
        if (options && options->builder == DeviceBuilder::hilbert)
            way.why_not_on_device =
                "the builder hilbert, which has a warp for a ray, keeps one hit";
        else if (options)
            way.make_on_device = [options = *options](const Job& job) {
                return std::make_unique<AllHitsOnDevice>(job, options);
            };
        return way;
    }
    /// Cut triangles stand in several leaves, but no hit twice.
    std::vector<CaseWay> ways_on_cases(Promise) const override {
        return {{"binned_sah", "given"}, {"spatial_sah", "given"}};
    }
};

} // namespace

const Task& rays_all_task() {
    static const RaysAll task;
    return task;
}

} // namespace boxwood::bench
