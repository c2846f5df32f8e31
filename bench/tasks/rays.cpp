#include "bench/tasks/rays.h"

#include "bench/tasks/tree_contender.h"
#include "trees/queries/single_rays.h"
#include "trees/queries/sorted_rays.h"

#include <algorithm>
#include <array>
#include <optional>

namespace boxwood::bench {
namespace {

/// Pairs (ray, triangle) of the hits, each chunk by itself: the chunks in order at the end.
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

class Rays final : public TreeContender {
  public:
    Rays(const Job& job, BuildFunction build, const LayoutEntry& layout, std::string kernel,
         std::string_view order)
        : TreeContender(job, std::move(build), layout), kernel_(std::move(kernel)), order_(order) {}

    void build() override {
        single_.reset();
        triangles_ = {};
        if (build_.build_of_mesh) {
            layout_.reset();
            tree_ = build_.build_of_mesh(scene_.mesh, *executor_);
            layout_ = layout_entry_.make(tree_, *executor_);
        } else {
            TreeContender::build();
        }
        triangles_ = layout_->triangles(scene_.mesh, *executor_);
        if (order_ == "single")
            single_.emplace(*layout_, kernel_, triangles_);
    }

    void query(Answers& answers) override {
        if (ask_ == Ask::rays_all) {
            answers.pairs.clear();
            layout_->rays_all(scene_.rays, kernel_, triangles_, *executor_, sink_);
            return sink_.append_to(answers.pairs);
        }
        answers.hits.resize(scene_.rays.size());
        if (single_)
            one_by_one(answers.hits);
        else if (order_ == "sorted")
            sorted_rays(*layout_, scene_.rays, wanted(), kernel_, triangles_, *executor_,
                        answers.hits);
        else
            layout_->rays(scene_.rays, wanted(), kernel_, triangles_, *executor_, answers.hits);
    }

    /// The order in which rays are walked changes no count; all hits are not counted.
    std::optional<Work> counted_query(Answers& answers) override {
        if (ask_ == Ask::rays_all)
            return std::nullopt;
        answers.hits.resize(scene_.rays.size());
        return layout_->rays_counted(scene_.rays, wanted(), kernel_, triangles_, answers.hits);
    }

    std::optional<StructureInfo> structure() const override {
        return StructureInfo{layout_->bytes() + triangles_.bytes(), &tree_};
    }

  private:
    /// Embree's share of rays per task; its any-hits do not say which triangle it was.
    void one_by_one(std::vector<RayHit>& hits) const {
        constexpr std::size_t chunk = 256;
        executor_->for_each((hits.size() + chunk - 1) / chunk, [&](std::size_t c) {
            const std::size_t end = std::min(hits.size(), (c + 1) * chunk);
            for (std::size_t i = c * chunk; i < end; ++i)
                if (ask_ == Ask::rays_closest) {
                    hits[i] = single_->closest(scene_.rays[i]);
                } else {
                    hits[i] = {};
                    if (single_->any(scene_.rays[i]))
                        hits[i].triangle = 0;
                }
        });
    }
    RayQuery wanted() const {
        return ask_ == Ask::rays_closest ? RayQuery::closest : RayQuery::any;
    }

    std::string kernel_;
    std::string_view order_;
    TriangleBlocks triangles_;
    std::optional<SingleRays> single_; ///< of the order "single"
    HitPairs sink_;
};

constexpr std::array orders{
    RayOrderEntry{"given", "a batch as it comes, some of its rays on their way at a time", "rays"},
    RayOrderEntry{"sorted", "a batch by direction and place, answers put back", "sorted_rays"},
    RayOrderEntry{"single", "one ray in a call, answered before the next", "single_rays"}};

} // namespace

std::unique_ptr<Contender> make_rays(const Job& job, BuildFunction build, const LayoutEntry& layout,
                                     const std::string& kernel, const RayOrderEntry& order) {
    return std::make_unique<Rays>(job, std::move(build), layout, kernel,
                                  has_ray_order(job.task) ? order.name : "given");
}

std::span<const RayOrderEntry> ray_orders() { return orders; }

} // namespace boxwood::bench
