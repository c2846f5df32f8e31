#include "bench/tasks/detail/ray_task.h"

#include "bench/tasks/detail/ray_classes.h"
#include "bench/truth/hit_truth.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"
#include "trees/queries/single_rays.h"
#include "trees/queries/sorted_rays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

namespace boxwood::bench {
namespace {

class Hits final : public RayContender {
  public:
    Hits(const Job& job, BuildFunction build, const LayoutEntry& layout, std::string kernel,
         RayQuery query, std::string_view order)
        : RayContender(job, std::move(build), layout, std::move(kernel)), query_(query),
          order_(order) {}

    void build() override {
        single_.reset();
        RayContender::build();
        if (order_ == "single")
            single_.emplace(*layout_, kernel_, triangles_);
    }

    void query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(scene_.rays.size());
        if (single_)
            one_by_one(hits);
        else if (order_ == "sorted")
            sorted_rays(*layout_, scene_.rays, query_, kernel_, triangles_, *executor_, hits);
        else
            layout_->rays(scene_.rays, query_, kernel_, triangles_, *executor_, hits);
    }

    /// The order in which rays are traced changes no count.
    std::optional<Work> counted_query(Answers& answers) override {
        std::vector<RayHit>& hits = list_of<RayHit>(answers);
        hits.resize(scene_.rays.size());
        return layout_->rays_counted(scene_.rays, query_, kernel_, triangles_, hits);
    }

  private:
    /// Embree's share of rays per chunk; its any-hits do not say which triangle it was.
    void one_by_one(std::vector<RayHit>& hits) const {
        constexpr std::size_t chunk = 256;
        executor_->for_each((hits.size() + chunk - 1) / chunk, [&](std::size_t c) {
            const std::size_t end = std::min(hits.size(), (c + 1) * chunk);
            for (std::size_t i = c * chunk; i < end; ++i)
                if (query_ == RayQuery::closest) {
                    hits[i] = single_->closest(scene_.rays[i]);
                } else {
                    hits[i] = {};
                    if (single_->any(scene_.rays[i]))
                        hits[i].triangle = 0;
                }
        });
    }

    RayQuery query_;
    std::string_view order_;
    std::optional<SingleRays> single_; ///< of the order "single"
};

const std::array orders{
    RayOrderEntry{"given",
                  "a batch as it comes, some of its rays on their way at a time",
                  "rays",
                  {ray_class::packets, ray_class::batches}},
    RayOrderEntry{"sorted",
                  "a batch by direction and place, answers put back",
                  "sorted_rays",
                  {ray_class::packets}},
    RayOrderEntry{"single",
                  "one ray in a call, answered before the next",
                  "single_rays",
                  {ray_class::single}}};

} // namespace

std::span<const RayOrderEntry> ray_orders() { return orders; }

void RayContender::build() {
    triangles_ = {};
    if (build_.build_of_mesh) {
        layout_.reset();
        tree_ = build_.build_of_mesh(scene_.mesh, *executor_);
        layout_ = layout_entry_.make(tree_, *executor_);
    } else {
        TreeContender::build();
    }
    triangles_ = layout_->triangles(scene_.mesh, *executor_);
}

std::vector<std::string_view> RayTask::keys() const {
    std::vector<std::string_view> all = TreeTask::keys();
    all.insert(all.end(), {"rays", "n_rays", "kernels"});
    return all;
}

std::vector<SceneSpec> RayTask::with_queries(const BlockReader& block,
                                             const SceneSpec& scene) const {
    const std::vector<std::string> kinds = block.names("rays", names_of(ray_kinds()));
    if (kinds.empty())
        block.fail(fmt::format("the task {} needs rays: one or more of {}", name(),
                               fmt::join(names_of(ray_kinds()), ", ")));
    std::vector<SceneSpec> all;
    for (const std::string& kind : kinds) {
        all.push_back(scene);
        all.back().rays = kind;
        all.back().n_rays = block.integer("n_rays", 1, 1'000'000'000).value_or(10'000);
    }
    return all;
}

std::vector<Choice> RayTask::variants(const BlockReader& block, const Choice& choice) const {
    std::vector<Choice> all;
    for (const std::string& kernel : block.kernels(names_of(ray_kernels()), {"watertight"})) {
        all.push_back(choice);
        all.back().kernel = kernel;
    }
    return all;
}

std::vector<std::string_view> HitTask::keys() const {
    std::vector<std::string_view> all = RayTask::keys();
    all.push_back("ray_order");
    return all;
}

std::unique_ptr<Answers> HitTask::make_answers() const {
    return std::make_unique<AnswerList<RayHit>>();
}

std::vector<NamedCount> HitTask::counters(const Answers& answers, const Work* work) const {
    const auto hits = std::ranges::count_if(list_of<RayHit>(answers), &RayHit::hit);
    std::vector<NamedCount> counts{{"hits", static_cast<std::uint64_t>(hits)}};
    append_work(counts, work, true);
    return counts;
}

std::unique_ptr<Truth> HitTask::make_truth(const Scene& scene, unsigned threads) const {
    return make_hit_truth(scene, query_, threads);
}

std::vector<Choice> HitTask::variants(const BlockReader& block, const Choice& choice) const {
    std::vector<Choice> all;
    for (const Choice& of_kernel : RayTask::variants(block, choice))
        for (const std::string& order :
             block.names("ray_order", names_of(ray_orders()), {"given"})) {
            all.push_back(of_kernel);
            all.back().ray_order = order;
        }
    return all;
}

TreeTask::Way HitTask::way(const Choice& choice) const {
    const RayOrderEntry& order = entry_named(choice.ray_order, ray_orders(), "ray order");
    const KernelInfo& kernel = entry_named(choice.kernel, ray_kernels(), "ray kernel");
    return {order.traversal, choice.kernel,
            kernel.promise,  maker<Hits>(choice.kernel, query_, order.name),
            Query::rays,     ray_class::of_ours(order.classes, choice.kernel)};
}

} // namespace boxwood::bench
