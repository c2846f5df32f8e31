#include "bench/tasks/detail/point_task.h"

namespace boxwood::bench {

std::vector<std::string_view> PointTask::keys() const {
    std::vector<std::string_view> all = TreeTask::keys();
    all.push_back("n_points");
    return all;
}

std::optional<std::string> PointTask::missing(const Scene& scene) const {
    if (auto why = TreeTask::missing(scene))
        return why;
    if (n_queries(scene) > 0)
        return std::nullopt;
    return query_ == PointQuery::overlapping ? "the scene has no regions"
                                             : "the scene has no points";
}

std::uint64_t PointTask::n_queries(const Scene& scene) const {
    return query_ == PointQuery::overlapping ? scene.regions.size() + scene.spheres.size()
                                             : scene.points.size();
}

std::vector<SceneSpec> PointTask::with_queries(const BlockReader& block,
                                               const SceneSpec& scene) const {
    SceneSpec spec = scene;
    spec.n_points = block.integer("n_points", 1, 1'000'000'000).value_or(10'000);
    return {spec};
}

} // namespace boxwood::bench
