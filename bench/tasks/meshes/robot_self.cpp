/// In which states a robot collides with itself.

#include "bench/tasks/detail/robot_task.h"
#include "bench/truth/robot_truth.h"

#include <xxhash.h>

namespace boxwood::bench {
namespace {

class SelfCollisions final : public RobotContender {
  public:
    using RobotContender::RobotContender;

    void query(Answers& answers) override {
        std::vector<std::uint8_t>& collides = list_of<std::uint8_t>(answers);
        collides.clear();
        for (const std::vector<double>& state : robot_.states())
            collides.push_back(self_->collides(state));
    }
};

class RobotSelf final : public RobotTask {
  public:
    std::string_view name() const override { return "robot_self"; }
    std::string title() const override { return "self-collision of a robot"; }
    std::string_view summary() const override {
        return "in which states of a robot two links touch that must not, at the first such "
               "pair";
    }
    std::unique_ptr<Answers> make_answers() const override {
        return std::make_unique<AnswerList<std::uint8_t>>();
    }
    std::uint64_t hash(const Answers& answers) const override {
        const std::vector<std::uint8_t>& collides = list_of<std::uint8_t>(answers);
        return XXH3_64bits(collides.data(), collides.size());
    }
    std::unique_ptr<Truth> make_truth(const Scene& scene, unsigned threads) const override {
        return make_robot_truth(scene, threads);
    }
    std::vector<NamedCount> counters(const Answers& answers, const Work*) const override {
        std::uint64_t yes = 0;
        for (const std::uint8_t one : list_of<std::uint8_t>(answers))
            yes += one;
        return {{"hits", yes}};
    }

  protected:
    std::string_view query_notes() const override {
        return "boxes of the links, and of pairs that must not touch those whose boxes overlap, "
               "until two touch, that which touched last first";
    }
    Answering::Make make() const override {
        return [](const Job& job) { return std::make_unique<SelfCollisions>(job); };
    }
};

} // namespace

const Task& robot_self_task() {
    static const RobotSelf task;
    return task;
}

} // namespace boxwood::bench
