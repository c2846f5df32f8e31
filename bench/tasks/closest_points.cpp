/// For each point the nearest point of the mesh.

#include "bench/tasks/detail/point_task.h"

#include <xxhash.h>

#include <bit>

namespace boxwood::bench {
namespace {

class NearestOnMesh final : public PointContender {
  public:
    using PointContender::PointContender;

  private:
    bool is_of_mesh() const override { return true; }
    void run(Answers& answers, const Executor& executor, Work* work) override {
        std::vector<SurfacePoint>& nearest = list_of<SurfacePoint>(answers);
        nearest.resize(scene_.points.size());
        if (calls_ == Calls::batch)
            return layout_->closest_points(scene_.points, scene_.mesh, executor, nearest, work);
        one_by_one(scene_.points.size(), executor, [&](std::size_t, std::size_t i) {
            layout_->closest_points(std::span(scene_.points).subspan(i, 1), scene_.mesh, serial(),
                                    std::span(nearest).subspan(i, 1), work);
        });
    }
};

class ClosestPoints final : public PointTask {
  public:
    ClosestPoints() : PointTask(PointQuery::surface_point) {}
    std::string_view name() const override { return "closest_points"; }
    std::string title() const override { return "nearest surface point"; }
    std::string_view summary() const override {
        return "for each point the nearest point of the mesh";
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<SurfacePoint>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<std::uint64_t> words;
        for (const SurfacePoint& near : list_of<SurfacePoint>(answers)) {
            words.push_back(near.triangle);
            words.push_back(std::bit_cast<std::uint64_t>(near.squared_distance));
            for (int axis = 0; axis < 3; ++axis)
                words.push_back(std::bit_cast<std::uint32_t>(near.point[axis]));
        }
        return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work* work) const override {
        std::vector<NamedCount> counts{{"hits", answers.size()}};
        append_work(counts, work, true);
        return counts;
    }

  protected:
    std::string_view mesh_is_for() const override { return "test"; }
    Way way(const Choice& choice) const override {
        return way_of<NearestOnMesh>(choice, "closest_points", "single_closest_points",
                                     Query::closest_points);
    }
};

} // namespace

const Task& closest_points_task() {
    static const ClosestPoints task;
    return task;
}

} // namespace boxwood::bench
