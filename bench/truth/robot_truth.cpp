#include "bench/truth/robot_truth.h"

#include "bench/tasks/detail/robot_in_scene.h"
#include "bench/truth/link_solid.h"
#include "bench/truth/nearest_triangles.h"
#include "kernels/kinematics/kinematic_tree.h"
#include "scenes/robots/robot_scene.h"
#include "trees/executor.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace boxwood::bench {
namespace {

/// The shapes of a robot's links, in any state, and the pairs of links that must not touch.
class RobotLinks {
  public:
    explicit RobotLinks(const RobotStates& of) : of_(of), tree_(of.robot.description) {
        for (const LinkDescription& link : of.robot.description.links) {
            shapes_.emplace_back();
            for (const LinkGeometry& geometry : link.geometries)
                shapes_.back().push_back(link_solid(geometry, of.robot.meshes));
        }
        find_pairs();
    }

    const std::vector<std::vector<LinkSolid>>& shapes() const { return shapes_; } ///< by link
    const std::vector<Pair>& pairs() const { return pairs_; }
    const std::string& name(std::uint32_t link) const {
        return of_.robot.description.links[link].name;
    }
    std::vector<std::vector<PlacedSolid>> in_state(const std::vector<double>& state) const {
        std::vector<RigidTransform<double>> poses(shapes_.size());
        tree_.forward(state, poses);
        std::vector<std::vector<PlacedSolid>> links(shapes_.size());
        for (std::size_t i = 0; i < links.size(); ++i)
            for (const LinkSolid& shape : shapes_[i])
                links[i].emplace_back(shape, poses[i]);
        return links;
    }

