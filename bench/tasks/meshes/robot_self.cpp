/// In which states a robot collides with itself.

#include "bench/plan/block_reader.h"
#include "bench/tasks/detail/robot_in_scene.h"
#include "bench/tasks/detail/tree_task.h"
#include "bench/truth/robot_truth.h"
#include "scenes/robots/robot_scene.h"
#include "trees/world/robot_collision.h"
#include "trees/world/robot_meshes.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <optional>
#include <stdexcept>

namespace boxwood::bench {
namespace {

class SelfCollisions final : public Contender {
  public:
    explicit SelfCollisions(const Job& job) : robot_(*job.scene) {}

    void build() override {
        self_.reset();
        meshes_.reset();
        meshes_.emplace(robot_.robot, robot_.meshes());
        self_.emplace(robot_.robot, robot_.boxes, robot_.allowed, *meshes_);
    }
    void query(Answers& answers) override {
        std::vector<std::uint8_t>& collides = list_of<std::uint8_t>(answers);
        collides.clear();
        for (const std::vector<double>& state : robot_.states())
            collides.push_back(self_->collides(state));
    }

  private:
    RobotInScene robot_;
    std::optional<RobotMeshes> meshes_;
    std::optional<RobotSelfCollision> self_;
};

class RobotSelf final : public Task {
  public:
    std::string_view name() const override { return "robot_self"; }
    std::string title() const override { return "self-collision of a robot"; }
    std::string_view summary() const override {
        return "in which states of a robot two links touch that must not, at the first such "
               "pair";
    }
    std::vector<std::string_view> keys() const override {
        return {"scene", "states", "n_states", "threads", "peers"};
    }
    SceneKind scenes() const override { return SceneKind::still; }
    void expand(const BlockReader& block, AddCell add) const override {
        block.names("scene", {robot_scene});
        const std::vector<ContenderEntry> peers = block.peers(name());
        const std::vector<std::string> kinds =
            block.names("states", {random_states, states_along}, {std::string(random_states)});
        for (const OwnScene& own : block.inputs().own) {
            if (own.generator != robot_scene)
                continue;
            SceneSpec spec;
            spec.generator = own.generator;
            spec.file = own.file;
            spec.n = own.items;
            spec.seed = block.inputs().seed;
            spec.n_poses = block.integer("n_states", 1, 1'000'000).value_or(256);
            for (const std::string& kind : kinds) {
                spec.poses = kind == random_states ? "" : kind;
                add_cells(block, spec, {contender({})}, peers, add);
            }
        }
    }
    ContenderEntry contender(const Choice& choice) const override {
        if (choice.builder != Choice{}.builder || !choice.settings.empty())
            throw std::invalid_argument(
                fmt::format("robot_self: the trees of a robot's links are built by {}, not by {}",
                            Choice{}.builder, choice.builder));
        ContenderEntry entry = entry_of_ours(builder_of(choice), choice);
        entry.precision = "f64";
        entry.layout = "obb";
        entry.traversal = name();
        entry.promise = Promise::certified;
        entry.name = fmt::format("{}.{}.{}", entry.builder, entry.layout, entry.traversal);
        entry.summary = "boxes of the links, then their meshes' trees and solids";
        entry.notes =
            "build: a tree of each mesh; query: state after state, forward kinematics, "
            "boxes of the links, and of pairs that must not touch those whose boxes "
            "overlap, until two touch, that which touched last first; exact for two meshes, "
            "certified for solids";
        entry.runs_on = RunsOn::one_thread;
        entry.answers = {{std::string(name()),
                          [](const Job& job) { return std::make_unique<SelfCollisions>(job); }}};
        return entry;
    }
    std::optional<std::string> missing(const Scene& scene) const override {
        if (!scene.robot)
            return "the scene has no robot; --robot FILE.urdf brings one";
        return std::nullopt;
    }
    std::uint64_t n_queries(const Scene& scene) const override {
        return scene.robot ? scene.robot->states.size() : 0;
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
};

} // namespace

const Task& robot_self_task() {
    static const RobotSelf task;
    return task;
}

} // namespace boxwood::bench
