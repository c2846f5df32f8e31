#include "trees/world/propose_pairs.h"

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace boxwood {
namespace {

bool has_geometry(const Robot& robot, std::uint32_t link) {
    return !robot.links()[link].geometries.empty();
}

/// A pair of links, and what was seen of it.
struct Watched {
    std::uint32_t a, b;
    bool is_rigid; ///< neither moves as seen from the other
    bool met = false, parted = false;

    bool is_decided() const { return (met && parted) || (is_rigid && (met || parted)); }
};

std::vector<Watched> pairs_to_watch(const Robot& robot, std::span<const std::uint32_t> links,
                                    const AllowedPairs& allowed) {
    const auto parts = robot.kinematics().rigid_parts();
    std::vector<Watched> pairs;
    for (std::size_t j = 0; j < links.size(); ++j)
        for (std::size_t i = 0; i < j; ++i)
            if (!allowed.allows(links[i], links[j]))
                pairs.push_back({links[i], links[j], parts[links[i]] == parts[links[j]]});
    return pairs;
}

} // namespace

AllowedPairs no_allowed_pairs(const Robot& robot) {
    std::vector<std::string> names;
    for (const LinkDescription& link : robot.links())
        names.push_back(link.name);
    return AllowedPairs(std::move(names));
}

std::size_t allow_adjacent(const Robot& robot, AllowedPairs& allowed) {
    const auto parents = robot.kinematics().parents();
    const std::size_t before = allowed.size();
    for (std::uint32_t link = 0; link < robot.links().size(); ++link) {
        if (!has_geometry(robot, link))
            continue;
        std::uint32_t above = link;
        do
            above = parents[above];
        while (!has_geometry(robot, above) && above != parents[above]);
        if (above != link && has_geometry(robot, above) && !allowed.allows(above, link))
            allowed.allow(above, link, AllowedReason::adjacent);
    }
    return allowed.size() - before;
}

PairsBySampling allow_by_samples(const Robot& robot, const LinkBoxes& boxes,
                                 const SampledStates& states, LinksCollide collide,
                                 AllowedPairs& allowed) {
    if (states.n == 0)
        throw std::invalid_argument("0 samples say nothing of a robot; take one at least");
    PairsBySampling counts;
    std::vector<Watched> pairs = pairs_to_watch(robot, boxes.links(), allowed);
    std::vector<double> values(robot.n_values());
    std::vector<RigidTransform<double>> poses(robot.links().size());
    std::vector<Aabb<double>> around(robot.links().size());
    for (std::uint64_t i = 0; i < states.n; ++i) {
        states.state(i, values);
        robot.poses(values, poses);
        boxes.boxes(poses, around);
        for (Watched& pair : pairs) {
            if (pair.is_decided())
                continue;
            bool meets = overlaps(around[pair.a], around[pair.b]);
            if (meets) {
                meets = collide(pair.a, pair.b, poses);
                ++counts.tests;
            }
            (meets ? pair.met : pair.parted) = true;
        }
    }
    const std::string samples =
        std::to_string(states.n) + " samples, seed " + std::to_string(states.seed);
    for (const Watched& pair : pairs) {
        if (pair.met && pair.parted)
            continue;
        if (pair.is_rigid) {
            allowed.allow(pair.a, pair.b, pair.met ? AllowedReason::always : AllowedReason::never,
                          "held together by fixed joints");
            ++(pair.met ? counts.always : counts.never);
        } else if (pair.met) {
            allowed.allow(pair.a, pair.b, AllowedReason::always, "in each of " + samples);
            ++counts.always;
        } else {
            allowed.allow(pair.a, pair.b, AllowedReason::sampled, "in none of " + samples);
            ++counts.sampled;
        }
    }
    return counts;
}

} // namespace boxwood
