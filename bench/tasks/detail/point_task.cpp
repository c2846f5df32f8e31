#include "bench/tasks/detail/point_task.h"

namespace boxwood::bench {
namespace {

constexpr const char* single_call = "single";

/// The pairs of one query, the only one of its call.
class PairsOfOne final : public PairSink {
  public:
    PairsOfOne(std::vector<Pair>& to, std::size_t query)
        : to_(to), query_(static_cast<std::uint32_t>(query)) {}

    void begin(std::size_t, bool) override {}
    bool take(std::size_t, std::span<const Pair> pairs) override {
        for (const Pair pair : pairs)
            to_.push_back({query_, pair.b});
        return true;
    }
    void end() override {}

  private:
    std::vector<Pair>& to_;
    std::uint32_t query_;
};

} // namespace

void PointPairsContender::run(Answers& answers, const Executor& executor, Work* work) {
    if (calls_ == Calls::batch)
        return find(0, n_queries(), executor, pairs_.to(answers), work);
    parts_.resize(chunks_of(n_queries(), executor));
    for (std::vector<Pair>& part : parts_)
        part.clear();
    one_by_one(n_queries(), executor, [&](std::size_t chunk, std::size_t i) {
        PairsOfOne sink(parts_[chunk], i);
        find(i, 1, serial(), sink, work);
    });
    std::vector<Pair>& pairs = list_of<Pair>(answers);
    pairs.clear();
    for (const std::vector<Pair>& part : parts_)
        pairs.insert(pairs.end(), part.begin(), part.end());
}

std::vector<std::string_view> PointTask::keys() const {
    std::vector<std::string_view> all = TreeTask::keys();
    all.insert(all.end(), {"n_points", "calls"});
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

std::vector<Choice> PointTask::variants(const BlockReader& block, const Choice& choice) const {
    std::vector<Choice> all;
    for (const std::string& calls : block.names("calls", {"batch", single_call}, {"batch"})) {
        all.push_back(choice);
        if (calls == single_call)
            all.back().ray_order = single_call;
    }
    return all;
}

Calls PointTask::calls_of(const Choice& choice) {
    return choice.ray_order == single_call ? Calls::single : Calls::batch;
}

} // namespace boxwood::bench
