/// How far apart the two nearest links of a robot are, state after state.

#include "bench/tasks/detail/robot_task.h"
#include "bench/truth/robot_truth.h"

#include <xxhash.h>

#include <bit>

namespace boxwood::bench {
namespace {

class LeastLinkDistances final : public RobotContender {
  public:
    using RobotContender::RobotContender;

    void query(Answers& answers) override {
        std::vector<StateDistance>& distances = list_of<StateDistance>(answers);
        distances.clear();
        for (const std::vector<double>& state : robot_.states()) {
            const SelfCollision& found = self_->check(state);
            StateDistance& answer = distances.emplace_back();
            if (found.nearest)
                answer = {found.least.distance, found.least.lo, found.least.hi, *found.nearest};
        }
    }
};

class RobotDistance final : public RobotTask {
  public:
    std::string_view name() const override { return "robot_distance"; }
    std::string title() const override { return "least distance of a robot's links"; }
    std::string_view summary() const override {
        return "how far apart the two nearest links of a robot are that must not touch, state "
               "after state";
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<StateDistance>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        std::vector<std::uint64_t> words;
        for (const StateDistance& d : list_of<StateDistance>(answers))
            words.push_back(std::bit_cast<std::uint64_t>(d.distance));
        return XXH3_64bits(words.data(), words.size() * sizeof(words[0]));
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_robot_distance_truth(scene, threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work*) const override {
        return {{"answers", answers.size()}};
    }

  protected:
    std::string_view query_notes() const override {
        return "boxes of the links, every pair that must not touch and whose boxes overlap by a "
               "yes or no, and of all such pairs the least distance, the nearest boxes first";
    }
    Answering::Make make() const override {
        return [](const Job& job) { return std::make_unique<LeastLinkDistances>(job); };
    }
};

} // namespace

const Task& robot_distance_task() {
    static const RobotDistance task;
    return task;
}

} // namespace boxwood::bench
