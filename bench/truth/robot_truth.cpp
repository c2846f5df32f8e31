#include "bench/truth/robot_truth.h"

#include "bench/truth/link_solid.h"
#include "kernels/kinematics/kinematic_tree.h"
#include "kernels/oracle/oracle.h"
#include "kernels/primitives/rotation.h"
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

/// A shape where its link is.
struct PlacedSolid {
    const LinkSolid* solid;
    RigidTransform<double> pose;
    PosedTriangles inner, outer;
    Aabb<double> box; ///< of `outer`

    Vec3<double> in_own_frame(Vec3<double> p) const {
        const auto& [r0, r1, r2] = pose.rotation;
        const Vec3<double> apart = p - pose.translation;
        return apart.x * r0 + apart.y * r1 + apart.z * r2;
    }
};

PosedTriangles placed(const PosedTriangles& triangles, const RigidTransform<double>& pose) {
    PosedTriangles all;
    all.reserve(triangles.size());
    for (const Triangle<double>& t : triangles)
        all.push_back({pose(t.a), pose(t.b), pose(t.c)});
    return all;
}

PlacedSolid placed(const LinkSolid& solid, const RigidTransform<double>& link) {
    const RigidTransform<double> pose = compose(link, solid.origin);
    PlacedSolid at{&solid, pose, placed(solid.inner, pose), placed(solid.outer, pose), {}};
    for (const Triangle<double>& t : at.outer)
        at.box.extend(t.bounds());
    return at;
}

bool surfaces_touch(const PosedTriangles& a, const PosedTriangles& b, const Aabb<double>& box_b) {
    for (const Triangle<double>& s : a) {
        if (!overlaps(s.bounds(), box_b))
            continue;
        for (const Triangle<double>& t : b)
            if (overlaps(s.bounds(), t.bounds()) && oracle::intersect(s, t))
                return true;
    }
    return false;
}

template <class Contains> bool any_corner(const PosedTriangles& triangles, Contains contains) {
    return std::ranges::any_of(triangles, [&](const Triangle<double>& t) {
        return contains(t.a) || contains(t.b) || contains(t.c);
    });
}

bool surely_touch(const PlacedSolid& a, const PlacedSolid& b) {
    const auto within = [](const PlacedSolid& solid) {
        return [&solid](Vec3<double> p) { return solid.solid->contains(solid.in_own_frame(p)); };
    };
    return surfaces_touch(a.inner, b.inner, b.box) || any_corner(b.inner, within(a)) ||
           any_corner(a.inner, within(b));
}

/// No less than all that do.
bool may_touch(const PlacedSolid& a, const PlacedSolid& b) {
    const auto within = [](const PlacedSolid& solid) {
        return [&solid](Vec3<double> p) { return solid.solid->may_contain(solid.in_own_frame(p)); };
    };
    return surfaces_touch(a.outer, b.outer, b.box) || any_corner(b.outer, within(a)) ||
           any_corner(a.outer, within(b));
}

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
                links[i].push_back(placed(shape, poses[i]));
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
