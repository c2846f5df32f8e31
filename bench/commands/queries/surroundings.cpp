#include "bench/commands/queries/surroundings.h"

#include "bench/commands/queries/bodies.h"
#include "bench/io/bad_input.h"
#include "scenes/text/csv.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace boxwood::bench {
namespace {

/// A file of this name is one, whatever it is called.
std::pair<std::string, Pose> placed(const std::string& text) {
    const std::size_t sign = text.rfind('@');
    if (sign == text.npos || std::filesystem::exists(text))
        return {text, {}};
    Pose pose;
    const auto take = [&](std::span<const double> row, std::size_t) {
        pose.translation = {row[0], row[1], row[2]};
    };
    const std::string option = fmt::format("--obstacle {}", text);
    if (read_csv(text.substr(sign + 1), option, {"x,y,z behind the @", 3, 3}, take) != 1)
        throw BadInput(option + ": it is BODY or BODY@x,y,z");
    return {text.substr(0, sign), checked_pose(pose)};
}

} // namespace

Surroundings::Surroundings(const RobotCase& robot, const std::vector<std::string>& obstacles)
    : links_(world_, robot.robot, robot.meshes, robot.allowed, {.group = 1, .mask = 2}) {
    for (const std::string& text : obstacles) {
        const auto [body, pose] = placed(text);
        const BodyShape shape = read_body(body, false, {}).shape;
        names_.emplace(world_.insert(shape, pose, {.group = 2, .mask = 1}), text);
    }
}

Surroundings::Meeting Surroundings::meeting(Pair bodies) const {
    const std::optional<std::uint32_t> link = links_.link_of(bodies.a);
    return link ? Meeting{*link, names_.at(bodies.b)}
                : Meeting{*links_.link_of(bodies.b), names_.at(bodies.a)};
}

std::vector<Surroundings::Meeting> Surroundings::hits() const {
    std::vector<Meeting> found;
    for (const Pair bodies : world_.collisions())
        found.push_back(meeting(bodies));
    const auto key = [](const Meeting& m) { return std::pair(m.link, m.obstacle); };
    std::ranges::sort(found, {}, key);
    found.erase(std::ranges::unique(found, {}, key).begin(), found.end());
    return found;
}

std::optional<std::pair<Surroundings::Meeting, BodyDistance>> Surroundings::nearest() const {
    const std::optional<BodyDistance> least = world_.least_distance();
    return least ? std::optional(std::pair(meeting(least->bodies), *least)) : std::nullopt;
}

} // namespace boxwood::bench
