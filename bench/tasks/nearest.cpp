/// For each point the nearest boxes. The key k says how many.

#include "bench/tasks/detail/device_contender.h"
#include "bench/tasks/detail/point_task.h"

#include <xxhash.h>

#include <bit>

namespace boxwood::bench {
namespace {

class NearestBoxes final : public PointContender {
  public:
    using PointContender::PointContender;

  private:
    void run(Answers& answers, const Executor& executor, Work* work) override {
        std::vector<Neighbour>& neighbours = list_of<Neighbour>(answers);
        neighbours.resize(k_ * scene_.points.size());
        if (calls_ == Calls::batch)
            return layout_->nearest(scene_.points, k_, executor, neighbours, work);
        one_by_one(scene_.points.size(), executor, [&](std::size_t, std::size_t i) {
            layout_->nearest(std::span(scene_.points).subspan(i, 1), k_, serial(),
                             std::span(neighbours).subspan(i * k_, k_), work);
        });
    }
    std::size_t k_ = neighbours_of(scene_);
};

class NearestOnDevice final : public DeviceBoxes {
  public:
    using DeviceBoxes::DeviceBoxes;

  protected:
    std::uint64_t upload_queries() override {
        points_ = DeviceArray<Vec3<float>>(scene_.points, options_.place);
        return points_.size_bytes();
    }
    void query_there() override { found_ = bvh_->nearest(std::as_const(points_).span(), k_); }
    std::uint64_t download(Answers& answers) override {
        found_.read(list_of<Neighbour>(answers));
        return found_.size_bytes();
    }

  private:
    std::size_t k_ = neighbours_of(scene_);
    DeviceArray<Vec3<float>> points_;
    DeviceArray<Neighbour> found_;
};

class Nearest final : public PointTask {
  public:
    Nearest() : PointTask(PointQuery::nearest) {}
    std::string_view name() const override { return "nearest"; }
    std::string title() const override { return "nearest boxes"; }
    std::string_view summary() const override { return "for each point the nearest boxes"; }
    std::vector<std::string_view> keys() const override {
        std::vector<std::string_view> all = PointTask::keys();
        all.push_back("k");
        return all;
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<Neighbour>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<std::uint64_t> words;
        for (const Neighbour& near : list_of<Neighbour>(answers)) {
            words.push_back(near.item);
            words.push_back(std::bit_cast<std::uint64_t>(near.squared_distance));
        }
        return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::vector<NamedCount> counts{{"hits", answers.size()}};
        append_work(counts, work);
        return counts;
    }

  protected:
    std::vector<SceneSpec> with_queries(const BlockReader& block,
                                        const SceneSpec& scene) const override {
        const SceneSpec spec = PointTask::with_queries(block, scene).front();
        std::vector<SceneSpec> all;
        for (const std::int64_t k : block.integers("k", 1, 1000)) {
            all.push_back(spec);
            all.back().k = static_cast<int>(k);
        }
        return all.empty() ? std::vector{spec} : all;
    }
    Way way(const Choice& choice) const override {
        Way way = way_of<NearestBoxes>(choice, "nearest", "single_nearest", Query::nearest);
        if (calls_of(choice) == Calls::batch && choice.builder != "hilbert") // DeviceBvh::nearest
            way.make_on_device = on_device<NearestOnDevice>(choice);
        return way;
    }
};

} // namespace

const Task& nearest_task() {
    static const Nearest task;
    return task;
}

} // namespace boxwood::bench
