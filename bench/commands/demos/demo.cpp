#include "bench/commands/demos/demo.h"

#include "bench/commands/command.h"
#include "bench/commands/option_ranges.h"
#include "trees/world/bodies/robot_meshes.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <iostream>
#include <memory>

namespace boxwood::bench {
namespace {

/// A line per demo.
std::string demos_text(const CLI::App& demo) {
    std::string text = "The demos:\n";
    for (const CLI::App* each : demo.get_subcommands([](const CLI::App*) { return true; }))
        text +=
            fmt::format("  boxwood demo {:<12} {}\n", each->get_name(), each->get_description());
    return text;
}

void add_robot(CLI::App& demo) {
    auto options = std::make_shared<RobotDemo>();
    CLI::App* robot = demo.add_subcommand(
        "robot", "the same on a robot of your own: boxes, tree, allowed pairs, what touches");
    add_robot_options(*robot, options->files);
    robot->add_option("--seed", options->seed, "of the random state")
        ->check(seed_range())
        ->capture_default_str();
    robot->footer("Example: boxwood demo robot panda.urdf --srdf panda.srdf");
    robot->callback([options] {
        std::cout << robot_demo(
            *options, [](const Robot& made, std::span<const TriangleMesh> meshes, bool are_solid) {
                return std::make_unique<RobotMeshes>(made, meshes, RobotMeshesOptions{are_solid});
            });
    });
}

} // namespace

void add_demo(CLI::App& app, int&) {
    CLI::App* demo = app.add_subcommand("demo", "see how it works, step by step");
    demo->require_subcommand(0, 1);
    demo->footer("Example: boxwood demo four-link");
    demo->callback([demo] {
        if (demo->get_subcommands().empty())
            std::cout << demos_text(*demo);
    });
    CLI::App* four_link = demo->add_subcommand(
        "four-link",
        "a robot of four links: the tree, its traversal, allowed pairs, a joint that turns");
    four_link->footer("Example: boxwood demo four-link");
    four_link->callback([] { std::cout << four_link_demo(); });
    add_robot(*demo);
}

} // namespace boxwood::bench
