/// `boxwood demo robot`: the lesson of the four-link robot on one of the user's own.

#include "bench/commands/demos/demo.h"
#include "bench/commands/demos/watched_traversal.h"
#include "kernels/arithmetic/rounding.h"
#include "scenes/robots/random_values.h"
#include "trees/builder.h"
#include "trees/inspect/draw.h"
#include "trees/layout.h"
#include "trees/world/propose_pairs.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace boxwood::bench {
namespace {

constexpr std::size_t shown_tests = 24, shown_joints = 12;

/// A robot in one state after another; items are the links with geometry.
class Lesson {
  public:
    Lesson(const RobotCase& robot, const AllowedPairs& allowed, const LinkNarrowPhase& narrow_phase)
        : robot_(robot), allowed_(allowed), self_(robot.robot, robot.boxes, allowed, narrow_phase),
          narrow_phase_(narrow_phase),
          links_(robot.boxes.links().begin(), robot.boxes.links().end()), matrix_(links_.size()) {
        for (std::uint32_t i = 0; i < links_.size(); ++i) {
            names_.push_back(robot.robot.links()[links_[i]].name);
            for (std::uint32_t j = 0; j < i; ++j)
                if (allowed.allows(links_[i], links_[j]))
                    matrix_.allow(i, j);
        }
    }

    void set(std::span<const double> values) {
        found_ = &self_.check(values);
        boxes_.clear();
        for (const std::uint32_t link : links_)
            boxes_.push_back(round_outward(self_.boxes()[link]));
    }

    std::size_t n() const { return links_.size(); }
    std::size_t all_pairs() const { return n() * (n() - 1) / 2; }
    const std::vector<std::string>& names() const { return names_; }
    const std::vector<Box>& boxes() const { return boxes_; }
    const AllowedCollisions& matrix() const { return matrix_; }

    std::string box_lines() const {
        std::size_t width = 0;
        for (const std::string& name : names_)
            width = std::max(width, name.size());
        std::string text;
        for (std::size_t i = 0; i < n(); ++i) {
            const Box& box = boxes_[i];
            text += fmt::format("     {:<{}} x [{:6.3f}, {:6.3f}]  y [{:6.3f}, {:6.3f}]  "
                                "z [{:6.3f}, {:6.3f}]\n",
                                names_[i], width, box.min.x, box.max.x, box.min.y, box.max.y,
                                box.min.z, box.max.z);
        }
        return text;
    }

    /// By reason, "8 adjacent, 12 never".
    std::string allowed_text() const {
        std::map<std::string_view, std::size_t> reasons;
        for (const AllowedPair& pair : allowed_.pairs())
            ++reasons[name_of(pair.reason)];
        std::string text;
        for (const auto& [reason, count] : reasons)
            text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, reason);
        return text.empty() ? "none" : text;
    }

    /// What the narrow phase says of the pairs that are left.
    std::string narrow_text(std::span<const Pair> left) const {
        std::string text;
        for (const Pair p : left) {
            const std::uint32_t a = links_[p.a], b = links_[p.b];
            const bool touch =
                std::ranges::find(found_->colliding, Pair{a, b}) != found_->colliding.end();
            text += fmt::format("     {} and {}: boxes overlap; ", names_[p.a], names_[p.b]);
            if (touch) {
                text += "the links TOUCH\n";
            } else {
                const LinkDistance d = narrow_phase_.distance(
                    a, b, self_.poses(), std::numeric_limits<double>::infinity());
                text += fmt::format("the links are {:.4f} apart\n", d.distance);
            }
        }
        if (found_->nearest)
            text += fmt::format("   Of all pairs that are not allowed the nearest: {} and {}, "
                                "{:.6f} apart\n   (certain: between {} and {}).\n",
                                robot_.robot.links()[found_->nearest->a].name,
                                robot_.robot.links()[found_->nearest->b].name,
                                found_->least.distance, found_->least.lo, found_->least.hi);
        return text;
    }

    bool any_collide() const { return !found_->colliding.empty(); }

  private:
    const RobotCase& robot_;
    const AllowedPairs& allowed_;
    RobotSelfCollision self_;
    const LinkNarrowPhase& narrow_phase_;
    std::vector<std::uint32_t> links_;
    std::vector<std::string> names_;
    AllowedCollisions matrix_;
    std::vector<Box> boxes_;
    const SelfCollision* found_ = nullptr;
};

std::string joints_text(const Robot& robot, std::span<const double> values) {
    std::string text;
    for (std::size_t k = 0; k < std::min(values.size(), shown_joints); ++k)
        text += fmt::format("{}{}={:.3f}", k ? ", " : "", robot.value_name(k), values[k]);
    if (values.size() > shown_joints)
        text += fmt::format(" and {} more", values.size() - shown_joints);
    return text;
}