  private:
    /// The links with shapes, two and two, but for the allowed ones.
    void find_pairs() {
        std::set<std::pair<std::uint32_t, std::uint32_t>> allowed;
        if (of_.allowed)
            for (const AllowedPair& pair : *of_.allowed)
                allowed.insert(std::minmax(pair.a, pair.b));
        const auto n = static_cast<std::uint32_t>(shapes_.size());
        for (std::uint32_t link = 0; link < n && !of_.allowed; ++link) {
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

    const RobotStates& of_;
    KinematicTree tree_;
    std::vector<std::vector<LinkSolid>> shapes_;
    std::vector<Pair> pairs_;
};

/// What may be said of a state.
struct StateTruth {
    std::optional<Pair> touching; ///< then it must be said
    bool may_touch = false;       ///< else it must not
};

class RobotTruth final : public Truth {
  public:
    RobotTruth(const Scene& scene, unsigned threads)
        : robot_(*scene.robot), links_(robot_), found_(robot_.states.size()) {
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
        check.witness =
            said ? fmt::format("state {}: no two links touch", i)
                 : fmt::format("state {}: {} and {} touch", i, links_.name(truth.touching->a),
                               links_.name(truth.touching->b));
    }

    StateTruth truth_of(const std::vector<double>& state) const {
        const std::vector<std::vector<PlacedSolid>> links = links_.in_state(state);
        StateTruth truth;
        for (const Pair p : links_.pairs())
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
    RobotLinks links_;
    std::vector<StateTruth> found_; ///< by state
};

/// How far apart two sets are: at least lo, at most hi.
struct Interval {
    double lo = std::numeric_limits<double>::infinity(), hi = lo;
};

class RobotDistanceTruth final : public Truth {
  public:
    RobotDistanceTruth(const Scene& scene, unsigned threads)
        : robot_(*scene.robot), links_(robot_), least_(robot_.states.size()),
          size_(robot_.states.size()) {
        for (const std::vector<LinkSolid>& link : links_.shapes()) {
            trees_.emplace_back();
            for (const LinkSolid& shape : link)
                trees_.back().push_back(
                    {NearestTriangles(shape.inner), NearestTriangles(shape.outer)});
        }
        make_executor("tbb", threads)->for_each(least_.size(), [&](std::size_t i) {
            const PlacedLinks links = placed(robot_.states[i]);
            size_[i] = size_of(links);
            least_[i] = least_of(links);
        });
    }

    Judgement judge(const Answers& answers, const ContenderEntry& contender) override {
        Judgement judgement;
        results::Check& check = judgement.check;
        check.oracle = "rational";
        check.max_abs_err = 0;
        const std::vector<StateDistance>& got = list_of<StateDistance>(answers);
        check.n_checked = check.n_expected = least_.size();
        check.n_got = got.size();
        if (got.size() != least_.size()) {
            check.missing = least_.size();
            check.witness = fmt::format("{} answers for {} states", got.size(), least_.size());
        } else {
            for (std::size_t i = 0; i < got.size(); ++i)
                judge_state(i, got[i], contender.promise == Promise::certified, check);
        }
        judgement.conclude(false);
        return judgement;
    }

  private:
    struct Trees {
        NearestTriangles inner, outer;
    };
    /// A shape of a link where it is.
    struct Shape {
        PlacedSolid solid;
        Trees trees;
    };
    using PlacedLinks = std::vector<std::vector<Shape>>; ///< by link

    PlacedLinks placed(const std::vector<double>& state) const {
        const std::vector<std::vector<PlacedSolid>> solids = links_.in_state(state);
        PlacedLinks links(solids.size());
        for (std::size_t i = 0; i < links.size(); ++i)
            for (std::size_t k = 0; k < solids[i].size(); ++k) {
                Shape& shape = links[i].emplace_back(Shape{solids[i][k], trees_[i][k]});
                shape.trees.inner.move(shape.solid.inner);
                shape.trees.outer.move(shape.solid.outer);
            }
        return links;
    }
    static double size_of(const PlacedLinks& links) {
        double size = 0;
        for (const std::vector<Shape>& link : links)
            for (const Shape& shape : link)
                size = std::max(size, bench::size_of(shape.solid.outer));
        return size;
    }

    /// Of all pairs of links; by the gaps of their boxes, the least first.
    Interval least_of(const PlacedLinks& links) const {
        struct Candidate {
            double gap;
            const Shape *a, *b;
        };
        std::vector<Candidate> candidates;
        for (const Pair p : links_.pairs())
            for (const Shape& a : links[p.a])
                for (const Shape& b : links[p.b])
                    candidates.push_back({gap_of(a.solid.box, b.solid.box), &a, &b});
        std::ranges::sort(candidates, {}, &Candidate::gap);
        Interval nearest;
        for (const auto& [gap, a, b] : candidates) {
            if (gap >= nearest.hi)
                break;
            lower(nearest, *a, *b);
        }
        return nearest;
    }
    /// By what two links are apart, if that is less.
    static void lower(Interval& nearest, const std::vector<Shape>& link_a,
                      const std::vector<Shape>& link_b) {
        for (const Shape& a : link_a)
            for (const Shape& b : link_b)
                lower(nearest, a, b);
    }
    static void lower(Interval& nearest, const Shape& a, const Shape& b) {
        if (surely_touch(a.solid, b.solid)) {
            nearest = {0, 0};
            return;
        }
        nearest.hi = std::min(nearest.hi, a.trees.inner.to(b.trees.inner, nearest.hi).distance);
        const double lo =
            may_touch(a.solid, b.solid) ? 0 : a.trees.outer.to(b.trees.outer, nearest.hi).lo;
        nearest.lo = std::min(nearest.lo, lo);
    }

    void judge_state(std::size_t i, const StateDistance& got, bool is_certified,
                     results::Check& check) const {
        const auto complain = [&](std::uint64_t& count, const std::string& what) {
            ++count;
            if (check.witness.empty())
                check.witness = fmt::format("state {}: {}", i, what);
        };
        const auto said = std::ranges::find(links_.pairs(), got.links);
        if (said == links_.pairs().end())
            return complain(check.missing, "no two links are named that must not touch");
        if (!(std::isfinite(got.hi) && got.lo <= got.distance && got.distance <= got.hi))
            return complain(check.missing,
                            fmt::format("{} is no distance between its bounds {} and {}",
                                        got.distance, got.lo, got.hi));
        const Interval truth = least_[i];
        const double slack = (is_certified ? 0x1p-44 : 0x1p-26) * size_[i];
        const PlacedLinks links = placed(robot_.states[i]);
        Interval named;
        lower(named, links[said->a], links[said->b]);
        check.max_abs_err = std::max(
            {check.max_abs_err, got.distance - truth.hi - slack, truth.lo - slack - got.distance});
        const std::string pair =
            fmt::format("{} and {}", links_.name(said->a), links_.name(said->b));
        if (got.distance > truth.hi + slack)
            complain(check.missing, fmt::format("said to be {} apart, and two links are at most {}",
                                                got.distance, truth.hi));
        else if (got.distance < truth.lo - slack)
            complain(check.extra, fmt::format("said to be {} apart, and all links are at least {}",
                                              got.distance, truth.lo));
        else if (got.distance < named.lo - slack || got.distance > named.hi + slack)
            complain(check.extra, fmt::format("{} are said to be {} apart, and are {} to {}", pair,
                                              got.distance, named.lo, named.hi));
        else if (is_certified && (got.lo > truth.hi + slack || got.hi < truth.lo - slack ||
                                  got.hi - got.lo > 0x1p-20 * got.hi + slack)) {
            ++check.bound_violations;
            complain(check.extra, fmt::format("[{}, {}] for a distance of {} to {}", got.lo, got.hi,
                                              truth.lo, truth.hi));
        }
    }

    const RobotStates& robot_;
    RobotLinks links_;
    std::vector<std::vector<Trees>> trees_; ///< by link and shape, in its own frame
    std::vector<Interval> least_;           ///< by state
    std::vector<double> size_;              ///< by state: the greatest |coordinate|
};

} // namespace

std::unique_ptr<Truth> make_robot_truth(const Scene& scene, unsigned threads) {
    return std::make_unique<RobotTruth>(scene, threads);
}
std::unique_ptr<Truth> make_robot_distance_truth(const Scene& scene, unsigned threads) {
    return std::make_unique<RobotDistanceTruth>(scene, threads);
}

} // namespace boxwood::bench
