#include "bench/explaining/explain.h"

#include "bench/commands/command.h"
#include "bench/commands/queries/query.h"
#include "bench/io/write_file.h"
#include "scenes/moving/scene_file.h"
#include "scenes/sampling/rays.h"
#include "scenes/scene.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <memory>

namespace boxwood::bench {
namespace {

struct ExplainOptions {
    std::vector<std::uint32_t> items;
    std::string boxes, mesh, scene, rays, svg;
    std::vector<float> ray;
    std::string builder;
    std::uint64_t frame = 0;
};

Scene scene_of(const std::string& generator, const std::string& file) {
    SceneSpec spec;
    spec.generator = generator;
    spec.file = file;
    try {
        return make_scene(spec);
    } catch (const std::exception& error) {
        throw BadInput(fmt::format("explain: {}", error.what()));
    }
}

Tree tree_of(const std::string& builder, Boxes boxes) {
    try {
        return make_builder(builder)(boxes, serial());
    } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format("explain: {}", error.what()));
    }
}

template <class Explain> void print(const ExplainOptions& options, const Explain& explain) {
    Explanation answer;
    try {
        answer = explain();
    } catch (const std::invalid_argument& error) {
        throw BadInput(fmt::format("explain: {}", error.what()));
    }
    std::cout << answer.text;
    if (options.svg.empty())
        return;
    if (answer.svg.empty()) {
        std::cout << "\npicture  none: there is nothing to draw\n";
        return;
    }
    if (std::filesystem::is_regular_file(options.svg) &&
        std::filesystem::file_size(options.svg) > 0 && std::ifstream(options.svg).get() != '<')
        throw BadInput(fmt::format("explain: --svg '{}' is there and no picture; name another file",
                                   options.svg));
    write_file(options.svg, answer.svg, "explain: --svg " + options.svg);
    std::cout << fmt::format("\npicture  {}\n", options.svg);
}

void of_pair(const ExplainOptions& options) {
    if (options.boxes.empty() == options.mesh.empty())
        throw BadInput("explain pair: whose? give --boxes FILE or --mesh FILE");
    std::vector<Box> boxes;
    std::vector<Aabb<double>> exact;
    if (options.boxes.empty()) {
        boxes = scene_of("mesh", options.mesh).boxes;
    } else {
        exact = read_boxes(options.boxes);
        std::ranges::transform(exact, std::back_inserter(boxes), rounded_to_floats);
    }
    const Tree tree = tree_of(options.builder, boxes);
    print(options,
          [&] { return explain_pair(tree, boxes, options.items[0], options.items[1], exact); });
}

void of_ray(const ExplainOptions& options) {
    const Scene scene = scene_of("mesh", options.mesh);
    Ray<float> ray;
    if (!options.ray.empty() && !options.items.empty())
        throw BadInput(
            fmt::format("explain ray: which ray {} is, --rays FILE says; --ray is the ray "
                        "itself",
                        options.items[0]));
    if (!options.ray.empty()) {
        const std::vector<float>& n = options.ray;
        ray.origin = {n[0], n[1], n[2]};
        ray.direction = {n[3], n[4], n[5]};
        if (!is_finite(ray.origin) || !is_finite(ray.direction) || ray.direction == Vec3<float>{})
            throw BadInput("explain ray: --ray ox,oy,oz,dx,dy,dz are finite numbers, and the "
                           "direction is not zero");
    } else {
        const std::vector<Ray<float>> rays = [&] {
            try {
                return read_rays(options.rays);
            } catch (const std::exception& error) {
                throw BadInput(fmt::format("explain: {}", error.what()));
            }
        }();
        const std::size_t i = options.items.empty() ? 0 : options.items[0];
        if (i >= rays.size())
            throw BadInput(
                fmt::format("explain ray: {} holds {} rays, which count from 0; there is "
                            "no ray {}",
                            options.rays, rays.size(), i));
        ray = rays[i];
    }
    const Tree tree = tree_of(options.builder, scene.boxes);
    print(options, [&] { return explain_ray(tree, scene.mesh, ray); });
}

void of_body(const ExplainOptions& options) {
    print(options, [&] {
        MovingScene scene(load_scene(options.scene));
        while (scene.frame() < options.frame)
            scene.advance();
        return explain_body(scene, options.items[0]);
    });
}

} // namespace

void add_explain(CLI::App& app, int&) {
    CLI::App* explain =
        app.add_subcommand("explain", "why a pair, a ray or a body gets the answer that it gets");
    explain->require_subcommand(1);
    explain->footer(
        "Example: boxwood explain pair 0 1 --boxes scenes/examples/boxes.csv --svg why.svg");
    const auto add = [&](const char* name, const char* summary, const char* example, auto run) {
        auto options = std::make_shared<ExplainOptions>();
        CLI::App* command = explain->add_subcommand(name, summary);
        command->add_option("--svg", options->svg, "draw it, too");
        command->footer(fmt::format("Example: {}", example));
        command->callback([options, run] { run(*options); });
        return std::pair(command, options);
    };
    const auto [pair, of_two] =
        add("pair", "why two boxes are a pair, or none: the gap, and the way through the tree",
            "boxwood explain pair 0 1 --boxes scenes/examples/boxes.csv --svg why.svg", of_pair);
    pair->add_option("items", of_two->items, "the two items, which count from 0")
        ->required()
        ->expected(2);
    pair->add_option("--boxes", of_two->boxes, "boxes (CSV, min_x,min_y,min_z,max_x,max_y,max_z)");
    pair->add_option("--mesh", of_two->mesh, "a mesh: the boxes of its triangles");
    const auto [ray, of_one] =
        add("ray", "what a ray meets: the nodes that it enters, the triangles that are tested",
            "boxwood explain ray --mesh scenes/examples/ball.obj --ray 0,0,5,0,0,-1", of_ray);
    ray->add_option("item", of_one->items, "which ray of --rays, from 0")->expected(0, 1);
    ray->add_option("--mesh", of_one->mesh, "a mesh (OBJ, PLY, STL, ...)")->required();
    CLI::Option* const from_file =
        ray->add_option("--rays", of_one->rays, "rays (CSV, ox,oy,oz,dx,dy,dz[,tmax])");
    ray->add_option("--ray", of_one->ray, "ox,oy,oz,dx,dy,dz")
        ->delimiter(',')
        ->expected(6)
        ->excludes(from_file);
    ray->callback([options = of_one] {
        if (options->rays.empty() && options->ray.empty())
            throw BadInput("explain ray: which? give --ray ox,oy,oz,dx,dy,dz or --rays FILE");
        of_ray(*options);
    });
    of_two->builder = "hilbert";    // as Bvh builds
    of_one->builder = "binned_sah"; // as MeshBvh builds
    for (const auto& [command, options] : {std::pair(pair, of_two), std::pair(ray, of_one)})
        command->add_option("--builder", options->builder, "of the tree; boxwood list builders")
            ->capture_default_str();
    const auto [body, of_body_options] =
        add("body", "with whom a body of a scene is a pair, and why not with others",
            "boxwood explain body 1 --scene four_link_arm --frame 30", of_body);
    body->add_option("body", of_body_options->items, "the body, from 0")->required()->expected(1);
    body->add_option("--scene", of_body_options->scene, "a moving scene, or a scene file (.toml)")
        ->required();
    body->add_option("--frame", of_body_options->frame, "played up to it")
        ->check(CLI::Range(0, 1'000'000))
        ->capture_default_str();
}

} // namespace boxwood::bench
