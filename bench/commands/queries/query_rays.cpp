/// `boxwood query rays`: rays against the triangles of the user's mesh.

#include "bench/commands/command.h"
#include "bench/commands/queries/query.h"
#include "bench/io/csv.h"
#include "bench/io/ray_range.h"
#include "kernels/oracle/rational.h"
#include "kernels/ray_box/slabs.h"
#include "kernels/registry.h"
#include "kernels/suggest.h"
#include "scenes/meshes/mesh_file.h"
#include "scenes/sampling/rays.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <iostream>

namespace boxwood::bench {
namespace {

std::vector<Ray<float>> rays_of(const std::string& path) {
    const std::string source = source_name(path);
    std::vector<Ray<float>> rays = parse_rays(read_text(path), source);
    if (rays.empty())
        warn_of_no_rows(source, ray_columns);
    return rays;
}

using oracle::RationalRays;

void require_kernel(const std::string& name) {
    std::vector<std::string_view> known = names_of(ray_kernels());
    known.push_back(RationalRays::name);
    if (std::find(known.begin(), known.end(), name) == known.end())
        throw BadInput(unknown_name("ray kernel", name, known));
}

TriangleMesh read_mesh(const std::string& file) {
    TriangleMesh mesh = load_mesh(file);
    if (const auto vertex = beyond_ray_range(mesh))
        throw BadInput(fmt::format("mesh {} {}", file, out_of_ray_range(mesh, *vertex)));
    return mesh;
}

/// Every triangle whose box the ray does not miss, without a tree: the rational kernel allocates.
RayHit rational_hit(const Ray<float>& ray, const TriangleMesh& mesh, std::span<const Box> boxes) {
    const RaySlabs slabs(ray);
    RayHit best;
    for (std::uint32_t i = 0; i < boxes.size(); ++i) {
        RayHit hit;
        if (clip(slabs, boxes[i], ray.t_min, ray.t_max).hit() &&
            RationalRays::intersect({}, ray, mesh.triangle(i), ray.t_max, hit) &&
            (!best.hit() || hit.t < best.t)) {
            best = hit;
            best.triangle = i;
        }
    }
    return best;
}

/// Reads back as a double that is this float, so that a t that is given as tmax, which is rounded
/// down, hits again.
std::string exact_text(float t) { return fmt::format("{}", static_cast<double>(t)); }

void print_lines(std::span<const RayHit> hits, bool any, BlockWriter& text) {
    for (const RayHit& hit : hits)
        if (any)
            text << (hit.hit() ? "1\n" : "0\n");
        else if (hit.hit())
            text << hit.triangle << "," << exact_text(hit.t) << "," << hit.u << "," << hit.v
                 << "\n";
        else
            text << "miss\n";
}

void print_json(std::span<const RayHit> hits, bool any, BlockWriter& text) {
    text << "{\"rays\":" << std::to_string(hits.size()) << ",\"hits\":"
         << std::to_string(std::count_if(hits.begin(), hits.end(),
                                         [](const RayHit& hit) { return hit.hit(); }))
         << ",\"answers\":[";
    std::string_view separator = "";
    for (const RayHit& hit : hits) {
        text << separator;
        separator = ",";
        if (any)
            text << (hit.hit() ? "1" : "0");
        else if (hit.hit())
            text << "{\"triangle\":" << hit.triangle << ",\"t\":" << exact_text(hit.t)
                 << ",\"u\":" << hit.u << ",\"v\":" << hit.v << "}";
        else
            text << "null";
    }
    text << "]}\n";
}

} // namespace

void run(const RaysQuery& query, std::ostream& out) {
    const BuildFunction build = chosen_builder(query.tree);
    const LayoutEntry& layout_entry = chosen_layout(query.tree);
    const std::unique_ptr<Executor> executor = chosen_executor(query.tree);
    require_kernel(query.kernel);
    const TriangleMesh mesh = read_mesh(query.mesh);
    const std::vector<Ray<float>> rays = rays_of(query.rays);

    std::vector<Box> boxes(mesh.triangles.size());
    for (std::size_t i = 0; i < boxes.size(); ++i)
        boxes[i] = mesh.triangle(i).bounds();
    std::vector<RayHit> hits(rays.size());
    if (query.kernel == RationalRays::name) {
        executor->for_each(rays.size(),
                           [&](std::size_t i) { hits[i] = rational_hit(rays[i], mesh, boxes); });
    } else {
        Tree tree;
        const std::unique_ptr<AnyLayout> layout =
            make_layout(layout_entry, build, boxes, *executor, tree);
        layout->rays(rays, query.any ? RayQuery::any : RayQuery::closest, query.kernel,
                     layout->triangles(mesh, *executor), *executor, hits);
    }

    BlockWriter text(out);
    if (query.format.json)
        return print_json(hits, query.any, text);
    if (query.format.header)
        text << (query.any ? "hit\n" : "triangle,t,u,v\n");
    print_lines(hits, query.any, text);
}

void add_query_rays(CLI::App& query) {
    auto options = std::make_shared<RaysQuery>();
    CLI::App* rays = query.add_subcommand(
        "rays", "for each ray the nearest triangle of a mesh, as triangle,t,u,v or miss");
    rays->add_option("MESH", options->mesh, "a mesh file (OBJ, PLY, STL)")->required();
    rays->add_option("RAYS.csv", options->rays, "the rays; - reads standard input")->required();
    rays->add_flag("--any", options->any, "print only 1 or 0: whether the ray hits anything");
    rays->add_option("--kernel", options->kernel,
                     "a ray kernel of `boxwood list kernels`; rational uses no tree and is slow")
        ->capture_default_str();
    add_format_options(*rays, options->format);
    add_tree_options(*rays, options->tree,
                     "the answers are the same for every choice, but for the rounding of plain "
                     "float kernels");
    rays->footer(
        "Rows: ox,oy,oz,dx,dy,dz[,tmax], decimal or hex float, rounded to floats (tmax down);\n"
        "blank lines and lines with # in front are skipped. The hit is at origin + t * direction\n"
        "with 0 <= t <= tmax (t as printed, rounded to float; of exact and rational the true t\n"
        "too, which may be above the printed one: as a tmax take the next float), which is\n"
        "(1 - u - v) a + u b + v c on the triangle (a, b, c). Of hits at the same t the lowest\n"
        "triangle is named; triangles are numbered from 0 in file order.\n"
        "Coordinates of mesh and rays are below 2^126 (8.5e37) in size. With every kernel a ray\n"
        "ends at the largest float: what lies beyond t = 3.4e38 is a miss, so make a direction of\n"
        "1e-42 longer.\n\n"
        "Example:\n"
        "  echo 0,0,-10,0,0,1 | boxwood query rays model.obj -");
    rays->callback([options] { run(*options, std::cout); });
}

} // namespace boxwood::bench