/// A random state that collides, as there is more to see; else the first one.
std::uint64_t state_to_show(const Robot& robot, RobotSelfCollision& self, std::uint64_t seed,
                            std::span<double> values) {
    constexpr std::uint64_t tries = 1000;
    for (std::uint64_t i = 0; i < tries; ++i) {
        random_values(robot.ranges(), seed, i, values);
        if (self.collides(values))
            return i;
    }
    random_values(robot.ranges(), seed, 0, values);
    return 0;
}

/// The steps that both states share: traversal, allowed pairs, narrow phase.
std::string pairs_text(const Lesson& lesson, const Tree& tree) {
    const WatchedTraversal traversal = watched_traversal(tree, lesson.names());
    const std::vector<Pair> left = reported_pairs(tree, lesson.matrix());
    return fmt::format("{}\n   Box tests: {} instead of {}. Pairs that overlap: {}; of them "
                       "allowed: {}; left: {}:\n"
                       "   {}.\n\n{}",
                       traversal.text(shown_tests), traversal.lines.size(), lesson.all_pairs(),
                       traversal.pairs.size(), traversal.pairs.size() - left.size(), left.size(),
                       pair_names(left, lesson.names()), lesson.narrow_text(left));
}

std::string lesson_of(const RobotDemo& demo, const RobotCase& robot,
                      const LinkNarrowPhase& narrow_phase) {
    AllowedPairs allowed = robot.allowed;
    const bool proposed = !demo.files.srdf;
    if (proposed)
        allow_adjacent(robot.robot, allowed);
    Lesson lesson(robot, allowed, narrow_phase);
    std::vector<double> values = robot.robot.rest();
    lesson.set(values);

    std::string text = fmt::format(
        "The robot {}: which of its links may collide?\n\n"
        "1. The links and their boxes\n"
        "   Links: {}; with geometry for collisions: {}; values of joints: {}. Around each link "
        "we\n"
        "   put an axis-aligned box: links can only touch where their boxes overlap, and six\n"
        "   comparisons tell whether two boxes do. At rest, in metres:\n\n{}\n",
        robot.robot.name(), robot.robot.links().size(), lesson.n(), robot.robot.n_values(),
        lesson.box_lines());
    text += fmt::format("2. Without a tree\n"
                        "   Brute force tests each link against each other: {} x {} / 2 = {} box "
                        "tests.\n\n",
                        lesson.n(), lesson.n() - 1, lesson.all_pairs());

    Tree tree = find_builder("median").make({})(lesson.boxes(), serial());
    text += fmt::format("3. The tree, built by median split\n"
                        "   A node's box holds all boxes below it.\n\n{}\n",
                        draw(tree, lesson.names()));
    text += fmt::format(
        "4. The traversal, the allowed pairs, and the narrow phase\n"
        "   At each node its left side is tested against its right side: if two boxes are apart,\n"
        "   so is everything inside them. Of the pairs that are found those that are allowed to\n"
        "   collide are dropped ({}, {}). The rest are looked at triangle\n"
        "   by triangle: only that tells whether links touch, and how far apart they are.\n\n{}\n",
        lesson.allowed_text(),
        proposed                  ? "as there is no --srdf"
        : allowed.pairs().empty() ? "as the SRDF file has no pair, not even of adjacent links"
                                  : "as the SRDF file says",
        pairs_text(lesson, tree));

    RobotSelfCollision probe(robot.robot, robot.boxes, allowed, narrow_phase);
    const std::uint64_t number = state_to_show(robot.robot, probe, demo.seed, values);
    lesson.set(values);
    text += fmt::format(
        "5. The joints move, and the tree is refitted\n"
        "   Random state {} of seed {}, {}: {}.\n"
        "   Forward kinematics moves the links and gives each a new box. The tree keeps its "
        "shape:\n"
        "   refitting gives each leaf its new box, then each parent the box of its two children.\n",
        number, demo.seed,
        lesson.any_collide() ? "the first in which links collide" : "none of 1,000 collides",
        joints_text(robot.robot, values));
    text += refit_text(tree, lesson.boxes(), lesson.names());
    text += "\n6. Pairs again\n\n" + pairs_text(lesson, tree);
    text += fmt::format("\n   All at once, with exit codes and JSON: boxwood query robot {}{}\n",
                        demo.files.urdf, demo.files.srdf ? " --srdf " + *demo.files.srdf : "");
    return text;
}

} // namespace

std::string robot_demo(const RobotDemo& demo, const MakeLinkNarrowPhase& make_narrow_phase) {
    try {
        const std::unique_ptr<RobotCase> robot = read_robot(demo.files);
        if (robot->boxes.links().size() < 2)
            throw BadInput(fmt::format("{}: fewer than two links have a <collision> element: there "
                                       "is no pair to look at",
                                       demo.files.urdf));
        return lesson_of(demo, *robot,
                         *make_narrow_phase(robot->robot, robot->meshes, demo.files.are_solid));
    } catch (...) {
        rethrow_as_bad_input();
    }
}

} // namespace boxwood::bench
