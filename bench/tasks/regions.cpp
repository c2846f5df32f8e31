/// For each box or sphere every box that it meets, as pairs (region, box). The key regions names
/// which: boxes or spheres.

#include "bench/tasks/detail/device_contender.h"
#include "bench/tasks/detail/pair_answers.h"
#include "bench/tasks/detail/point_task.h"
#include "kernels/suggest.h"
#include "scenes/sampling/queries.h"

namespace boxwood::bench {
namespace {

class Overlapping final : public PointPairsContender {
  public:
    using PointPairsContender::PointPairsContender;

  private:
    std::size_t n_queries() const override {
        return scene_.spheres.empty() ? scene_.regions.size() : scene_.spheres.size();
    }
    void find(std::size_t first, std::size_t n, const Executor& executor, PairSink& sink,
              Work* work) const override {
        if (scene_.spheres.empty())
            layout_->regions(std::span(scene_.regions).subspan(first, n), executor, sink, work);
        else
            layout_->regions(std::span(scene_.spheres).subspan(first, n), executor, sink, work);
    }
};

class OverlappingOnDevice final : public ItemsOfQueries {
  public:
    using ItemsOfQueries::ItemsOfQueries;

  protected:
    std::uint64_t upload_queries() override {
        regions_ = DeviceArray<Box>(scene_.regions, options_.place);
        spheres_ = DeviceArray<Sphere<float>>(scene_.spheres, options_.place);
        return regions_.size_bytes() + spheres_.size_bytes();
    }
    void query_there() override {
        found_ = scene_.spheres.empty() ? bvh_->overlapping(std::as_const(regions_).span())
                                        : bvh_->overlapping(std::as_const(spheres_).span());
    }

  private:
    DeviceArray<Box> regions_;
    DeviceArray<Sphere<float>> spheres_;
};

class Regions final : public PairAnswers<PointTask> {
  public:
    Regions() : PairAnswers(PointQuery::overlapping) {}
    std::string_view name() const override { return "regions"; }
    std::string title() const override { return "boxes in a region"; }
    std::string_view summary() const override {
        return "for each box or sphere every box that it meets";
    }
    std::vector<std::string_view> keys() const override {
        std::vector<std::string_view> all = PointTask::keys();
        all.push_back("regions");
        return all;
    }

  protected:
    std::vector<SceneSpec> with_queries(const BlockReader& block,
                                        const SceneSpec& scene) const override {
        std::vector<SceneSpec> all;
        for (const std::string& kind :
             block.names("regions", names_of(region_kinds()), {"boxes"})) {
            all.push_back(PointTask::with_queries(block, scene).front());
            all.back().regions = kind;
        }
        return all;
    }
    Way way(const Choice& choice) const override {
        Way way = way_of<Overlapping>(choice, "regions", "single_regions", Query::regions);
        if (calls_of(choice) == Calls::batch)
            way.make_on_device = on_device<OverlappingOnDevice>(choice);
        return way;
    }
};

} // namespace

const Task& regions_task() {
    static const Regions task;
    return task;
}

} // namespace boxwood::bench
