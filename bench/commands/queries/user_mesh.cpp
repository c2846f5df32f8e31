#include "bench/commands/queries/user_mesh.h"

#include "bench/io/bad_input.h"
#include "bench/io/say.h"
#include "scenes/meshes/mesh_file.h"
#include "trees/queries/sides.h"
#include "trees/world/mesh_triage.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string_view>
#include <utility>

namespace boxwood::bench {
namespace {

/// "2 with a NaN or inf (the first: triangle 17), 1 repeated (triangle 9)"; nothing if none is bad.
std::string what_is_bad(const MeshTriage& found) {
    const std::pair<const std::vector<std::uint32_t>&, const char*> kinds[] = {
        {found.missing_vertices, "with a vertex that is not there"},
        {found.not_finite, "with a NaN or inf"},
        {found.without_area, "without area"},
        {found.repeated, "repeated"}};
    std::vector<std::string> parts;
    for (const auto& [triangles, what] : kinds)
        if (!triangles.empty())
            parts.push_back(fmt::format("{} {} ({}triangle {})", triangles.size(), what,
                                        triangles.size() > 1 ? "the first: " : "",
                                        triangles.front()));
    return fmt::format("{}", fmt::join(parts, ", "));
}

/// Of what is bad that of which nothing can be said.
MeshTriage unusable(const MeshTriage& found) {
    MeshTriage without;
    without.triangles = found.triangles;
    without.missing_vertices = found.missing_vertices;
    without.not_finite = found.not_finite;
    return without;
}

} // namespace

UserMesh read_user_mesh(const std::string& file, BadTriangles what, bool is_solid) {
    TriangleMesh mesh = load_mesh(file, NotFinite::keep);
    const MeshTriage found = triage(mesh);
    if (found.bad_triangles() == 0)
        return {std::move(mesh)};
    const std::string bad = what_is_bad(found);
    if (what == BadTriangles::refuse)
        throw BadInput(
            fmt::format("{}: bad triangles: {}; `boxwood doctor {} --out FILE.obj` writes "
                        "the mesh without them, --bad-triangles set-aside leaves them "
                        "out",
                        file, bad, file));
    const MeshTriage aside = what == BadTriangles::set_aside ? found : unusable(found);
    UserMesh read{without_bad_triangles(mesh, aside), good_triangles(aside)};
    std::string because;
    if (what == BadTriangles::keep && is_solid && open_edges(read.mesh) > 0) {
        UserMesh good{without_bad_triangles(mesh, found), good_triangles(found)};
        if (open_edges(good.mesh) == 0) {
            read = std::move(good);
            because = ", as the mesh is closed without them";
        }
    }
    const std::size_t n = mesh.triangles.size() - read.mesh.triangles.size();
    say(fmt::format("boxwood: {}: bad triangles: {}; {} of {} triangles {} set aside{}\n", file,
                    bad, n == 0 ? "none" : fmt::format("{}", n), mesh.triangles.size(),
                    n == 1 ? "is" : "are", because));
    if (read.mesh.triangles.empty())
        throw BadInput(fmt::format("{}: no triangle is left", file));
    return read;
}

void add_bad_triangles_option(CLI::App& app, BadTriangles& what) {
    static constexpr std::pair<std::string_view, BadTriangles> names[] = {
        {"keep", BadTriangles::keep},
        {"set-aside", BadTriangles::set_aside},
        {"refuse", BadTriangles::refuse}};
    app.add_option_function<std::string>(
           "--bad-triangles",
           [&what](const std::string& name) {
               what =
                   std::ranges::find(names, name, &std::pair<std::string_view, BadTriangles>::first)
                       ->second;
           },
           "of mesh files, counted on stderr. keep: those with a NaN or inf are set aside, those "
           "without area count as the points and segments that they are; set-aside: these and "
           "repeated ones, too; refuse: an error")
        ->check(CLI::IsMember({"keep", "set-aside", "refuse"}))
        ->default_str("keep");
}

} // namespace boxwood::bench
