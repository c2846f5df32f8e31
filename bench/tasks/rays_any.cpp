/// For each ray whether it meets a triangle.

#include "bench/tasks/detail/ray_task.h"

#include <xxhash.h>

namespace boxwood::bench {
namespace {

class RaysAny final : public HitTask {
  public:
    RaysAny() : HitTask(RayQuery::any) {}
    std::string_view name() const override { return "rays_any"; }
    std::string title() const override { return "any hit"; }
    std::string_view summary() const override { return "for each ray whether it meets a triangle"; }
    /// Which triangle it was does not count.
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<std::uint32_t> words;
        words.reserve(answers.size());
        for (const RayHit& hit : list_of<RayHit>(answers))
            words.push_back(hit.hit());
        return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
    }
};

} // namespace

const Task& rays_any_task() {
    static const RaysAny task;
    return task;
}

} // namespace boxwood::bench
