/// For each ray the nearest triangle.

#include "bench/tasks/detail/ray_task.h"

#include <xxhash.h>

#include <bit>

namespace boxwood::bench {
namespace {

class RaysClosest final : public HitTask {
  public:
    RaysClosest() : HitTask(RayQuery::closest) {}
    std::string_view name() const override { return "rays_closest"; }
    std::string title() const override { return "nearest hit"; }
    std::string_view summary() const override { return "for each ray the nearest triangle"; }
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<std::uint32_t> words;
        words.reserve(2 * answers.size());
        for (const RayHit& hit : list_of<RayHit>(answers)) {
            words.push_back(hit.triangle);
            words.push_back(hit.hit() ? std::bit_cast<std::uint32_t>(hit.t) : 0);
        }
        return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
    }
};

} // namespace

const Task& rays_closest_task() {
    static const RaysClosest task;
    return task;
}

} // namespace boxwood::bench
