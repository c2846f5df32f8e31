#include "bench/commands/queries/surroundings.h"

#include "bench/io/bad_input.h"
#include "kernels/suggest.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>

namespace boxwood::bench {
namespace {

bool is_name(std::string_view text) {
    return !text.empty() && !std::isdigit(static_cast<unsigned char>(text.front())) &&
           std::ranges::all_of(text, [](char c) {
               return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-';
           });
}

/// LINK,OTHER, of which OTHER may hold commas.
void take_allowed(const std::string& text, AllowedByUser& allowed, RobotCase& robot) {
    const std::size_t comma = text.find(',');
    if (comma == text.npos)
        throw BadInput(fmt::format("--allow {}: it is LINK,LINK or LINK,OBSTACLE", text));
    const auto links = robot.robot.links();
    const auto number_of = [](const auto& all, std::string_view name) {
        const auto found = std::ranges::find_if(all, [&](const auto& x) { return x.name == name; });
        return static_cast<std::uint32_t>(found - all.begin());
    };
    const std::string_view first = std::string_view(text).substr(0, comma),
                           second = std::string_view(text).substr(comma + 1);
    const std::uint32_t link = number_of(links, first);
    if (link == links.size())
        throw BadInput(
            fmt::format("--allow {}: {}", text, unknown_name("link", first, names_of(links))));
    const std::uint32_t other = number_of(links, second);
    if (other == link)
        throw BadInput(fmt::format("--allow {}: these are one link", text));
    if (other < links.size())
        return robot.allowed.allow(link, other, AllowedReason::user, "--allow");
    const std::uint32_t obstacle = number_of(allowed.obstacles, second);
    if (obstacle == allowed.obstacles.size()) {
        std::vector<std::string_view> names = names_of(links);
        for (const Obstacle& known : allowed.obstacles)
            names.push_back(known.name);
        throw BadInput(
            fmt::format("--allow {}: {}", text, unknown_name("link or obstacle", second, names)));
    }
    allowed.with_obstacles.push_back({link, obstacle});
}

} // namespace

Obstacle read_obstacle(const std::string& text) {
    Obstacle obstacle{text, text};
    if (std::filesystem::exists(text))
        return obstacle;
    if (const std::size_t equals = text.find('='); is_name(text.substr(0, equals))) {
        obstacle.body = equals == text.npos ? text : text.substr(equals + 1);
        if (equals != text.npos)
            obstacle.name = text.substr(0, equals);
    }
    const std::size_t sign = obstacle.body.rfind('@');
    if (sign == text.npos || std::filesystem::exists(obstacle.body))
        return obstacle;
    obstacle.pose = read_place(obstacle.body.substr(sign + 1), fmt::format("--obstacle {}", text));
    obstacle.body.erase(sign);
    return obstacle;
}

AllowedByUser::AllowedByUser(std::span<const std::string> allow, std::span<const std::string> texts,
                             RobotCase& robot) {
    for (const std::string& text : texts) {
        Obstacle obstacle = read_obstacle(text);
        if (std::ranges::find(obstacles, obstacle.name, &Obstacle::name) != obstacles.end() &&
            obstacle.name != text)
            throw BadInput(
                fmt::format("--obstacle {}: another one is called {}", text, obstacle.name));
        const auto links = robot.robot.links();
        if (std::ranges::find(links, obstacle.name, &LinkDescription::name) != links.end())
            throw BadInput(fmt::format("--obstacle {}: a link is called {}; give the obstacle "
                                       "another name, by NAME=...",
                                       text, obstacle.name));
        obstacles.push_back(std::move(obstacle));
    }
    for (const std::string& text : allow)
        take_allowed(text, *this, robot);
}

Surroundings::Surroundings(const RobotCase& robot, const AllowedByUser& allowed,
                           const RobotFiles& files, QueryTimes& times)
    : links_(world_, robot.robot, robot.meshes, robot.allowed,
             {.group = 1, .mask = 2, .are_solid = files.are_solid}) {
    std::vector<std::uint32_t> bodies;
    for (const Obstacle& obstacle : allowed.obstacles) {
        const BodyShape shape =
            read_body(obstacle.body, false, {.bad_triangles = files.bad_triangles, .times = &times})
                .shape;
        bodies.push_back(world_.insert(shape, obstacle.pose, {.group = 2, .mask = 1}));
        names_.emplace(bodies.back(), obstacle.name);
    }
    for (const Pair pair : allowed.with_obstacles)
        for (const std::uint32_t body : links_.bodies())
            if (links_.link_of(body) == pair.a)
                world_.allow(body, bodies[pair.b]);
}

Surroundings::Meeting Surroundings::meeting(Pair bodies) const {
    const std::optional<std::uint32_t> link = links_.link_of(bodies.a);
    return link ? Meeting{*link, names_.at(bodies.b)}
                : Meeting{*links_.link_of(bodies.b), names_.at(bodies.a)};
}

Surroundings::Answer Surroundings::answer(std::span<const double> values) {
    links_.place(values);
    Answer found;
    for (const Pair bodies : world_.collisions())
        found.hits.push_back(meeting(bodies));
    const auto key = [](const Meeting& m) { return std::pair(m.link, m.obstacle); };
    std::ranges::sort(found.hits, {}, key);
    found.hits.erase(std::ranges::unique(found.hits, {}, key).begin(), found.hits.end());
    if (const std::optional<BodyDistance> least = world_.least_distance())
        found.nearest = std::pair(meeting(least->bodies), *least);
    return found;
}

} // namespace boxwood::bench
