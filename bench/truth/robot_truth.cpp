#include "bench/truth/robot_truth.h"

#include "bench/truth/link_solid.h"
#include "kernels/kinematics/kinematic_tree.h"
#include "scenes/robots/robot_scene.h"
#include "trees/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

/// What may be said of a state.
struct StateTruth {
    std::optional<Pair> touching; ///< then it must be said
    bool may_touch = false;       ///< else it must not
};

class RobotTruth final : public Truth {
  public:
    RobotTruth(const Scene& scene, unsigned threads)
        : robot_(*scene.robot), tree_(robot_.robot.description), found_(robot_.states.size()) {
        for (const LinkDescription& link : robot_.robot.description.links) {
            shapes_.emplace_back();
            for (const LinkGeometry& geometry : link.geometries)
                shapes_.back().push_back(link_solid(geometry, robot_.robot.meshes));
        }
        find_pairs();
        make_executor("tbb", threads)->for_each(found_.size(), [&](std::size_t i) {
            found_[i] = truth_of(robot_.states[i]);
        });
    }

    Judgement judge(const Answers& answers, const ContenderEntry&) override {
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = "rational";
        const std::vector<std::uint8_t>& got = list_of<std::uint8_t>(answers);
        check.n_checked = check.n_expected = found_.size();
        check.n_got = got.size();
        if (got.size() != found_.size()) {
            check.missing = found_.size();
            check.witness = fmt::format("{} answers for {} states", got.size(), found_.size());
        } else {
            for (std::size_t i = 0; i < got.size(); ++i)
                judge_state(i, got[i] != 0, check);
        }
        judgement.conclude(true);
        return judgement;
    }

  private:
    void judge_state(std::size_t i, bool said, results::Check& check) const {
        const StateTruth& truth = found_[i];
        if (said ? truth.may_touch : !truth.touching)
            return;
        ++(said ? check.extra : check.missing);
        if (!check.witness.empty())
            return;
        const auto name = [&](std::uint32_t link) {
            return robot_.robot.description.links[link].name;
        };
        check.witness = said ? fmt::format("state {}: no two links touch", i)
                             : fmt::format("state {}: {} and {} touch", i, name(truth.touching->a),
                                           name(truth.touching->b));
    }

    /// The links with shapes, two and two, but for the allowed ones.
    void find_pairs() {
        std::set<std::pair<std::uint32_t, std::uint32_t>> allowed;
        if (robot_.allowed)
            for (const AllowedPair& pair : *robot_.allowed)
                allowed.insert(std::minmax(pair.a, pair.b));
        const auto n = static_cast<std::uint32_t>(shapes_.size());
        for (std::uint32_t link = 0; link < n && !robot_.allowed; ++link) {
            std::uint32_t above = link; // the next one that has a shape
            do
                above = tree_.parents()[above];
            while (shapes_[above].empty() && above != tree_.parents()[above]);
            if (above != link)
                allowed.insert(std::minmax(link, above));
        }
        for (std::uint32_t a = 0; a < n; ++a)
            for (std::uint32_t b = a + 1; b < n; ++b)
                if (!shapes_[a].empty() && !shapes_[b].empty() && !allowed.contains({a, b}))
                    pairs_.push_back({a, b});
    }

    StateTruth truth_of(const std::vector<double>& state) const {
        std::vector<RigidTransform<double>> poses(shapes_.size());
        tree_.forward(state, poses);
        std::vector<std::vector<PlacedSolid>> links(shapes_.size());
        for (std::size_t i = 0; i < links.size(); ++i)
            for (const LinkSolid& shape : shapes_[i])
                links[i].emplace_back(shape, poses[i]);
        StateTruth truth;
        for (const Pair p : pairs_)
            for (const PlacedSolid& a : links[p.a])
                for (const PlacedSolid& b : links[p.b]) {
                    if (!overlaps(a.box, b.box))
                        continue;
                    if (surely_touch(a, b))
                        return {p, true};
                    truth.may_touch = truth.may_touch || may_touch(a, b);
                }
        return truth;
    }

    const RobotStates& robot_;
    KinematicTree tree_;
    std::vector<std::vector<LinkSolid>> shapes_; ///< by link
    std::vector<Pair> pairs_;                    ///< that must not touch
    std::vector<StateTruth> found_;              ///< by state
};

} // namespace

std::unique_ptr<Truth> make_robot_truth(const Scene& scene, unsigned threads) {
    return std::make_unique<RobotTruth>(scene, threads);
}

} // namespace boxwood::bench
